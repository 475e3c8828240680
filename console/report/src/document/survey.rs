//! The map that a survey has made: its figures, its columns, and the difference to the drawing.

use super::{
    layers::Layers,
    maps::{self, FULL_MM, Figure, filled, legend, swatch},
};
use crate::{
    drawing::{
        frame::Fixtures,
        sheet::{Sheet, colour},
    },
    past_run::PastRun,
};
use exploration::{CellState, Fate, SurveyMap};
use serde::Serialize;
use world::{Obstacle, Point, Shape, coverage::percent_text};

/// The map of a survey.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapPart {
    /// Share of the floor within the wall that scans have shown, 0 to 1.
    pub explored: f64,
    /// The columns, in the order of their numbers.
    pub columns: Vec<ColumnPart>,
    /// Number of outlines of other objects; a long object has several.
    pub objects: usize,
    /// Number of places that were left out because the tether did not reach them.
    pub beyond_tether: usize,
    /// Number of objects on the drawing.
    pub drawn: usize,
    /// The objects on the drawing that are not a column on the map.
    pub not_found: Vec<NotFound>,
    /// The objects on the map that are neither columns nor on the drawing.
    pub objects_not_drawn: Vec<NotDrawn>,
}

/// An object on the map that is neither a column nor on the drawing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotDrawn {
    /// Its south-west corner.
    pub low: Point,
    /// Its north-east corner.
    pub high: Point,
}

/// A column on the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnPart {
    /// Its number, as in the log of the survey.
    pub number: usize,
    /// Its centre.
    pub center: Point,
    /// Its radius, metres.
    pub radius_m: f64,
    /// 95 % error of the centre along its worse axis, metres.
    pub center_95_m: f64,
    /// 95 % error of the radius, metres.
    pub radius_95_m: f64,
    /// The same column on the drawing; absent if it is not drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn: Option<DrawnAs>,
}

/// A column on the drawing that is on the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnAs {
    /// Its name on the drawing.
    pub name: String,
    /// From the drawn centre to the centre on the map: east and north, metres.
    pub moved_m: [f64; 2],
    /// Radius on the map minus the drawn radius, metres.
    pub grown_m: f64,
}

impl DrawnAs {
    /// Distance between the drawn centre and the centre on the map, metres.
    pub fn distance_m(&self) -> f64 {
        self.moved_m[0].hypot(self.moved_m[1])
    }
}

/// An object on the drawing that is not a column on the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotFound {
    /// Its name on the drawing.
    pub name: String,
    /// Its drawn centre.
    pub at: Point,
    /// What the map shows there.
    pub instead: Instead,
}

/// What a map shows where an object is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Instead {
    /// An object that is not a column.
    Object,
    /// Free floor.
    FreeFloor,
    /// Nothing: the place was not seen.
    NotSeen,
}

impl Instead {
    /// What the map shows, in a table.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Object => "an object that is not a column",
            Self::FreeFloor => "free floor: the object is not there",
            Self::NotSeen => "not seen: the drawing was not checked here",
        }
    }
}

impl MapPart {
    /// The map of a run; `None` if the run made none, or its cells are damaged.
    pub(super) fn of(past: &PastRun) -> Option<Self> {
        let (map, run) = (past.fold.map()?, past.fold.run()?);
        let drawn: Vec<&Obstacle> = run.world.obstacles.iter().filter(|obstacle| obstacle.known).collect();
        let shapes: Vec<Shape> = drawn.iter().map(|obstacle| obstacle.shape.clone()).collect();
        let fates = map.fates(&shapes)?;
        let numbers = numbers(past);
        let column = |(index, column): (usize, &exploration::Column)| {
            let [center_95_m, radius_95_m] = column.errors_95_m();
            let same = fates.iter().zip(&drawn).find_map(|(fate, obstacle)| match fate {
                Fate::Column { found, moved, grown_m } if *found == index => Some(DrawnAs {
                    name: obstacle.name.clone(),
                    moved_m: [moved.x, moved.y],
                    grown_m: *grown_m,
                }),
                _ => None,
            });
            ColumnPart {
                number: numbers[index],
                center: column.center,
                radius_m: column.radius_m,
                center_95_m,
                radius_95_m,
                drawn: same,
            }
        };
        let lacks = |(fate, obstacle): (&Fate, &&Obstacle)| {
            let instead = match fate {
                Fate::Column { .. } => return None,
                Fate::There => Instead::Object,
                Fate::NotThere => Instead::FreeFloor,
                Fate::NotSeen => Instead::NotSeen,
            };
            Some(NotFound { name: obstacle.name.clone(), at: obstacle.shape.center(), instead })
        };
        let mut columns: Vec<ColumnPart> = map.columns.iter().enumerate().map(column).collect();
        columns.sort_by_key(|column| column.number);
        Some(Self {
            explored: map.explored,
            columns,
            objects: map.others.len(),
            beyond_tether: past.fold.beyond_tether(),
            drawn: drawn.len(),
            objects_not_drawn: map
                .not_drawn(&shapes)
                .into_iter()
                .map(|[low, high]| NotDrawn { low, high })
                .collect(),
            not_found: fates.iter().zip(&drawn).filter_map(lacks).collect(),
        })
    }

    /// Number of drawn objects with this on the map instead of a column.
    pub(super) fn with_instead(&self, instead: Instead) -> usize {
        self.not_found.iter().filter(|lack| lack.instead == instead).count()
    }

    /// Number of objects in which map and drawing differ: those that are not drawn, and drawn ones that are not there.
    pub(super) fn differences(&self) -> usize {
        self.not_drawn() + self.objects_not_drawn.len() + self.with_instead(Instead::FreeFloor)
    }

