//! Events into the model.

use super::{Cause, Model, Overlay, PlanShown, Progress, Raster, Run, Trail, ui::Ask};
use mission::{
    Event, EventKind, Hold, Order, Outcome, PlannerChoice, PlannerInfo, Severity, TaskConfig,
    event::{HoldReason, RunOpened, TetherAlarm, late_text},
};
use planner_api::{Command, Drawing};
use positioning::{AccuracyMap, Exclusion};
use world::{Obstacle, ObstacleId, Station, StationId};

/// Most drawings kept of one tick.
const MAX_DRAWINGS: usize = 512;
/// Cells of the accuracy forecast along the longer side of the floor.
const FORECAST_CELLS: f64 = 100.0;
/// Most figures kept of one tick.
const MAX_SCALARS: usize = 32;

impl Model {
    /// Takes in one event. What only the simulator can know is left out.
    pub(crate) fn fold(&mut self, event: &Event) {
        if matches!(event.kind, EventKind::Truth { .. } | EventKind::TetherTruth { .. }) {
            return;
        }
        self.update_clock(event);
        if let Some(line) = event.log_line() {
            self.log.add(event.t_s, line.severity, line.source, line.text);
        }
        self.standing.apply(&event.kind);
        match &event.kind {
            EventKind::RunOpened(run) => self.open(run),
            EventKind::Ordered { order } => self.answered(order),
            EventKind::OrderRefused { order, why } => {
                self.answered(order);
                self.say(Severity::Warn, format!("the mission refused: {why}"));
            }
            EventKind::Ranged { .. }
            | EventKind::Fixed { .. }
            | EventKind::FixFailed { .. }
            | EventKind::StationRejected { .. }
            | EventKind::StationRestored { .. }
            | EventKind::Estimated { .. }
            | EventKind::PositionLost { .. }
            | EventKind::PositionRegained { .. }
            | EventKind::RangesInconsistent { .. }
            | EventKind::RangesConsistent => self.locate(event),
            EventKind::ObstacleFound { obstacle } => self.found(event, obstacle),
            EventKind::ObstacleMoved { id, obstacle } => self.moved(*id, obstacle),
            EventKind::PlannerPrepared { .. }
            | EventKind::PlannerChosen { .. }
            | EventKind::ParametersChanged { .. }
            | EventKind::Planned { .. }
            | EventKind::Commanded { .. }
            | EventKind::Drawn { .. }
            | EventKind::Scalars { .. }
            | EventKind::PlannerFailed { .. }
            | EventKind::PlannerLate { .. }
            | EventKind::PlannerRejected { .. } => self.planned(event),
            EventKind::Covered { runs } => {
                if let Some(coverage) = &mut self.coverage {
                    coverage.apply(runs);
                }
            }
            EventKind::FloorChanged { changes } => {
                if let Some(coverage) = &mut self.coverage {
                    coverage.change(changes);
                }
            }
            EventKind::Progressed {
                done,
                along_m,
                cross_track_m,
                target,
                covered_reachable,
                covered_whole,
                ..
            } => {
                self.progress = Some(Progress {
                    done: *done,
                    along_m: *along_m,
                    cross_track_m: *cross_track_m,
                    target: *target,
                    covered_reachable: *covered_reachable,
                    covered_whole: *covered_whole,
                });
            }
            EventKind::Tethered { .. }
            | EventKind::TetherAlarmRaised { .. }
            | EventKind::TetherAlarmCleared { .. }
            | EventKind::Certified { .. } => self.tethered(event),
            EventKind::Held { by, resumes } => self.hold(event, &Hold { by: by.clone(), resumes: *resumes }),
            EventKind::Resumed => {
                self.alarms.clear(&Cause::Stuck);
                self.planner_works();
                if matches!(self.ui.overlay, Overlay::Confirm(Ask::Resume | Ask::FlyUncertified)) {
                    self.withdraw_question();
                }
            }
            EventKind::Ended { outcome, reason } => self.end(event, *outcome, reason),
            EventKind::Truth { .. }
            | EventKind::TetherTruth { .. }
            | EventKind::Snapshotted { .. }
            | EventKind::Discarded { .. }
            | EventKind::PlannerLogged { .. }
            | EventKind::Uncounted { .. } => {}
        }
    }

