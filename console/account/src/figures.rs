//! The table of the figures that panes show, charts draw, and recordings store: name, unit, value and limit of each.

use crate::extremes::{Extreme, Worst};
use mission::{
    Event, EventKind, MissionConfig,
    event::{RunOpened, SLACK_M},
};
use planner_api::Drive;
use positioning::fix::{ellipse_95, position_covariance};
use serde::{Deserialize, Serialize};
use world::{Obstacle, ObstacleMap, Point, World};

/// A figure of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FigureId {
    /// Half width of the 95 % position error.
    PositionError,
    /// Protection level of the position.
    Protection,
    /// Distance from the hull to the nearest solid object on the chart, at the estimated position.
    Clearance,
    /// Scanned share of the reachable floor.
    Covered,
    /// Distance from the preset path or the lanes.
    CrossTrack,
    /// Speed sent to the robot.
    SpeedSent,
    /// Length of tether out, as expected from the map.
    TetherOut,
    /// Length of the return path along the tether; without a value if the hull does not fit.
    ReturnPath,
    /// Largest wrap of the tether on one obstacle.
    WrapLargest,
    /// Sum of all wraps of the tether.
    WrapTotal,
    /// Pull at the reel that taking up the tether needs; only with a reel in the scenario.
    Pull,
    /// Measured pull on the tether; only with a sensor.
    PullMeasured,
    /// Slack of the tether; only with a sensor of the pull.
    Slack,
    /// Distance between the estimated and the true position.
    TrueError,
    /// True distance from the hull to the nearest solid object.
    TrueClearance,
    /// True speed.
    TrueSpeed,
    /// True length of tether out.
    TrueTetherOut,
}

impl FigureId {
    /// All figures, in the order of the table.
    pub const ALL: [Self; 17] = [
        Self::PositionError,
        Self::Protection,
        Self::Clearance,
        Self::Covered,
        Self::CrossTrack,
        Self::SpeedSent,
        Self::TetherOut,
        Self::ReturnPath,
        Self::WrapLargest,
        Self::WrapTotal,
        Self::Pull,
        Self::PullMeasured,
        Self::Slack,
        Self::TrueError,
        Self::TrueClearance,
        Self::TrueSpeed,
        Self::TrueTetherOut,
    ];

    /// The name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::PositionError => "95 % error",
            Self::Protection => "protection level",
            Self::Clearance => "clearance",
            Self::Covered => "reachable floor",
            Self::CrossTrack => "cross-track",
            Self::SpeedSent => "speed sent",
            Self::TetherOut => "tether out",
            Self::ReturnPath => "return path",
            Self::WrapLargest => "largest wrap",
            Self::WrapTotal => "total wrap",
            Self::Pull => "pull",
            Self::PullMeasured => "pull measured",
            Self::Slack => "slack",
            Self::TrueError => "true error",
            Self::TrueClearance => "clearance (true)",
            Self::TrueSpeed => "speed (true)",
            Self::TrueTetherOut => "tether out (true)",
        }
    }

    /// The unit of the value.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Covered => "%",
            Self::SpeedSent | Self::TrueSpeed => "m/s",
            Self::WrapLargest | Self::WrapTotal => "°",
            Self::Pull | Self::PullMeasured => "N",
            _ => "m",
        }
    }

    /// Number of decimals to print.
    pub fn decimals(self) -> usize {
        match self {
            Self::WrapLargest | Self::WrapTotal => 0,
            Self::Covered
            | Self::TetherOut
            | Self::ReturnPath
            | Self::Pull
            | Self::PullMeasured
            | Self::TrueTetherOut => 1,
            _ => 2,
        }
    }

    /// Whether only the simulator knows the figure.
    pub fn is_true(self) -> bool {
        matches!(self, Self::TrueError | Self::TrueClearance | Self::TrueSpeed | Self::TrueTetherOut)
    }

    /// Whether only a mission with a tether has the figure.
    pub fn is_of_tether(self) -> bool {
        matches!(
            self,
            Self::TetherOut
                | Self::ReturnPath
                | Self::WrapLargest
                | Self::WrapTotal
                | Self::Pull
                | Self::PullMeasured
                | Self::Slack
                | Self::TrueTetherOut
        )
    }

    /// The direction in which values get worse; `None` if the worst value has no meaning.
    pub fn worst(self) -> Option<Worst> {
        match self {
            Self::Clearance | Self::TrueClearance => Some(Worst::Least),
            Self::PositionError
            | Self::Protection
            | Self::TetherOut
            | Self::WrapLargest
            | Self::WrapTotal
            | Self::Pull
            | Self::Slack
            | Self::TrueError
            | Self::TrueTetherOut => Some(Worst::Most),
            Self::PullMeasured
            | Self::Covered
            | Self::CrossTrack
            | Self::SpeedSent
            | Self::ReturnPath
            | Self::TrueSpeed => None,
        }
    }

    /// The limit in a mission.
    pub fn limit(self, config: &MissionConfig) -> Option<Limit> {
        let tether = config.tether.as_ref().map(|tether| tether.limits);
        let limit = match self {
            Self::PositionError => Limit::Most(config.position_limit_m),
            Self::Clearance | Self::TrueClearance => Limit::Least(config.clearance_m),
            Self::SpeedSent => Limit::Most(config.limits.v_max_m_per_s),
            Self::TetherOut | Self::TrueTetherOut => Limit::Most(tether?.reel_length_m),
            Self::WrapLargest => Limit::Most(tether?.wrap_max_rad.to_degrees()),
            Self::WrapTotal => Limit::Most(tether?.wrap_total_max_rad.to_degrees()),
            Self::Pull => Limit::Most(config.tether.as_ref()?.reel?.pull_n),
            Self::Slack => Limit::Most(SLACK_M),
            Self::PullMeasured
            | Self::Protection
            | Self::Covered
            | Self::CrossTrack
            | Self::ReturnPath
            | Self::TrueError
            | Self::TrueSpeed => {
                return None;
            }
        };
        limit.value().is_finite().then_some(limit)
    }
}