    /// Number of columns on the map that are not on the drawing.
    pub(super) fn not_drawn(&self) -> usize {
        self.columns.iter().filter(|column| column.drawn.is_none()).count()
    }

    /// Largest distance between a drawn centre and the centre on the map, metres; `None` without such a pair.
    pub(super) fn moved_max_m(&self) -> Option<f64> {
        let drawn = self.columns.iter().filter_map(|column| column.drawn.as_ref());
        drawn.map(DrawnAs::distance_m).reduce(f64::max)
    }
}

/// The numbers of the columns on the map of a run, in the order of the map; empty for a run that made no map.
fn numbers(past: &PastRun) -> Vec<usize> {
    let columns = past.fold.map().map_or(&[][..], |map| &map.columns);
    let found = past.fold.found().map(|solid| (solid.name.as_str(), solid.shape.center()));
    exploration::column_numbers(columns, found)
}

/// An object on the map of a survey, for the files of a report.
pub(super) struct OnMap {
    /// A column with its number on the page, or another object.
    pub(super) name: String,
    pub(super) shape: Shape,
    /// 95 % errors of the centre and of the radius of a column, metres.
    pub(super) errors_95_m: Option<[f64; 2]>,
}

/// The objects on the map of a survey; `None` for a run that made no map.
pub(super) fn on_map(past: &[PastRun]) -> Option<Vec<OnMap>> {
    let map = past.last()?.fold.map()?;
    let mut columns: Vec<_> = numbers(past.last()?).into_iter().zip(&map.columns).collect();
    columns.sort_by_key(|(number, _)| *number);
    let columns = columns.into_iter().map(|(number, column)| OnMap {
        name: format!("column {number}"),
        shape: column.shape(),
        errors_95_m: Some(column.errors_95_m()),
    });
    let others = (1..).zip(&map.others).map(|(number, shape): (usize, _)| OnMap {
        name: format!("object {number}"),
        shape: shape.clone(),
        errors_95_m: None,
    });
    Some(columns.chain(others).collect())
}

/// Draws the map that a survey has made; `None` if its cells are damaged.
pub(super) fn picture(layers: &Layers<'_>, map: &SurveyMap, part: &MapPart) -> Option<Figure> {
    let states = map.states()?;
    let fixtures = Fixtures { drawn: Vec::new(), found: Vec::new(), ..layers.fixtures() };
    let mut sheet = Sheet::new(fixtures.boundary, "m", FULL_MM, 8.0);
    let (unseen, found) = (sheet.pattern("out"), sheet.pattern("found"));
    sheet.define_patterns(layers.floor().cell_m);
    sheet.wall(fixtures.boundary, &format!(r#"fill="{unseen}""#));
    let size = (map.grid.columns, map.grid.rows);
    let is_seen = |cell: usize| states[cell] != CellState::Unseen;
    sheet.grid((map.grid.low, map.grid.cell_m), size, is_seen, 0.75, &format!(r#"fill="{}""#, colour::ONCE));
    let (solid, ink, missed) = (colour::SOLID, colour::INK, colour::MISSED);
    let object = format!(r#"fill="{found}" stroke="{solid}" stroke-width=".3""#);
    for shape in &map.others {
        sheet.shape(shape, &object);
    }
    let dashed = r#"fill="none" stroke-width=".35" stroke-dasharray="1 .7""#;
    let drawn = layers.run.world.obstacles.iter().filter(|obstacle| obstacle.known);
    for obstacle in drawn {
        let is_missing = part
            .not_found
            .iter()
            .any(|lack| lack.name == obstacle.name && lack.instead == Instead::FreeFloor);
        let stroke = if is_missing { missed } else { ink };
        sheet.shape(&obstacle.shape, &format!(r#"{dashed} stroke="{stroke}""#));
    }
    for ColumnPart { number, center, radius_m, .. } in &part.columns {
        let disc = Shape::Disc { center: *center, radius_m: *radius_m };
        sheet.shape(&disc, &format!(r#"fill="{solid}""#));
        let at = sheet.at(*center) + world::Vector::new(radius_m * sheet.scale + 0.6, 0.0);
        sheet.draw(format_args!(
            r#"<text class="st" x="{:.2}" y="{:.2}" dy=".35em" font-size="2.6" font-weight="600" fill="{ink}">{number}</text>"#,
            at.x, at.y
        ));
    }
    sheet.frame(&fixtures, 2.4);
    let dot = |attributes: &str| swatch(&format!(r#"<circle cx="3.5" cy="2" r="1.3" {attributes}/>"#));
    let per_cent = |share: f64| format!("{} %", percent_text(share, 1));
    let mut entries = vec![
        legend(filled(colour::ONCE), "explored", per_cent(part.explored)),
        legend(filled("url(#moutL)"), "not seen", per_cent(1.0 - part.explored)),
        legend(dot(&format!(r#"fill="{solid}""#)), "column, with its number", part.columns.len().to_string()),
    ];
    if part.objects > 0 {
        entries.push(legend(dot(&object), "other object", part.objects.to_string()));
    }
    if part.drawn > 0 {
        let mark = |stroke: &str| dot(&format!(r#"{dashed} stroke="{stroke}""#));
        entries.push(legend(mark(ink), "on the drawing", part.drawn.to_string()));
        let gone = part.with_instead(Instead::FreeFloor);
        entries.push(legend(mark(missed), "on the drawing, but not there", gone.to_string()));
    }
    entries.push(maps::start_or_anchor(&layers.run.mission));
    let caption =
        "The map that the robot has made from its scans, according to the estimated position".into();
    Some(Figure { caption, svg: sheet.svg("Map made by the survey", "full"), legend: entries })
}
