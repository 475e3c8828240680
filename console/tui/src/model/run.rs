//! A run reconstructed from its events; live runs and replays use the same fold.

use super::alarms::rule::Context;
use super::{
    Alarms, Cause, FloorLevel, History, Log, Planning, Position, Raster, Shadow, Tether, Trail, log::What,
    scanner::Scanner, survey::Survey,
};
use account::Shares;
use mission::{
    EventKind, FoldedStanding, MissionConfig, Phase, PlannerInfo, TaskConfig, WayBack, event::TetherAlarm,
};
use positioning::AccuracyMap;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use vehicle::port::LinkSeen;
use world::coverage::regions::cells_within;
use world::{ObstacleId, PlateLayout, Point, Pose, Station, StationId, World};

/// Time under way, seconds, before which the average pace does not allow an estimate of the remaining time.
const SETTLED_S: f64 = 30.0;

/// A run reconstructed from its events.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Run {
    /// The subject of the run; `None` until the run is opened.
    pub about: Option<About>,
    /// The phase of the mission, and the orders that it accepts.
    pub standing: FoldedStanding,
    /// Why the run ended, as a sentence; empty until then.
    pub end_reason: String,
    /// Mission time.
    pub clock: Clock,
    /// The robot's estimated position and its error.
    pub position: Position,
    /// The robot's trail.
    pub trail: Trail,
    /// The scanned floor.
    pub coverage: Option<Raster>,
    /// The forecast accuracy of fixes across the floor.
    pub accuracy: Option<AccuracyMap>,
    /// The forecast protection level of fixes across the floor; `None` if the scenario states no risk.
    #[serde(default)]
    pub level: Option<FloorLevel>,
    /// Differs between forecasts and position error limits; a drawing of the forecast remains valid as long as it stays the
    /// same.
    #[serde(default)]
    pub accuracy_stamp: u64,
    /// The mission's progress; `None` before the first step.
    pub progress: Option<Progress>,
    /// The history of the scanned share of the reachable floor, per cent.
    pub scanned_history: History,
    /// Where each found obstacle was found, and whether it has moved since.
    #[serde(default)]
    pub found_at: BTreeMap<ObstacleId, (Point, bool)>,
    /// The tether; `None` without a tether.
    #[serde(default)]
    pub tether: Option<Tether>,
    /// The real vehicle; `None` in a simulation.
    #[serde(default)]
    pub vehicle: Option<VehicleSeen>,
    /// The scanner.
    #[serde(default)]
    pub scanner: Scanner,
    /// The survey; `None` unless the mission makes a map.
    #[serde(default)]
    pub survey: Option<Box<Survey>>,
    /// The dead channels of the instrument, in ascending order.
    #[serde(default)]
    pub dead_channels: Vec<u16>,
    /// The planner and its latest output.
    pub planning: Planning,
    /// The planner in shadow; `None` without one.
    #[serde(default)]
    pub shadow: Option<Shadow>,
    /// The way of the last drive back by order.
    #[serde(default)]
    pub way_back: Option<WayBack>,
    /// The alarms.
    pub alarms: Alarms,
    /// The log.
    pub log: Log,
}

/// The subject of a run: its scenario, its tank and its mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// The name of the scenario.
    pub scenario: String,
    /// The random seed.
    pub seed: u64,
    /// The tank as known: the drawing and what has been found since.
    pub world: World,
    /// The configuration of the mission.
    pub mission: MissionConfig,
    /// The length of the preset path, metres; `None` for a mission without one.
    pub preset_m: Option<f64>,
    /// The checklist that the operator ticks by hand before the start.
    #[serde(default)]
    pub checklist: Vec<String>,
    /// The layout of the floor plates, if the drawing shows them.
    #[serde(default)]
    pub plates: Option<PlateLayout>,
}

/// A real vehicle as its events describe it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VehicleSeen {
    /// The link.
    pub link: LinkSeen,
    /// Whether odometry has confirmed a commanded stop; `None` while this is open.
    pub stands: Option<bool>,
    /// Mission time at which the time limit ends an unattended mission that waits for its position, seconds; `None` while
    /// it does not wait.
    #[serde(default)]
    pub waits_until_s: Option<f64>,
}

/// Mission time, taken from the events.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Clock {
    /// The number of the last tick.
    pub tick: u64,
    /// Mission time at the start of the tick, seconds.
    pub t_s: f64,
    /// Mission time spent under way and not held, seconds.
    pub moving_s: f64,
    /// Mission time at the start of the mission, seconds; `None` before.
    #[serde(default)]
    pub started_s: Option<f64>,
}

/// The mission's progress.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Mission time of the progress report, seconds.
    pub t_s: f64,
    /// Share of the task done, 0 to 1.
    pub done: f64,
    /// Distance along the preset path, metres.
    pub along_m: Option<f64>,
    /// Distance from the preset path, metres.
    pub cross_track_m: Option<f64>,
    /// The robot's next target.
    pub target: Point,
    /// Scanned share of the reachable floor, 0 to 1.
    pub covered_reachable: f64,
    /// Scanned share of the whole floor, 0 to 1.
    pub covered_whole: f64,
}