/// The limit of a figure, in its unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The value must not be larger.
    Most(f64),
    /// The value must not be smaller.
    Least(f64),
}

impl Limit {
    /// The limit itself.
    pub fn value(self) -> f64 {
        match self {
            Self::Most(value) | Self::Least(value) => value,
        }
    }

    /// Whether a value is within the limit.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Most(most) => value <= most,
            Self::Least(least) => value >= least,
        }
    }
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// The figure.
    pub id: FigureId,
    /// The latest value; absent before the first one.
    pub value: Option<f64>,
    /// The limit; absent for a figure without a limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
    /// The worst value so far; absent for figures without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<Extreme>,
}

/// The table of a run, computed from its events.
///
/// Cost per tick: one distance query; the chart is indexed again after an obstacle was found or moved.
#[derive(Debug, Clone, Default)]
pub struct Figures {
    rows: Vec<Figure>,
    /// Radius of the hull, metres.
    hull_m: f64,
    chart: Option<Chart>,
    estimate: Option<Seen>,
    truth: Option<Seen>,
}

/// A position, and when it was reported.
#[derive(Debug, Clone, Copy)]
struct Seen {
    tick: u64,
    t_s: f64,
    at: Point,
}

/// The tank as the mission knows it.
#[derive(Debug, Clone)]
struct Chart {
    world: World,
    map: Map,
}

/// The index of a chart; `None` if it is out of date.
#[derive(Clone, Default)]
struct Map(Option<ObstacleMap>);

impl std::fmt::Debug for Map {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Map")
    }
}

impl Figures {
    /// The table before any event: without rows.
    pub fn new() -> Self {
        Self::default()
    }

    /// The figures of the run, one per row; empty until the run is opened.
    pub fn rows(&self) -> &[Figure] {
        &self.rows
    }

    /// The row of a figure, if the run has it.
    pub fn get(&self, id: FigureId) -> Option<&Figure> {
        self.rows.iter().find(|row| row.id == id)
    }

