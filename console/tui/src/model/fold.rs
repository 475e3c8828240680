//! Events into the model.

mod planner;
mod position;
mod tether;

use super::{Cause, Model, Overlay, Progress, Raster, Run, ui::Ask};
use mission::{Event, EventKind, Hold, HoldReason, Order, Outcome, Severity, TaskConfig, event::RunOpened};
use positioning::AccuracyMap;
use world::{Obstacle, ObstacleId};

/// Cells of the accuracy forecast along the longer side of the floor.
const FORECAST_CELLS: f64 = 100.0;

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
                self.say(Severity::Warn, format!("order refused: {why}"));
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

    /// Raises an alarm in the words of the log.
    fn raise_as_logged(&mut self, event: &Event, cause: Cause) {
        if let Some(line) = event.log_line() {
            self.raise(event, cause, line.severity, line.text);
        }
    }

    fn found(&mut self, event: &Event, obstacle: &Obstacle) {
        if let Some(run) = &mut self.run {
            run.world.obstacles.retain(|other| other.known || other.id != obstacle.id);
            run.world.obstacles.push(Obstacle { known: false, ..obstacle.clone() });
        }
        self.raise_as_logged(event, Cause::Map);
    }

    fn moved(&mut self, id: ObstacleId, obstacle: &Obstacle) {
        let found = self.run.iter_mut().flat_map(|run| &mut run.world.obstacles);
        for other in found.filter(|other| !other.known && other.id == id) {
            other.shape = obstacle.shape.clone();
        }
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
        self.raise(event, Cause::Ended, severity, format!("ended ({}): {reason}", outcome.word()));
    }

    /// Takes back a question that was asked under circumstances that no longer hold.
    fn withdraw_question(&mut self) {
        if matches!(self.ui.overlay, Overlay::Confirm(_) | Overlay::Stepping) {
            self.ui.overlay = Overlay::None;
            self.say(Severity::Warn, "question cancelled: conditions have changed");
        }
    }
}