    /// Takes in an event of a planner.
    fn planned(&mut self, event: &Event) {
        match &event.kind {
            EventKind::PlannerPrepared { ask, .. } => self.planning.candidate = Some(ask.worker),
            EventKind::PlannerChosen { choice, info, .. } => {
                self.planning.candidate = None;
                self.seat(choice, info);
            }
            EventKind::ParametersChanged { choice, .. } => self.planning.choice = Some(choice.clone()),
            EventKind::Planned { ask, path, length_m, complete, .. } => {
                // One that is being prepared: its plan flies when it takes over.
                self.planning.proposed = ask.is_some_and(|ask| self.planning.candidate == Some(ask.worker));
                if self.planning.proposed {
                    return;
                }
                let path = Trail::thinned(path);
                let plan = PlanShown { path, length_m: *length_m, complete: *complete, t_s: event.t_s };
                self.planning.plan = Some(plan);
                self.planner_works();
            }
            EventKind::Commanded { command, .. } => self.command(event.t_s, *command),
            EventKind::Drawn { drawings } => self.draw(event.tick, drawings),
            EventKind::Scalars { scalars } => {
                self.planning.scalars = scalars.iter().take(MAX_SCALARS).cloned().collect();
            }
            EventKind::PlannerFailed { fault, .. } => {
                // A planner that was refused does not replace the active one.
                if self.planner_id() == Some(fault.planner.as_str()) {
                    self.planning.fault = Some(fault.clone());
                }
                self.raise(event, Cause::Planner, fault.severity(), fault.message.clone());
                self.withdraw_question();
            }
            // No alarm: the planner works again, and a fault before may not be acknowledged yet.
            EventKind::PlannerLate { planner, ticks } => {
                self.say(Severity::Watch, late_text(planner, *ticks));
            }
            EventKind::PlannerRejected { planner, why } => {
                self.planning.candidate = None;
                self.say(Severity::Warn, format!("planner {planner} does not take over: {why}"));
            }
            _ => {}
        }
    }

    /// Another planner becomes active.
    fn seat(&mut self, choice: &PlannerChoice, info: &PlannerInfo) {
        (self.planning.choice, self.planning.info) = (Some(choice.clone()), Some(info.clone()));
        self.planning.scalars.clear();
        self.planning.drawings.clear();
        self.planner_works();
    }

