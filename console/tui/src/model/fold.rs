//! Folds events into a run.

mod figures;
mod line;
mod link;
mod planner;
mod position;
mod shadow;
mod tether;

use super::alarms::rule;
use super::{About, Cause, Change, FloorLevel, Progress, Raster, Run, Withdrawn};
use mission::{
    Event, EventKind, Hold, HoldReason, Order, Outcome, Phase, Severity, TaskConfig,
    event::{ChannelsJudged, RunOpened},
};
use positioning::{Accuracy, AccuracyMap};
use world::{Obstacle, ObstacleId};

/// The number of cells of the accuracy forecast along the longer side of the floor.
const FORECAST_CELLS: f64 = 100.0;
/// The distance from the place where an obstacle was found beyond which it counts as moving, metres: more than any correction
/// of its estimated place.
const MOVES_M: f64 = 0.5;

impl Run {
    /// Folds in one event. Information that only the simulator can have is ignored, except how a simulated cable lies: its
    /// loops are drawn.
    #[allow(clippy::too_many_lines, reason = "one arm for each kind of event")]
    pub fn fold(&mut self, event: &Event) -> Change {
        let mut change = Change::default();
        if let EventKind::TetherTruth { lies: Some(lies), .. } = &event.kind
            && !lies.line.is_empty()
        {
            self.tether.get_or_insert_default().lies.clone_from(&lies.line);
        }
        if matches!(event.kind, EventKind::Truth { .. } | EventKind::TetherTruth { .. }) {
            return change;
        }
        self.update_clock(event);
        let line = self.write_line(event);
        self.standing.apply(&event.kind);
        match &event.kind {
            EventKind::RunOpened(run) => self.open(run),
            EventKind::Ordered { order } => {
                if order.is_start() {
                    self.clock.started_s = Some(event.t_s);
                }
                if let Order::Note(note) = order {
                    self.alarms.take(note, event.t_s);
                }
                if *order == Order::TakePlan {
                    self.planning.offer.iter_mut().for_each(|offer| offer.is_taken = true);
                }
                if self.is_waiting() && changes_plan(order) {
                    self.forget_plan();
                }
                if let Order::SetParameter { key, value } = order {
                    self.order_parameter(key, value);
                }
                change.answered = Some(order.clone());
                self.shadowed(event, &mut change);
            }
            EventKind::OrderRefused { order, why } => {
                change.answered = Some(order.clone());
                change.say(Severity::Warn, format!("order refused: {why}"));
            }
            EventKind::ChannelsJudged(judged) => self.judge_channels(event, judged),
            EventKind::Ranged { .. }
            | EventKind::Fixed { .. }
            | EventKind::FixFailed { .. }
            | EventKind::StationRejected { .. }
            | EventKind::StationRestored { .. }
            | EventKind::Estimated { .. }
            | EventKind::Protected { .. }
            | EventKind::ProtectionLost { .. }
            | EventKind::ProtectionRegained { .. }
            | EventKind::SessionCalibrated { .. }
            | EventKind::ClocksEstimated { .. }
            | EventKind::PulsesAwaited { .. }
            | EventKind::PulsesTested { .. }
            | EventKind::PulsesFailed { .. }
            | EventKind::ClocksChanged { .. }
            | EventKind::StationBiased { .. }
            | EventKind::StationUnbiased { .. }
            | EventKind::NotSeparable { .. }
            | EventKind::Separable
            | EventKind::PositionLost { .. }
            | EventKind::PositionRegained { .. }
            | EventKind::RangesInconsistent { .. }
            | EventKind::RangesConsistent => self.locate(event, &mut change),
            EventKind::ObstacleFound { obstacle } => self.found(event, obstacle),
            EventKind::ZoneDrawn { zone } => {
                // The previous plan does not take the change into account, so a new one is made.
                self.forget_certificate();
                if self.is_waiting() {
                    self.forget_plan();
                }
                self.about.iter_mut().for_each(|about| about.world.zones.push(zone.clone()));
            }
            EventKind::ReturnBegan { way } => {
                self.way_back = Some(way.clone());
                self.position.pulses_until_s = None;
            }
            EventKind::ZoneBreached { zone, .. } => self.raise_as_logged(event, Cause::Zone(zone.clone())),
            EventKind::ZoneLeft { zone } => self.clear(&Cause::Zone(zone.clone())),
            EventKind::ObstacleMoved { id, obstacle } => self.moved(*id, obstacle),
            EventKind::NotThere { name, .. } => self.raise_as_logged(event, Cause::NotThere(name.clone())),
            EventKind::PlannerPrepared { .. }
            | EventKind::PlannerChosen { .. }
            | EventKind::ParametersChanged { .. }
            | EventKind::Planned { .. }
            | EventKind::Commanded { .. }
            | EventKind::Drawn { .. }
            | EventKind::Scalars { .. }
            | EventKind::PlannerFailed { .. }
            | EventKind::PlannerLate { .. }
            | EventKind::BetterPlanned(_)
            | EventKind::BetterPlanTaken(_)
            | EventKind::BetterPlanDropped(_)
            | EventKind::PlannerRejected { .. } => self.planned(event, &mut change),
            EventKind::ShadowBegan { .. }
            | EventKind::Shadowed { .. }
            | EventKind::ShadowMissed { .. }
            | EventKind::PromotionRefused { .. }
            | EventKind::Promoted { .. }
            | EventKind::ShadowEnded { .. } => self.shadowed(event, &mut change),
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
            EventKind::Progressed { .. } => self.progress(event),
            EventKind::Tethered { .. }
            | EventKind::TetherAlarmRaised { .. }
            | EventKind::TetherAlarmCleared { .. }
            | EventKind::Certified { .. } => self.tethered(event),
            EventKind::Held { by, resumes } => {
                self.hold(event, &Hold { by: by.clone(), resumes: *resumes }, &mut change);
            }
            EventKind::Resumed => {
                self.linked(event);
                self.clear(&Cause::Stuck);
                self.clear(&Cause::Guard);
                self.planner_works();
                change.withdraw(Withdrawn::Resume);
            }
            EventKind::Ended { outcome, reason } => self.end(event, *outcome, reason, &mut change),
            EventKind::Truth { .. }
            | EventKind::TetherTruth { .. }
            | EventKind::Snapshotted { .. }
            | EventKind::Discarded { .. }
            | EventKind::SpeedLimited { .. }
            | EventKind::Guarded { .. }
            | EventKind::MediumAwaited
            | EventKind::MediumKnown { .. }
            | EventKind::PlannerLogged { .. }
            | EventKind::Uncounted { .. }
            | EventKind::Scanned { .. }
            | EventKind::SurveyWay(_)
            | EventKind::Explored(_)
            | EventKind::Mapped { .. }
            | EventKind::ScannerJudged { .. }
            | EventKind::ScanAided { .. }
            | EventKind::Sensed { .. } => {}
            EventKind::Link(_)
            | EventKind::Noticed(_)
            | EventKind::Stood { .. }
            | EventKind::Sent { .. }
            | EventKind::PositionAwaited { .. } => self.linked(event),
        }
        self.read_figures(&event.kind);
        self.scanned(event);
        self.surveyed(event);
        if let (Some(number), Some(cause)) = (line, Cause::of(&event.kind)) {
            let place = self.log.get(number).and_then(|entry| self.place_of(&entry.what));
            self.alarms.note(&cause, number, place);
        }
        change
    }