impl Run {
    /// Whether the scan of a real vehicle guards the robot.
    pub fn has_guard(&self) -> bool {
        self.about.as_ref().is_some_and(|about| about.mission.guard_reaction_s.is_some())
    }

    /// Whether the robot is a real vehicle.
    pub fn is_live(&self) -> bool {
        self.about.as_ref().is_some_and(|about| about.mission.live)
    }

    /// The reel of the tether, if the scenario describes it.
    pub fn reel(&self) -> Option<world::tether::Reel> {
        self.about.as_ref()?.mission.tether.as_ref()?.reel
    }

    /// The largest permitted pull of the tether at the robot, newtons; `None` if the scenario gives none.
    pub fn robot_pull_most_n(&self) -> Option<f64> {
        self.reel()?.robot_pull_n
    }

    /// The phase of the mission.
    pub fn phase(&self) -> &Phase {
        &self.standing.phase
    }

    /// What the mission is doing, as far as alarms depend on it.
    pub fn context(&self) -> Context {
        Context::of(self.phase())
    }

    /// Whether a held vehicle does not stand still yet, as far as its odometry shows; `false` in a simulation.
    pub fn is_stopping(&self) -> bool {
        let stands = self.vehicle.as_ref().and_then(|vehicle| vehicle.stands);
        self.is_live() && matches!(self.phase(), Phase::Held(_)) && stands != Some(true)
    }

    /// Whether the mission runs: the robot moves, or waits for its planner.
    pub fn is_running(&self) -> bool {
        matches!(self.phase(), Phase::Running(_))
    }

    /// Whether the run has ended.
    pub fn has_ended(&self) -> bool {
        matches!(self.phase(), Phase::Ended(_))
    }

    /// Whether the mission's task is to scan the floor.
    pub fn covers(&self) -> bool {
        self.about.as_ref().is_some_and(|about| matches!(about.mission.task, TaskConfig::Cover { .. }))
    }

    /// Whether every obstacle that was found moves.
    pub fn finds_only_moving(&self) -> bool {
        !self.found_at.is_empty() && self.found_at.values().all(|(_, moves)| *moves)
    }

    /// Whether the tether is torn.
    pub fn is_tether_broken(&self) -> bool {
        self.tether.as_ref().is_some_and(|tether| tether.is_broken)
    }

    /// Whether the tether is slack: the alarm is open.
    pub fn is_tether_slack(&self) -> bool {
        let is_slack = |cause: &Cause| matches!(cause, Cause::Tether(word) if word == "slack");
        self.alarms.list().iter().any(|alarm| is_slack(&alarm.cause) && alarm.is_active())
    }

    /// Whether the hull is in a no-go zone.
    pub fn is_in_zone(&self) -> bool {
        self.alarms.list().iter().any(|alarm| matches!(alarm.cause, Cause::Zone(_)) && alarm.is_active())
    }

    /// Whether unscanned floor counts as missed: only in missions whose task was to scan.
    pub fn has_missed(&self) -> bool {
        self.covers() && self.has_ended()
    }

    /// Whether the mission ended before the end of its plan.
    pub fn is_cut_short(&self) -> bool {
        self.rest().is_some_and(|rest| rest.len() > 1)
    }

    /// The part of the plan that had not been driven when the mission ended; `None` before the end.
    fn rest(&self) -> Option<&[Point]> {
        let (plan, progress) =
            (self.planning.plan.as_ref()?, self.progress.as_ref().filter(|_| self.has_ended())?);
        plan.path.get(plan.reached(progress)..)
    }

    /// For each cell of the floor, whether the rest of the plan led there. Empty before the end of the mission, and if
    /// the whole plan was driven.
    pub fn not_reached(&self) -> Vec<bool> {
        let Some((coverage, about)) = self.coverage.as_ref().zip(self.about.as_ref()) else {
            return Vec::new();
        };
        let rest = self.rest().filter(|rest| rest.len() > 1).unwrap_or_default();
        let mut ahead = vec![false; if rest.is_empty() { 0 } else { coverage.floor().len() }];
        for pair in rest.windows(2).filter(|pair| pair[0] != pair[1]) {
            let way = pair[1] - pair[0];
            let at = |position| Pose { position, heading_rad: way.y.atan2(way.x) };
            for cell in coverage.floor().cells_under(about.mission.tool(), at(pair[0]), at(pair[1])) {
                ahead[cell] = true;
            }
        }
        ahead
    }