    /// Takes in an event of the tether.
    fn tethered(&mut self, event: &Event) {
        match &event.kind {
            EventKind::TetherAlarmRaised { alarm, reached } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = true;
                }
                let severity = if *reached { Severity::Crit } else { Severity::Warn };
                self.raise(event, Cause::Tether(alarm.word().to_owned()), severity, alarm.to_string());
            }
            EventKind::TetherAlarmCleared { alarm } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = false;
                }
                self.alarms.clear(&Cause::Tether(alarm.word().to_owned()));
            }
            // A planner that is being prepared; why it does not take over is reported when it is rejected.
            EventKind::Certified { .. } if self.planning.proposed => {}
            EventKind::Certified { planner, refused, certificate } => {
                self.tether.get_or_insert_default().certified = Some(certificate.certified);
                if certificate.certified {
                    self.alarms.clear(&Cause::Certificate);
                } else {
                    let severity = if *refused { Severity::Crit } else { Severity::Warn };
                    let reasons = certificate.reasons.join("; ");
                    let text = format!("plan of {planner} not certified: {reasons}");
                    self.raise(event, Cause::Certificate, severity, text);
                }
            }
            other => self.tether.get_or_insert_default().lie(other),
        }
    }

    /// Takes in an event of the robot's position.
    fn locate(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Ranged { ranges } => self.position.ranged(event.t_s, ranges.len()),
            EventKind::Fixed { fix } => {
                (self.position.fix, self.position.fix_t_s) = (Some(fix.clone()), event.t_s);
                self.position.failure = None;
                self.alarms.clear(&Cause::NoFix);
            }
            EventKind::FixFailed { error, .. } => {
                self.position.failure = Some(error.to_string());
                self.raise(event, Cause::NoFix, Severity::Watch, format!("no fix: {error}"));
            }
            EventKind::StationRejected { station, reason } => self.exclude(event, *station, reason),
            EventKind::StationRestored { station } => self.alarms.clear(&Cause::Station(*station)),
            EventKind::Estimated { pose } => {
                self.position.estimated(event.t_s, *pose);
                self.trail.add(pose.position);
            }
            EventKind::PositionLost { error_m, limit_m } => {
                self.position.lost = true;
                let text = format!("position lost: 95 % error {error_m:.2} m, limit {limit_m:.2} m");
                self.raise(event, Cause::PositionLost, Severity::Crit, text);
                self.withdraw_question();
            }
            EventKind::PositionRegained { .. } => {
                self.position.lost = false;
                self.alarms.clear(&Cause::PositionLost);
            }
            EventKind::RangesInconsistent { .. } => {
                self.raise(
                    event,
                    Cause::Contradiction,
                    Severity::Crit,
                    "ranges contradict each other".into(),
                );
                self.withdraw_question();
            }
            EventKind::RangesConsistent => self.alarms.clear(&Cause::Contradiction),
            _ => {}
        }
    }

    fn update_clock(&mut self, event: &Event) {
        let passed_s = event.t_s - self.clock.t_s;
        if self.is_running() && passed_s > 0.0 {
            self.clock.moving_s += passed_s;
        }
        (self.clock.tick, self.clock.t_s) = (event.tick, event.t_s);
        self.clock.heard_mono_s = self.console.now.mono_s;
    }

    fn open(&mut self, run: &RunOpened) {
        let preset_m = match &run.mission.task {
            TaskConfig::Follow { path, .. } => Some(world::polyline::length_m(path)),
            TaskConfig::Goto { .. } | TaskConfig::Cover { .. } => None,
        };
        self.run = Some(Run {
            scenario: run.scenario.clone(),
            seed: run.seed,
            world: run.world.as_drawn(),
            mission: run.mission.clone(),
            preset_m,
        });
        self.coverage = Some(Raster::new(run.floor.clone()));
        let (low, high) = run.world.boundary.bounds();
        let forecast = run.mission.forecast((high - low).amax() / FORECAST_CELLS);
        self.accuracy = Some(AccuracyMap::new(&run.world.as_drawn(), &forecast));
        self.planning.choice = Some(run.mission.planner.clone());
    }

    /// Notes that the mission accepted or refused an order. Nothing else ends the wait for it: an event of the tick before
    /// says nothing about an order that comes after it.
    pub(crate) fn answered(&mut self, order: &Order) {
        if self.console.asked.as_ref() == Some(order) {
            self.console.asked = None;
        }
        if *order == Order::Hold {
            self.console.hold_asked = false;
        }
    }

    fn raise(&mut self, event: &Event, cause: Cause, severity: Severity, text: String) {
        self.alarms.raise(cause, severity, text, event.t_s);
    }

    fn exclude(&mut self, event: &Event, station: StationId, reason: &Exclusion) {
        let name = self.station(station).map_or_else(|| format!("station {}", station.0), |s| s.name.clone());
        let why = match reason {
            Exclusion::Silent => "not heard".to_owned(),
            Exclusion::Residual { residual_m, gate_m } => {
                format!("residual {residual_m:.2} m, gate {gate_m:.2} m")
            }
        };
        self.raise(event, Cause::Station(station), Severity::Watch, format!("{name} rejected: {why}"));
    }

    /// The station of that id.
    pub(crate) fn station(&self, id: StationId) -> Option<&Station> {
        self.run.as_ref()?.world.stations.iter().find(|station| station.id == id)
    }

    fn found(&mut self, event: &Event, obstacle: &Obstacle) {
        let at = obstacle.shape.center();
        if let Some(run) = &mut self.run {
            run.world.obstacles.retain(|other| other.known || other.id != obstacle.id);
            run.world.obstacles.push(Obstacle { known: false, ..obstacle.clone() });
        }
        let text = format!("obstacle not on the drawing at {:.2}, {:.2} m", at.x, at.y);
        self.raise(event, Cause::Map, Severity::Watch, text);
    }

    fn moved(&mut self, id: ObstacleId, obstacle: &Obstacle) {
        let found = self.run.iter_mut().flat_map(|run| &mut run.world.obstacles);
        for other in found.filter(|other| !other.known && other.id == id) {
            other.shape = obstacle.shape.clone();
        }
    }

    fn draw(&mut self, tick: u64, drawings: &[Drawing]) {
        if self.planning.drawings_tick != tick {
            self.planning.drawings.clear();
        }
        self.planning.drawings_tick = tick;
        let room = MAX_DRAWINGS.saturating_sub(self.planning.drawings.len());
        self.planning.drawings.extend(drawings.iter().take(room).copied());
    }

    fn command(&mut self, t_s: f64, command: Command) {
        self.planner_works();
        self.planning.command = Some((t_s, command));
    }

    fn planner_works(&mut self) {
        self.planning.fault = None;
        self.alarms.clear(&Cause::Planner);
    }

    fn hold(&mut self, event: &Event, hold: &Hold) {
        if let HoldReason::Stuck { message } = &hold.by {
            self.raise(event, Cause::Stuck, Severity::Warn, format!("stuck: {message}"));
        }
        if !matches!(hold.by, HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced) {
            self.withdraw_question();
        }
    }

    fn end(&mut self, event: &Event, outcome: Outcome, reason: &str) {
        reason.clone_into(&mut self.end_reason);
        self.console.hold_asked = false;
        self.console.asked = None;
        self.withdraw_question();
        let severity = match outcome {
            Outcome::Complete | Outcome::Aborted => return,
            Outcome::Stuck | Outcome::TimeLimit | Outcome::Entangled => Severity::Warn,
            Outcome::Collision => Severity::Crit,
        };
        self.raise(event, Cause::Ended, severity, format!("ended {}: {reason}", outcome.word()));
    }

    /// Takes back a question that was asked under circumstances that no longer hold.
    fn withdraw_question(&mut self) {
        if matches!(self.ui.overlay, Overlay::Confirm(_) | Overlay::Stepping) {
            self.ui.overlay = Overlay::None;
            self.say(Severity::Warn, "Confirmation cancelled: the situation has changed");
        }
    }
}
