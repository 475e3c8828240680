//! A survey: the map made so far, and where the robot drives.

use super::{Model, Run, Screen};
use exploration::{CellState, Column, Grid};
use mission::event::{Explored, SurveyWay};
use mission::{Event, EventKind};
use serde::{Deserialize, Serialize};
use world::{Boundary, Point, Tiles};

/// The largest number of places along an edge of a square at which the map is read.
const MOST_PLACES: usize = 8;
/// The share of a square from which solid cells show in it.
const SOLID: f64 = 0.1;

/// A survey as its events describe it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Survey {
    grid: Grid,
    states: Tiles<CellState>,
    /// Changes with every edit of the cells.
    stamp: u64,
    /// Share of the floor that scans have shown, 0 to 1; `None` before the first report.
    pub share: Option<f64>,
    /// Places before the frontiers that the hull can reach, the nearest first.
    pub frontiers: Vec<Point>,
    /// The columns found so far.
    pub columns: Vec<Column>,
    /// The way that the robot takes; `None` before the first one.
    pub way: Option<SurveyWay>,
}

/// What a piece of the map shows, apart from free floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// No scan has shown most of it.
    Not,
    /// An object that is not a column.
    Object,
}

impl Survey {
    /// The state before the first scan, for a floor within a wall.
    fn new(boundary: &Boundary) -> Self {
        let grid = Grid::of(boundary);
        Self {
            states: Tiles::new(grid.columns, grid.len(), CellState::Unseen),
            grid,
            stamp: 0,
            share: None,
            frontiers: Vec::new(),
            columns: Vec::new(),
            way: None,
        }
    }

    /// A stamp that changes with every edit of the cells; a drawing remains valid as long as the stamp stays the same.
    pub fn stamp(&self) -> u64 {
        self.stamp
    }

    /// What a square of the floor shows; `None` for free floor and columns.
    pub fn seen_in(&self, center: Point, edge_m: f64) -> Option<Seen> {
        let n = ((edge_m / self.grid.cell_m).ceil() as usize).clamp(1, MOST_PLACES);
        let off_m = |k: usize| edge_m * ((k as f64 + 0.5) / n as f64 - 0.5);
        let places = (0..n * n).map(|k| Point::new(center.x + off_m(k % n), center.y + off_m(k / n)));
        let (mut all, mut unseen, mut solid) = (0.0, 0.0, 0.0);
        for at in places {
            let state = self.grid.index(at).map_or(CellState::Unseen, |cell| self.states.at(cell));
            all += 1.0;
            unseen += f64::from(u8::from(state == CellState::Unseen));
            solid += f64::from(u8::from(state == CellState::Solid && !self.is_in_column(at)));
        }
        if solid > SOLID * all { Some(Seen::Object) } else { (unseen > 0.5 * all).then_some(Seen::Not) }
    }

    /// The word for a place of the map.
    pub fn word_at(&self, at: Point) -> &'static str {
        match self.grid.index(at).map(|cell| self.states.at(cell)) {
            _ if self.is_in_column(at) => "column",
            Some(CellState::Free) => "explored",
            Some(CellState::Solid) => "object",
            Some(CellState::Unseen) | None => "not seen",
        }
    }

    fn is_in_column(&self, at: Point) -> bool {
        self.columns.iter().any(|column| (at - column.center).norm() <= column.radius_m + self.grid.cell_m)
    }

    fn explored(&mut self, explored: &Explored) {
        self.share = Some(explored.share);
        self.frontiers.clone_from(&explored.frontiers);
        self.columns.clone_from(&explored.columns);
        self.edit(&explored.cells);
    }

    /// Changes the cells; a damaged text changes none.
    fn edit(&mut self, cells: &str) {
        let runs = exploration::runs(cells, self.grid.len()).unwrap_or_default();
        for (cells, state) in runs {
            cells.for_each(|cell| *self.states.at_mut(cell) = state);
            self.stamp += 1;
        }
    }
}

impl Model {
    /// Whether the run that a re-scan would continue is a survey: the re-scan is then a plan for a scan of its map.
    pub(crate) fn rescans_a_survey(&self) -> bool {
        let selected = match self.ui.screen {
            Screen::Home => self.home.selected_run(),
            Screen::Review => self.review.run(&self.home),
            _ => return self.live.run.is_survey(),
        };
        let glimpse = selected.and_then(|run| self.home.glimpses.of(&run.name)?.as_ref().ok());
        glimpse.is_some_and(|glimpse| glimpse.run.is_survey())
    }
}

impl Run {
    /// Whether the mission's task is to make a map.
    pub fn is_survey(&self) -> bool {
        self.survey.is_some()
    }

    /// The numbers of the columns of a survey, in their order: that in the name of the found obstacle that a column stands
    /// for, such as `found 2`. Other columns get the numbers after the largest one.
    pub fn column_numbers(&self) -> Vec<usize> {
        let columns = self.survey.as_ref().map_or(&[][..], |survey| survey.columns.as_slice());
        let obstacles = self.about.as_ref().map_or(&[][..], |about| about.world.obstacles.as_slice());
        let found = obstacles.iter().filter(|obstacle| !obstacle.known);
        exploration::column_numbers(
            columns,
            found.map(|obstacle| (obstacle.name.as_str(), obstacle.shape.center())),
        )
    }

    /// Folds in what an event says about a survey.
    pub(super) fn surveyed(&mut self, event: &Event) {
        if let EventKind::RunOpened(run) = &event.kind {
            self.survey = run.mission.task.is_survey().then(|| Box::new(Survey::new(&run.world.boundary)));
        }
        let Some(survey) = &mut self.survey else { return };
        match &event.kind {
            EventKind::SurveyWay(way) => survey.way = Some(way.clone()),
            EventKind::Explored(explored) => survey.explored(explored),
            EventKind::Mapped { map } => {
                survey.share = Some(map.explored);
                survey.columns.clone_from(&map.columns);
                if map.grid.len() == survey.grid.len() {
                    survey.edit(&map.cells);
                }
            }
            EventKind::Ended { .. } => survey.way = None,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_fill_the_map_and_damaged_ones_change_nothing() {
        let mut survey = Survey::new(&Boundary::Circle { radius_m: 1.0 });
        assert_eq!(survey.seen_in(Point::origin(), 0.3), Some(Seen::Not));
        let report = |cells: &str| Explored {
            share: 0.5,
            frontiers: vec![Point::new(0.5, 0.0)],
            columns: Vec::new(),
            cells: cells.into(),
        };
        let all = survey.grid.len();
        survey.explored(&report(&format!("{all}f")));
        assert_eq!(
            (survey.seen_in(Point::origin(), 0.3), survey.word_at(Point::origin())),
            (None, "explored")
        );
        let (stamp, middle) = (survey.stamp(), survey.grid.index(Point::origin()).unwrap_or_default());
        survey.explored(&report(&format!("{middle}=1s")));
        assert_eq!((survey.word_at(Point::origin()), survey.stamp()), ("object", stamp + 1));
        survey.explored(&report(&format!("{}f", all + 1)));
        assert_eq!((survey.word_at(Point::origin()), survey.stamp()), ("object", stamp + 1));
        survey.columns.push(Column {
            center: Point::origin(),
            radius_m: 0.2,
            center_sigma_m: 0.01,
            radius_sigma_m: 0.01,
        });
        assert_eq!((survey.seen_in(Point::origin(), 0.1), survey.word_at(Point::origin())), (None, "column"));
    }
}