    /// Adds an event; events must come in the order of the journal.
    pub fn apply(&mut self, event: &Event) {
        let (tick, t_s) = (event.tick, event.t_s);
        match &event.kind {
            EventKind::RunOpened(run) => self.open(run),
            EventKind::Estimated { pose } => {
                self.estimate = Some(Seen { tick, t_s, at: pose.position });
                let (error_m, ..) = ellipse_95(&position_covariance(&pose.covariance));
                self.set(FigureId::PositionError, t_s, Some(error_m));
                let clearance_m = self.chart.as_mut().map(|chart| chart.map().clearance_m(pose.position));
                self.set(FigureId::Clearance, t_s, clearance_m.map(|m| m - self.hull_m));
                self.compare(t_s);
            }
            EventKind::Protected { level_m } => self.set(FigureId::Protection, t_s, *level_m),
            EventKind::Truth { pose, clearance_m, .. } => {
                let before = self.truth.replace(Seen { tick, t_s, at: pose.position });
                let before = before.filter(|before| t_s > before.t_s);
                let speed = before.map(|before| (pose.position - before.at).norm() / (t_s - before.t_s));
                self.set(FigureId::TrueClearance, t_s, Some(*clearance_m));
                self.set(FigureId::TrueSpeed, t_s, speed);
                self.compare(t_s);
            }
            EventKind::Progressed { covered_reachable, cross_track_m, .. } => {
                self.set(FigureId::Covered, t_s, Some(100.0 * covered_reachable));
                self.set(FigureId::CrossTrack, t_s, *cross_track_m);
            }
            EventKind::Commanded { command, .. } => {
                self.set(FigureId::SpeedSent, t_s, Some(speed(&command.drive)));
            }
            EventKind::Held { .. } | EventKind::Ended { .. } => {
                self.set(FigureId::SpeedSent, t_s, Some(0.0));
            }
            EventKind::Tethered {
                length_m,
                wrap_max_rad,
                wrap_total_rad,
                pull_n,
                measured,
                return_length_m,
                ..
            } => {
                self.set(FigureId::TetherOut, t_s, Some(*length_m));
                self.set(FigureId::ReturnPath, t_s, *return_length_m);
                self.set(FigureId::WrapLargest, t_s, Some(wrap_max_rad.to_degrees()));
                self.set(FigureId::WrapTotal, t_s, Some(wrap_total_rad.to_degrees()));
                self.set(FigureId::Pull, t_s, *pull_n);
                self.set(FigureId::PullMeasured, t_s, measured.map(|measured| measured.pull_n));
                self.set(FigureId::Slack, t_s, measured.map(|measured| measured.slack_m));
            }
            EventKind::TetherTruth { length_m, .. } => {
                self.set(FigureId::TrueTetherOut, t_s, Some(*length_m));
            }
            EventKind::ObstacleFound { obstacle } | EventKind::ObstacleMoved { obstacle, .. } => {
                self.chart.iter_mut().for_each(|chart| chart.place(obstacle));
            }
            _ => {}
        }
    }

    fn open(&mut self, run: &RunOpened) {
        let config = &run.mission;
        let tether = config.tether.as_ref();
        let has = |id: &FigureId| match id {
            FigureId::Protection => config.locating.risk.is_some(),
            FigureId::Pull | FigureId::PullMeasured | FigureId::Slack => {
                tether.is_some_and(|tether| tether.reel.is_some())
            }
            id => tether.is_some() || !id.is_of_tether(),
        };
        let row = |id: FigureId| Figure { id, value: None, limit: id.limit(config), worst: None };
        let rows = FigureId::ALL.into_iter().filter(has).map(row).collect();
        let chart = Some(Chart { world: run.world.as_drawn(), map: Map::default() });
        *self = Self { rows, hull_m: config.limits.radius_m, chart, ..Self::default() };
    }

    /// Compares the estimated with the true position once both are known for a tick.
    fn compare(&mut self, t_s: f64) {
        if let (Some(estimate), Some(truth)) = (self.estimate, self.truth)
            && estimate.tick == truth.tick
        {
            self.set(FigureId::TrueError, t_s, Some((estimate.at - truth.at).norm()));
        }
    }

    fn set(&mut self, id: FigureId, t_s: f64, value: Option<f64>) {
        let at = if id.is_true() { self.truth } else { self.estimate }.map(|seen| seen.at);
        let Some(row) = self.rows.iter_mut().find(|row| row.id == id) else { return };
        row.value = value.filter(|value| value.is_finite());
        if let (Some(worst), Some(value), Some(at)) = (id.worst(), row.value, at) {
            row.worst = worst.of(row.worst, Extreme { value, t_s, at });
        }
    }
}

