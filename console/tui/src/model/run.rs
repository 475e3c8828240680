//! A run as its events tell it: the same fold serves a run that is flown now and one that is replayed.

use super::{Alarms, History, Log, Planning, Position, Raster, Shadow, Tether, Trail, log::What};
use mission::{FoldedStanding, MissionConfig, Phase, PlannerInfo, TaskConfig};
use positioning::AccuracyMap;
use serde::{Deserialize, Serialize};
use world::{PlateLayout, Point, Station, StationId, World};

/// A run as its events tell it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Run {
    /// What the run is about; `None` until it is opened.
    pub about: Option<About>,
    /// What the mission is doing, and which orders it accepts.
    pub standing: FoldedStanding,
    /// Why it ended, as a sentence; empty before.
    pub end_reason: String,
    /// Mission time.
    pub clock: Clock,
    /// Where the robot believes it is, and how well it knows.
    pub position: Position,
    /// Where it has been.
    pub trail: Trail,
    /// What has been scanned.
    pub coverage: Option<Raster>,
    /// How well the stations are forecast to locate the robot.
    pub accuracy: Option<AccuracyMap>,
    /// How far the mission is; `None` before the first step.
    pub progress: Option<Progress>,
    /// The scanned share of the reachable floor, per cent.
    pub scanned_history: History,
    /// The tether; `None` without one.
    #[serde(default)]
    pub tether: Option<Tether>,
    /// The planner and what it last did.
    pub planning: Planning,
    /// The planner in shadow; `None` without one.
    #[serde(default)]
    pub shadow: Option<Shadow>,
    /// What is wrong.
    pub alarms: Alarms,
    /// What happened.
    pub log: Log,
}

/// What a run is about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Name of the scenario.
    pub scenario: String,
    /// Start of every random choice.
    pub seed: u64,
    /// The tank as the mission knows it: the drawing, and what was found since.
    pub world: World,
    /// The mission.
    pub mission: MissionConfig,
    /// Length of the preset path, metres; `None` for a mission without one.
    pub preset_m: Option<f64>,
    /// What the operator ticks by hand before the start.
    #[serde(default)]
    pub checklist: Vec<String>,
    /// How the plates of the floor lie, if the drawing shows them.
    #[serde(default)]
    pub plates: Option<PlateLayout>,
}

/// Mission time, by the events.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Clock {
    /// Number of the last tick.
    pub tick: u64,
    /// Mission time at its top, seconds.
    pub t_s: f64,
    /// Mission time spent under way and not held, seconds.
    pub moving_s: f64,
    /// Mission time at the start, seconds; `None` before.
    #[serde(default)]
    pub started_s: Option<f64>,
}

/// How far the mission is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Mission time of it, seconds.
    pub t_s: f64,
    /// Share of the task done, 0 to 1.
    pub done: f64,
    /// Way along the preset path, metres.
    pub along_m: Option<f64>,
    /// Distance from the preset path, metres.
    pub cross_track_m: Option<f64>,
    /// Where the robot goes next.
    pub target: Point,
    /// Scanned share of the reachable floor, 0 to 1.
    pub covered_reachable: f64,
    /// Scanned share of the whole floor, 0 to 1.
    pub covered_whole: f64,
}

impl Run {
    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        &self.standing.phase
    }

    /// Whether the mission runs: the robot moves, or waits for its planner.
    pub fn is_running(&self) -> bool {
        matches!(self.phase(), Phase::Running(_))
    }

    /// Whether the run is over.
    pub fn has_ended(&self) -> bool {
        matches!(self.phase(), Phase::Ended(_))
    }

    /// Whether the floor is to be scanned.
    pub fn covers(&self) -> bool {
        self.about.as_ref().is_some_and(|about| matches!(about.mission.task, TaskConfig::Cover { .. }))
    }

    /// Whether floor that is not scanned is floor that was missed; the report holds only missions to that that were to scan.
    pub fn has_missed(&self) -> bool {
        self.covers() && self.has_ended()
    }

    /// Why a planner cannot fly this mission, if it cannot.
    pub fn cannot_fly(&self, planner: &PlannerInfo) -> Option<&'static str> {
        if self.covers() { planner.why_no_coverage() } else { None }
    }

    /// Id of the active planner, or of the first one.
    pub fn planner_id(&self) -> Option<&str> {
        self.planning.choice.as_ref().map(|choice| choice.id.as_str())
    }

    /// Mission time still to go at the pace so far, seconds.
    pub fn left_s(&self) -> Option<f64> {
        let done = self.progress.as_ref()?.done;
        let known = self.clock.moving_s > 10.0 && done > 0.01 && done <= 1.0 && !self.has_ended();
        known.then(|| self.clock.moving_s * (1.0 - done) / done)
    }

    /// Whether a value of some time that comes with every tick of the mission has not come for two ticks.
    pub fn is_overdue(&self, t_s: f64) -> bool {
        let tick_s = self.about.as_ref().map_or(0.1, |about| about.mission.tick_s);
        // A little more than two: times are sums of ticks.
        !self.has_ended() && self.clock.t_s - t_s > 2.01 * tick_s
    }

    /// The stations of the tank.
    pub fn stations(&self) -> &[Station] {
        self.about.as_ref().map_or(&[], |about| &about.world.stations)
    }

    /// The place that a line of the log is about, metres, tank frame.
    pub fn place_of(&self, what: &What) -> Option<Point> {
        let station = |id| self.stations().iter().find(|station| station.id == id);
        what.place(|id| station(id).map(|station| station.position))
    }

    /// Name of a station.
    pub fn station_name(&self, id: StationId) -> String {
        let found = self.stations().iter().find(|station| station.id == id);
        found.map_or_else(|| format!("station {}", id.0), |station| station.name.clone())
    }
}