    /// Forgets the plan made before the start when a new one is being made: the old plan will not run.
    fn forget_plan(&mut self) {
        self.planning.plan = None;
        self.forget_certificate();
        self.clear(&Cause::Certificate);
    }

    fn is_waiting(&self) -> bool {
        *self.phase() == Phase::Waiting
    }

    fn progress(&mut self, event: &Event) {
        let EventKind::Progressed {
            done,
            along_m,
            cross_track_m,
            target,
            covered_reachable,
            covered_whole,
            ..
        } = &event.kind
        else {
            return;
        };
        self.scanned_history.add(event.t_s, 100.0 * covered_reachable);
        // A drive back crosses lanes without scanning them, so it does not advance the plan.
        let kept = self.progress.take().filter(|_| self.phase().is_return());
        let kept = kept.map(|kept| (kept.done, kept.along_m, kept.cross_track_m, kept.target));
        let (done, along_m, cross_track_m, target) =
            kept.unwrap_or((*done, *along_m, *cross_track_m, *target));
        self.progress = Some(Progress {
            t_s: event.t_s,
            done,
            along_m,
            cross_track_m,
            target,
            covered_reachable: *covered_reachable,
            covered_whole: *covered_whole,
        });
    }

    fn update_clock(&mut self, event: &Event) {
        let passed_s = event.t_s - self.clock.t_s;
        if self.is_running() && passed_s > 0.0 {
            self.clock.moving_s += passed_s;
        }
        (self.clock.tick, self.clock.t_s) = (event.tick, event.t_s);
        self.alarms.expire(event.t_s);
    }

    fn open(&mut self, run: &RunOpened) {
        let preset_m = match &run.mission.task {
            TaskConfig::Follow { path, .. } => Some(world::polyline::length_m(path)),
            TaskConfig::Goto { .. } | TaskConfig::Cover { .. } | TaskConfig::Survey { .. } => None,
        };
        self.about = Some(About {
            scenario: run.scenario.clone(),
            seed: run.seed,
            world: run.world.as_drawn(),
            mission: run.mission.clone(),
            preset_m,
            checklist: run.checklist.clone(),
            plates: run.plates.clone(),
        });
        self.coverage = Some(Raster::new(run.floor.clone()));
        let (low, high) = run.world.boundary.bounds();
        let forecast = run.mission.forecast((high - low).amax() / FORECAST_CELLS);
        let risk = run.mission.locating.risk.unwrap_or_default();
        let drawing = run.world.as_drawn();
        let accuracy = AccuracyMap::new(&drawing, &forecast).with_checks(&drawing, &forecast, &risk);
        self.accuracy_stamp = accuracy_stamp(&accuracy, run.mission.position_limit_m);
        self.level = run.mission.locating.risk.map(|_| FloorLevel::of(&accuracy));
        self.accuracy = Some(accuracy);
        self.planning.choice = Some(run.mission.planner.clone());
    }