    /// For each cell of the floor, whether the mission did not have to scan it. Empty if the whole floor was requested,
    /// and for a mission that does not scan.
    pub fn not_requested(&self) -> Vec<bool> {
        let Some((coverage, about)) = self.coverage.as_ref().zip(self.about.as_ref()) else {
            return Vec::new();
        };
        let TaskConfig::Cover { regions, .. } = &about.mission.task else { return Vec::new() };
        let requested = cells_within(coverage.floor(), regions).unwrap_or_default();
        requested.into_iter().map(|is_requested| !is_requested).collect()
    }

    /// Whether only a part of the floor was requested.
    pub fn is_in_part(&self) -> bool {
        let task = self.about.as_ref().map(|about| &about.mission.task);
        matches!(task, Some(TaskConfig::Cover { regions, .. }) if !regions.is_empty())
    }

    /// The shares of the reachable floor that was requested. `None` if the whole floor was requested, and for a mission
    /// that does not scan.
    ///
    /// Cost: a look at every cell.
    pub fn requested(&self) -> Option<Shares> {
        let own = self.coverage.as_ref()?;
        let others = Some(self.not_requested()).filter(|others| !others.is_empty())?;
        let counts = own.counts_of(|cell| others.get(cell) == Some(&false));
        Some(Shares::of(counts, own.floor().cell_m2()))
    }

    /// Why a planner cannot run this mission; `None` if it can.
    pub fn cannot_fly(&self, planner: &PlannerInfo) -> Option<&'static str> {
        if self.covers() { planner.why_no_coverage() } else { None }
    }

    /// The id of the active planner, or of the first one.
    pub fn planner_id(&self) -> Option<&str> {
        self.planning.choice.as_ref().map(|choice| choice.id.as_str())
    }

    /// The estimated speed over ground, metres per second; `None` once the run has ended.
    pub fn speed_m_per_s(&self) -> Option<f64> {
        self.position.speed_m_per_s().filter(|_| !self.has_ended())
    }

    /// Estimated remaining mission time, seconds: at the average pace so far, or at full speed while the robot is
    /// driving back.
    pub fn left_s(&self) -> Option<f64> {
        if self.standing.phase.is_return() {
            return self.way_left_s();
        }
        let done = self.progress.as_ref()?.done;
        // How long a survey takes depends on what it finds.
        let known = !self.is_survey()
            && self.clock.moving_s > SETTLED_S
            && done > 0.01
            && done <= 1.0
            && !self.has_ended();
        known.then(|| self.clock.moving_s * (1.0 - done) / done)
    }

    /// Whether a value that arrives with every tick has been missing for two ticks; `t_s` is the time of the last
    /// value.
    pub fn is_overdue(&self, t_s: f64) -> bool {
        let tick_s = self.about.as_ref().map_or(0.1, |about| about.mission.tick_s);
        // The factor is slightly more than two, because times are sums of ticks and have rounding errors.
        !self.has_ended() && self.clock.t_s - t_s > 2.01 * tick_s
    }

    /// The tank's stations.
    pub fn stations(&self) -> &[Station] {
        self.about.as_ref().map_or(&[], |about| &about.world.stations)
    }

    /// The position that a log line is about, metres, tank frame.
    pub fn place_of(&self, what: &What) -> Option<Point> {
        let station = |id| self.stations().iter().find(|station| station.id == id);
        let place = || what.place(|id| station(id).map(|station| station.position));
        let of_kind = |kind| self.wound(kind).or_else(|| self.not_there(kind));
        what.event().and_then(|event| of_kind(&event.kind)).or_else(place)
    }

    /// The centre of an obstacle that the scans do not show.
    fn not_there(&self, kind: &EventKind) -> Option<Point> {
        let EventKind::NotThere { id, .. } = kind else { return None };
        let mut obstacles = self.about.iter().flat_map(|about| &about.world.obstacles);
        obstacles.find(|obstacle| obstacle.id == *id).map(|obstacle| obstacle.shape.center())
    }

    /// Where the tether is wound, according to an alarm: the obstacle that it names or, for the total, the largest wrap.
    fn wound(&self, kind: &EventKind) -> Option<Point> {
        let EventKind::TetherAlarmRaised { alarm, .. } = kind else { return None };
        let contacts = self.tether.as_ref().map_or(&[][..], |tether| &tether.contacts);
        match alarm {
            TetherAlarm::Wrap { on, .. } => {
                let obstacles = self.about.iter().flat_map(|about| &about.world.obstacles);
                let named = obstacles.into_iter().find(|obstacle| obstacle.name == *on);
                let contact = || contacts.iter().find(|contact| contact.on == *on).map(|contact| contact.at);
                named.map(|obstacle| obstacle.shape.center()).or_else(contact)
            }
            TetherAlarm::WrapTotal { .. } => Some(self.tether.as_ref()?.largest()?.at),
            _ => None,
        }
    }

    /// The name of a station.
    pub fn station_name(&self, id: StationId) -> String {
        let found = self.stations().iter().find(|station| station.id == id);
        found.map_or_else(|| format!("station {}", id.0), |station| station.name.clone())
    }
}