impl Chart {
    fn map(&mut self) -> &ObstacleMap {
        let Self { world, map } = self;
        map.0.get_or_insert_with(|| ObstacleMap::new(&world.boundary, &world.obstacles))
    }

    fn place(&mut self, found: &Obstacle) {
        self.world.obstacles.retain(|other| other.known || other.id != found.id);
        self.world.obstacles.push(found.clone());
        self.map = Map::default();
    }
}

fn speed(drive: &Drive) -> f64 {
    match drive {
        Drive::Twist { v_m_per_s, .. } => v_m_per_s.abs(),
        Drive::Velocity(velocity) => velocity.norm(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{estimated, event, opened, truth};
    use serde_json::{Value, json};

    fn table(events: &[(u64, Value)]) -> Figures {
        let mut figures = Figures::new();
        for (tick, kind) in events {
            figures.apply(&event(*tick, kind));
        }
        figures
    }

    #[test]
    fn a_run_has_the_rows_of_its_robot_with_their_limits() {
        assert!(Figures::new().rows().is_empty());
        let figures = table(&[(0, opened())]);
        assert!(figures.rows().iter().all(|row| !row.id.is_of_tether() && row.value.is_none()));
        let limit = |id| figures.get(id).and_then(|row| row.limit);
        assert_eq!(limit(FigureId::PositionError), Some(Limit::Most(0.5)));
        assert_eq!(limit(FigureId::SpeedSent), Some(Limit::Most(1.0)));
        assert_eq!(limit(FigureId::Covered), None);
        assert!(Limit::Most(0.5).holds(0.5) && !Limit::Least(0.5).holds(0.4));
    }

    #[test]
    fn the_worst_value_keeps_its_time_and_place_and_the_last_value_goes_on() {
        let figures = table(&[
            (0, opened()),
            (1, truth(-1.0, 0.0, 0.9, false)),
            (1, estimated(-1.0, 0.1, 0.1)),
            (2, truth(0.0, 0.0, 0.4, false)),
            (2, estimated(0.5, 0.0, 0.3)),
            (3, truth(1.0, 0.0, 0.8, false)),
            (3, estimated(1.0, 0.2, 0.1)),
        ]);
        let worst = |id| figures.get(id).and_then(|row| row.worst);
        let error = worst(FigureId::PositionError).unwrap();
        assert_eq!((error.t_s, error.at), (1.0, Point::new(0.5, 0.0)));
        let now_m = figures.get(FigureId::PositionError).and_then(|row| row.value).unwrap();
        assert!((error.value - 3.0 * now_m).abs() < 1e-6, "{error:?}, {now_m} m now");
        let nearest = worst(FigureId::TrueClearance).unwrap();
        assert_eq!((nearest.value, nearest.t_s, nearest.at), (0.4, 1.0, Point::new(0.0, 0.0)));
        let by_chart = worst(FigureId::Clearance).unwrap();
        assert!((by_chart.value - 1.0).abs() < 1e-9 && (by_chart.t_s - 0.5).abs() < 1e-9, "{by_chart:?}");
        let true_error = worst(FigureId::TrueError).unwrap();
        assert!((true_error.value - 0.5).abs() < 1e-9, "{true_error:?}");
        assert_eq!(figures.get(FigureId::TrueSpeed).and_then(|row| row.value), Some(2.0));
    }

    #[test]
    fn an_obstacle_that_is_found_counts_from_then_on() {
        let found = json!({ "event": "obstacle_found", "obstacle": {
            "id": 7, "name": "found 1", "known": false, "shape": { "disc": { "center": [0.0, 0.5], "radius_m": 0.2 } },
        } });
        let figures =
            table(&[(0, opened()), (1, estimated(0.0, 0.0, 0.1)), (2, found), (3, estimated(0.0, 0.0, 0.1))]);
        let nearest = figures.get(FigureId::Clearance).and_then(|row| row.worst).unwrap();
        assert!((nearest.value - 0.3).abs() < 1e-9 && (nearest.t_s - 1.5).abs() < 1e-9, "{nearest:?}");
    }
}