    /// Takes the cause of an alarm; the rule depends on what the mission is doing.
    fn raise(&mut self, event: &Event, cause: Cause, severity: Severity, text: String) {
        let rule = rule::rule(&cause, severity, self.context());
        self.alarms.occurred(cause, rule, text, event.t_s);
    }

    fn clear(&mut self, cause: &Cause) {
        let severity = self.alarms.get(cause).map_or(Severity::Info, |alarm| alarm.severity);
        let off_delay_s = rule::rule(cause, severity, self.context()).off_delay_s;
        self.alarms.passed(cause, off_delay_s, self.clock.t_s);
    }

    /// Raises an alarm with the text of the log line.
    /// Other channels of the instrument are dead than before.
    fn judge_channels(&mut self, event: &Event, judged: &ChannelsJudged) {
        self.dead_channels.clone_from(&judged.dead);
        if judged.dead.is_empty() {
            self.clear(&Cause::DeadChannel);
        } else {
            self.raise_as_logged(event, Cause::DeadChannel);
        }
    }

    fn raise_as_logged(&mut self, event: &Event, cause: Cause) {
        if let Some(line) = event.log_line(self.stations()) {
            self.raise(event, cause, line.severity, line.text);
        }
    }

    fn found(&mut self, event: &Event, obstacle: &Obstacle) {
        if let Some(about) = &mut self.about {
            about.world.obstacles.retain(|other| other.known || other.id != obstacle.id);
            about.world.obstacles.push(Obstacle { known: false, ..obstacle.clone() });
        }
        self.found_at.insert(obstacle.id, (obstacle.shape.center(), false));
        self.raise_as_logged(event, Cause::Map);
    }

    fn moved(&mut self, id: ObstacleId, obstacle: &Obstacle) {
        let moved_before = self.finds_only_moving();
        if let Some((found, moves)) = self.found_at.get_mut(&id) {
            *moves |= (obstacle.shape.center() - *found).norm() > MOVES_M;
        }
        if self.finds_only_moving() && !moved_before {
            self.alarms
                .reword(&Cause::Map, |text| text.replacen("obstacle at", "moving obstacle, found at", 1));
        }
        let found = self.about.iter_mut().flat_map(|about| &mut about.world.obstacles);
        for other in found.filter(|other| !other.known && other.id == id) {
            other.shape = obstacle.shape.clone();
        }
    }

    fn hold(&mut self, event: &Event, hold: &Hold, change: &mut Change) {
        // The planner has not failed: it made a plan, but the plan was refused.
        if matches!(hold.by, HoldReason::PlannerFault { .. }) && self.planning.fault.is_none() {
            self.forget_certificate();
        }
        if let Some(cause) = Cause::of(&event.kind)
            && let Some(severity) = rule::held_for(&cause)
        {
            self.alarms.holds(&cause, severity, event.t_s);
        }
        if let HoldReason::Stuck { message } = &hold.by {
            self.raise(event, Cause::Stuck, Severity::Warn, format!("stuck: {message}"));
        }
        if !matches!(hold.by, HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced) {
            change.withdraw(Withdrawn::All);
        }
    }

    fn end(&mut self, event: &Event, outcome: Outcome, reason: &str, change: &mut Change) {
        reason.clone_into(&mut self.end_reason);
        self.planning.offer = None;
        change.withdraw(Withdrawn::All);
        self.alarms.conclude(event.t_s);
        let severity = match outcome {
            Outcome::Complete | Outcome::Aborted => return,
            Outcome::Stuck | Outcome::TimeLimit | Outcome::Entangled => Severity::Warn,
            Outcome::Collision => Severity::Crit,
        };
        self.raise(event, Cause::Ended, severity, format!("ended ({}): {reason}", outcome.word()));
    }
}

/// Mixes the forecast errors, the levels and their limit into a stamp (FNV-1a).
fn accuracy_stamp(map: &AccuracyMap, limit_m: f64) -> u64 {
    let level_m = |cell: Accuracy| cell.checks.and_then(|checks| checks.level_m);
    let both_m = |cell: &Option<Accuracy>| [cell.and_then(|cell| cell.error_95_m), cell.and_then(level_m)];
    let errors_m = map.cells.iter().flat_map(both_m).map(|length| length.unwrap_or(f64::INFINITY));
    [map.origin.x, map.origin.y, map.cell_m, map.width as f64, limit_m]
        .into_iter()
        .chain(errors_m)
        .fold(0xcbf2_9ce4_8422_2325, |stamp, value| (stamp ^ value.to_bits()).wrapping_mul(0x0100_0000_01b3))
}

/// Whether an order given before the start makes the current plan obsolete.
fn changes_plan(order: &Order) -> bool {
    matches!(order, Order::Plan | Order::ChoosePlanner(_) | Order::SetParameter { .. })
}
