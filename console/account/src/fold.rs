//! Folds the events of a run into its summary, one by one.

use crate::{
    Account, Evidence, Solid,
    accuracy::{Accuracy, Claimed},
    doubt::TakenBack,
    drawn::DrawnZone,
    figures::{Figure, Figures},
    floor::account,
    passes::Margins,
    protection::Protection,
    ranging::Ranging,
    readings::{Survey, Way},
    scanned::Scanned,
    silence::{Silence, Step, Way as TrackedWay},
    summary::{self, REPORT_VERSION, Summary, Tether},
    tethered::Tethered,
    tracking::Tracker,
    turning::Turning,
    vehicle::VehicleRecord,
};
use exploration::SurveyMap;
use mission::{
    Cause, Channels, Event, EventKind, FoldedStanding, Guarantee, Order, Outcome, ParamKind, ParamValue,
    Parameters, Passage, PlannerChoice, PlannerInfo, TaskConfig,
    event::{ChannelsJudged, RunOpened, TetherAlarm, ToolTrack},
};
use nalgebra::Matrix2;
use planner_api::PoseEstimate;
use positioning::{
    Estimated,
    fix::{ellipse_95, position_covariance},
};
use world::{Obstacle, Point, Pose, StationId, Zone};

/// Maximum number of listed faults.
const MOST_FAULTS: usize = 20;
/// Maximum number of listed planners.
const MOST_PLANNERS: usize = 1000;

/// The state of a run, from its events so far.
#[derive(Debug, Default)]
pub struct Fold {
    known: Box<Summary>,
    truth: Option<Pose>,
    scanned: Option<Scanned>,
    tracker: Option<Tracker>,
    accuracy: Accuracy,
    claimed: Claimed,
    protection: Protection,
    ranging: Ranging,
    standing: FoldedStanding,
    turning: Turning,
    tethered: Option<Tethered>,
    /// The tool of located readings; `None` for a mission.
    tool: Option<ToolTrack>,
    figures: Box<Figures>,
    run: Option<Box<RunOpened>>,
    evidence: Option<Evidence>,
    survey: Option<Box<Survey>>,
    /// The map that the mission has made, and the number of places that the tether did not reach.
    map: Option<Box<SurveyMap>>,
    beyond_tether: usize,
    /// The channels of the instrument; `None` before the run is opened.
    channels: Option<Channels>,
    /// The way of a tool whose readings may be imported; `None` for any other run.
    way: Option<TrackedWay>,
    /// Whether floor on the way to the latest estimated position counts as scanned.
    counts: bool,
    /// Whether the previous event drew a zone: the change to the floor that follows belongs to that zone.
    is_zone_new: bool,
    /// Whether the account of the floor is omitted.
    leaves_out_floor: bool,
}

impl Fold {
    /// The state before any event.
    pub fn new() -> Self {
        Self::default()
    }

    /// The state before any event, without the account of the floor, for callers that need only the figures: this
    /// takes a third of the time.
    pub fn of_figures() -> Self {
        Self { leaves_out_floor: true, ..Self::default() }
    }

    /// Adds an event; events must come in the order of the journal.
    pub fn apply(&mut self, event: &Event) {
        self.known.ticks = Some(event.tick);
        self.known.mission_time_s = Some(event.t_s);
        self.standing.apply(&event.kind);
        self.figures.apply(event);
        self.ranging.apply(event.t_s, &event.kind);
        self.known.vehicle.iter_mut().for_each(|vehicle| vehicle.apply(&event.kind));
        match &event.kind {
            EventKind::RunOpened(run) => self.open(run),
            EventKind::Truth { pose, clearance_m, collided } => {
                self.see_truth(*pose, *clearance_m, *collided);
                let error_m = self.accuracy.truth(event.tick, pose.position);
                self.note_error(error_m);
            }
            EventKind::TetherAlarmRaised { alarm: TetherAlarm::Snag { .. }, .. } => self.snag(true),
            EventKind::TetherAlarmRaised { alarm: TetherAlarm::Broken { .. }, .. } => {
                self.tethered.iter_mut().for_each(|tethered| tethered.tear(event.t_s));
            }
            EventKind::TetherAlarmCleared { alarm: TetherAlarm::Snag { .. } } => self.snag(false),
            EventKind::TetherTruth { length_m, wrap_max_rad, wrap_total_rad, detour_m, lies } => {
                if let Some(tethered) = &mut self.tethered {
                    tethered.lie(*length_m, *wrap_max_rad, *wrap_total_rad, *detour_m);
                    if let Some(lies) = lies {
                        tethered.cross(lies.torn, lies.under_hull);
                    }
                }
            }
            EventKind::ChannelsJudged(judged) => self.judge_channels(judged),
            EventKind::Protected { level_m } => self.protection.take(*level_m),
            EventKind::Estimated { pose } => self.estimate(event, pose),
            EventKind::Ranged { .. } => self.claimed.end_cycle(),
            EventKind::Fixed { fix } => self.claimed.fix(fix.used.len()),
            EventKind::Ordered { order: Order::NoteChecks(checks) } => self.known.checks.clone_from(checks),
            EventKind::PositionLost { .. } => self.accuracy.lost(event.t_s),
            EventKind::PositionRegained { .. } => self.accuracy.regained(event.t_s),
            EventKind::SurveyWay(way) => self.beyond_tether = way.beyond_tether,
            EventKind::Mapped { map } => self.map = Some(map.clone()),
            EventKind::Covered { runs } => self.scanned.iter_mut().for_each(|scanned| scanned.believe(runs)),
            EventKind::Planned { path, complete, cuts, .. } if !self.is_preset() => {
                self.evidence.iter_mut().for_each(|evidence| evidence.plan(path, cuts, *complete));
            }
            EventKind::Certified { refused: true, .. } => {
                self.evidence.iter_mut().for_each(Evidence::refuse_plan);
            }
            EventKind::Uncounted { runs } => {
                self.evidence.iter_mut().for_each(|evidence| evidence.leave_uncounted(runs));
            }
            EventKind::ObstacleMoved { obstacle, .. } => self.find(obstacle),
            EventKind::FloorChanged { changes } => {
                self.scanned.iter_mut().for_each(|scanned| scanned.change(changes));
                if let Some(evidence) = self.evidence.as_mut().filter(|_| self.is_zone_new) {
                    evidence.shut(changes);
                }
            }
            EventKind::Progressed { done, along_m, .. } => self.progress(*done, *along_m),
            EventKind::PlannerChosen { choice, info, .. } => self.choose(choice, info),
            EventKind::ParametersChanged { choice, .. } => self.set_parameters(choice),
            EventKind::ZoneDrawn { zone } => self.draw_zone(zone, event.t_s),
            EventKind::StationBiased { station, bias_m, since_s, .. } => {
                self.take_back(*station, *bias_m, *since_s, event.t_s);
            }
            EventKind::ObstacleFound { obstacle } => {
                self.known.obstacles_found += 1;
                self.find(obstacle);
            }
            EventKind::PlannerFailed { fault, .. } => {
                // A planner that the console refused to load or to activate was not running, so it has not failed.
                // Nor has one that continues with its old parameters.
                let refused =
                    matches!(fault.cause, Cause::Refused | Cause::Quarantined) || fault.refuses_change();
                // A planner that reports that no path exists has not failed either.
                if !fault.is_no_way() {
                    self.known.planner_faults += u64::from(!refused);
                    self.note_fault(event.t_s, "", &fault.message);
                }
            }
            EventKind::Shadowed { of } => {
                if let EventKind::PlannerFailed { fault, .. } = &**of
                    && !fault.is_no_way()
                {
                    self.note_fault(event.t_s, "shadow: ", &fault.message);
                }
            }
            EventKind::Held { .. } => self.known.holds += 1,
            EventKind::Ended { outcome, reason } => {
                self.known.outcome = Some(*outcome);
                if *outcome == Outcome::Complete {
                    self.evidence.iter_mut().for_each(Evidence::complete);
                }
                self.known.reason = Some(reason.clone());
            }
            _ => {}
        }
        self.is_zone_new = matches!(event.kind, EventKind::ZoneDrawn { .. });
    }

    fn draw_zone(&mut self, zone: &Zone, t_s: f64) {
        self.run.iter_mut().for_each(|run| run.world.zones.push(zone.clone()));
        let drawn = DrawnZone::new(zone, t_s, &self.standing.phase);
        self.evidence.iter_mut().for_each(|evidence| evidence.forbid(drawn.words(), &zone.shape));
        self.known.zones_drawn.push(drawn);
    }

    fn take_back(&mut self, station: StationId, bias_m: Estimated, since_s: f64, until_s: f64) {
        let Some((run, scanned)) = self.run.as_ref().zip(self.scanned.as_mut()) else { return };
        let found = run.world.stations.iter().find(|other| other.id == station);
        let station = found.map_or_else(|| station.0.to_string(), |found| found.name.clone());
        let area_m2 = scanned.take_back(since_s);
        let (bias_m, bias_sigma_m) = (bias_m.value, Some(bias_m.sigma));
        self.known.taken_back.push(TakenBack {
            station,
            bias_m,
            bias_sigma_m,
            since_s,
            until_s,
            area_m2,
            left_m2: None,
        });
    }

    fn note_fault(&mut self, t_s: f64, whose: &str, message: &str) {
        if self.known.faults.len() < MOST_FAULTS {
            self.known.faults.push(format!("{whose}{message} (at {t_s:.1} s)"));
        }
    }

    /// Adds the estimated position. The mission determines whether floor passed on the way counts; for located
    /// readings, floor counts between two poses that are known well enough.
    fn estimate(&mut self, event: &Event, estimate: &PoseEstimate) {
        let here = Pose { position: estimate.position, heading_rad: estimate.heading_rad };
        let covariance = position_covariance(&estimate.covariance);
        let (error_m, limit_m) = (ellipse_95(&covariance).0, self.scan_limit_m());
        let true_error_m = self.accuracy.estimate(event.tick, here.position, covariance);
        self.note_error(true_error_m);
        self.claimed.estimate(here.position, error_m, limit_m);
        let counts = match self.tool.as_mut().map(|tool| tool.visit(event.t_s, estimate)) {
            None => Passage::of(&self.standing.phase, error_m, limit_m) == Passage::Counts,
            Some(passed) => {
                if passed.is_some_and(|(from, to)| from == to) {
                    // A single position: no floor was passed on the way.
                    self.visit(here, &covariance, error_m, false);
                }
                passed.is_some()
            }
        };
        self.visit(here, &covariance, error_m, counts);
        self.counts = counts;
        if let (Some(survey), Some(truth), Some(scanned)) = (&mut self.survey, self.truth, &self.scanned) {
            let way = Way { floor: scanned.believed().floor(), counts };
            let is_dead = |channel| self.channels.as_ref().is_some_and(|channels| channels.is_dead(channel));
            survey.visit((event.tick, event.t_s), estimate, truth, way, is_dead);
        }
    }

    /// Moves the tool to a pose, and records whether the floor that the tool passed over counts.
    fn visit(&mut self, here: Pose, covariance: &Matrix2<f64>, error_m: f64, counts: bool) {
        let error_m_lately = counts.then(|| self.claimed.tip_m());
        let margin_m = match &self.scanned {
            Some(_) if self.is_guaranteed_by_protection() => self.protection.level_m(),
            Some(scanned) => scanned.across_m(here, covariance),
            None => f64::INFINITY,
        };
        let t_s = self.known.mission_time_s.unwrap_or_default();
        let lately = error_m_lately.map(|error_m| Margins { error_m, margin_m, t_s });
        if let Some(way) = &mut self.way {
            way.push(Step { t_s, here, error_m, margins: lately });
        }
        self.scanned.iter_mut().for_each(|scanned| scanned.visit(here, lately));
        self.evidence.iter_mut().for_each(|evidence| evidence.visit(here, error_m, counts));
    }

    /// Other channels of the instrument are dead from the last pose on.
    fn judge_channels(&mut self, judged: &ChannelsJudged) {
        let Some(channels) = &mut self.channels else { return };
        channels.apply(judged);
        self.way.iter_mut().for_each(|way| way.declare(&judged.dead));
        self.evidence.iter_mut().for_each(|evidence| evidence.test_with(channels));
        if let Some(scanned) = &mut self.scanned {
            let rim_m = scanned.believed().floor().rim_m();
            scanned.test_with(channels.live(rim_m));
        }
    }

    /// Adds the true position error of a tick, metres, to the floor that the tool truly passed in it.
    fn note_error(&mut self, error_m: Option<f64>) {
        if let Some((scanned, error_m)) = self.scanned.as_mut().zip(error_m) {
            scanned.note_error(error_m);
        }
    }

    /// Whether the protection level decides which floor is guaranteed.
    fn is_guaranteed_by_protection(&self) -> bool {
        let by_protection = |run: &RunOpened| run.mission.scan.guarantee == Guarantee::Protection;
        self.run.as_ref().is_some_and(|run| by_protection(run))
    }

    /// Limit of the 95 % error above which nothing counts as scanned, metres.
    fn scan_limit_m(&self) -> f64 {
        self.run.as_ref().map_or(f64::INFINITY, |run| run.mission.scan_limit_m())
    }

    fn snag(&mut self, snagged: bool) {
        self.tethered.iter_mut().for_each(|tethered| tethered.snag(snagged));
    }

    /// Takes floor back that silent channels of imported readings passed, and no other channel tested. The summary
    /// changes with it.
    pub fn silence(&mut self, silences: &[Silence]) {
        let (Some(run), Some(way), false) = (&self.run, &self.way, silences.is_empty()) else { return };
        let (Some(scanned), Some(evidence)) = (&mut self.scanned, &mut self.evidence) else { return };
        let taken: Vec<(f64, f64)> =
            self.known.taken_back.iter().map(|taken| (taken.since_s, taken.until_s)).collect();
        let mut channels = Channels::new(&run.mission);
        way.silence(silences, (&mut channels, run.mission.start), (scanned, evidence), &taken);
    }

    /// The figures so far. Figures that no event provides are absent; the app fills them in.
    pub fn summary(&self) -> Summary {
        Summary {
            report_version: Some(REPORT_VERSION),
            floor: self.account(),
            coverage: self
                .scanned
                .as_ref()
                .filter(|_| self.says_what_was_scanned())
                .map(|scanned| scanned.coverage(self.is_to_scan())),
            turns: self.has_heading().then(|| self.turning.turns()),
            rotation_turns: self.has_heading().then(|| self.turning.rotation_turns()),
            tether: self.tether(),
            explored: self.map.as_ref().map(|map| map.explored),
            tracking: self.tracker.as_ref().and_then(Tracker::tracking),
            accuracy: self
                .claimed
                .statement(self.scan_limit_m())
                .map(|accuracy| summary::Accuracy { protection: self.protection_statement(), ..accuracy }),
            extremes: self.extremes(),
            readings: self
                .survey
                .as_ref()
                .zip(self.scanned.as_ref())
                .map(|(survey, scanned)| survey.summary(scanned.believed().floor())),
            positioning: self.accuracy.positioning(self.known.mission_time_s.unwrap_or(0.0)),
            taken_back: self.still_in_doubt(),
            calibration: self.ranging.calibration(),
            clocks: self.ranging.clocks(),
            pulse_tests: self.ranging.pulse_tests().to_vec(),
            ..(*self.known).clone()
        }
    }

    /// The protection levels, with the risk for which they were computed.
    fn protection_statement(&self) -> Option<summary::Protection> {
        let risk = self.run.as_ref().and_then(|run| run.mission.locating.risk);
        let statement = self.protection.statement(self.is_guaranteed_by_protection())?;
        Some(summary::Protection { risk, ..statement })
    }

    /// The floor whose guarantee was taken back, with the part that no later pass guarantees.
    pub(crate) fn still_in_doubt(&self) -> Vec<TakenBack> {
        let left_m2 = |time| self.scanned.as_ref().map(|scanned| scanned.left_in_doubt_m2(time));
        let times = self.known.taken_back.iter().zip(1..);
        times.map(|(floor, time)| TakenBack { left_m2: left_m2(time), ..floor.clone() }).collect()
    }

    /// The table of figures: the latest and the worst value of each, with its limit.
    pub fn figures(&self) -> &Figures {
        &self.figures
    }

    /// The figures of a mission that have a worst value; none for located readings, in which no robot keeps to limits.
    fn extremes(&self) -> Vec<Figure> {
        let rows = self.figures.rows().iter().filter(|row| row.worst.is_some() && self.tool.is_none());
        rows.copied().collect()
    }

    /// The account of the floor; `None` for missions without a scan.
    fn account(&self) -> Option<Account> {
        let run = self.run.as_ref().filter(|_| self.is_to_scan())?;
        Some(account(run, self.scanned.as_ref()?, self.evidence.as_ref()?))
    }

    /// Whether the task of the mission is to scan the floor.
    fn is_to_scan(&self) -> bool {
        let scans = |run: &RunOpened| matches!(run.mission.task, TaskConfig::Cover { .. });
        self.run.as_ref().is_some_and(|run| scans(run) && run.measured.is_none())
    }

    /// The run as it was opened, with the zones that were drawn since; `None` before the opening.
    pub fn run(&self) -> Option<&RunOpened> {
        self.run.as_deref()
    }

    /// The scanned floor; `None` before the run is opened.
    pub fn scanned(&self) -> Option<&Scanned> {
        self.scanned.as_ref()
    }

    /// The floor whose guarantee was taken back so far, oldest first.
    pub fn taken_back(&self) -> &[TakenBack] {
        &self.known.taken_back
    }

    /// The instrument and its readings; `None` if it reads no thickness, and without the account of the floor.
    pub fn survey(&self) -> Option<&Survey> {
        self.survey.as_deref()
    }

    /// Whether floor on the way to the latest estimated position counts as scanned.
    pub fn counts(&self) -> bool {
        self.counts
    }

    /// The evidence for missed floor; `None` before the run is opened, and without the account of the floor.
    pub fn evidence(&self) -> Option<&Evidence> {
        self.evidence.as_ref()
    }

    /// Whether the scanned floor is known: for located readings, only if they show when the tool was on.
    pub fn says_what_was_scanned(&self) -> bool {
        self.tool.as_ref().is_none_or(ToolTrack::is_known)
    }

    /// Whether the true heading is known: readings may contain true positions without one.
    fn has_heading(&self) -> bool {
        self.known.path_length_m.is_some() && self.tool.is_none()
    }

    /// Whether the task is to scan the floor; also true for located readings, which have no task.
    pub fn has_floor_to_scan(&self) -> bool {
        let scans = |run: &RunOpened| matches!(run.mission.task, TaskConfig::Cover { .. });
        self.run.as_ref().is_some_and(|run| scans(run) || run.measured.is_some())
    }

    /// The map that the mission has made; `None` before the end of a survey, and for other missions.
    pub fn map(&self) -> Option<&SurveyMap> {
        self.map.as_deref()
    }

    /// Number of places that a survey left out because the tether did not reach them, according to its last way.
    pub fn beyond_tether(&self) -> usize {
        self.beyond_tether
    }

    /// The found obstacles, which are not on the drawing.
    pub fn found(&self) -> impl Iterator<Item = &Solid> {
        self.evidence.iter().flat_map(|evidence| evidence.found().map(|(_, solid)| solid))
    }

    /// The true position at the end; `None` outside simulation.
    pub fn true_place(&self) -> Option<Point> {
        self.truth.map(|pose| pose.position)
    }

    fn tether(&self) -> Option<Tether> {
        self.tethered.as_ref()?.tether(self.truth.map(|pose| pose.position), self.known.outcome)
    }

    /// Whether the path is preset. If so, a planner only plans how to follow the path.
    fn is_preset(&self) -> bool {
        self.tracker.is_some()
    }

    fn progress(&mut self, done: f64, along_m: Option<f64>) {
        if let (Some(tracker), Some(along_m)) = (&mut self.tracker, along_m) {
            tracker.progress(along_m);
        }
        match (&mut self.evidence, along_m) {
            (Some(evidence), Some(along_m)) => evidence.fly(along_m),
            (Some(evidence), None) => evidence.fly_share(done),
            (None, _) => {}
        }
    }

    fn find(&mut self, obstacle: &Obstacle) {
        self.evidence.iter_mut().for_each(|evidence| evidence.find(obstacle));
    }

    fn open(&mut self, run: &RunOpened) {
        self.run = Some(Box::new(run.clone()));
        let session = run.mission.locating.session.unwrap_or_default();
        self.ranging = Ranging::new(&run.world.stations, session.sound_speed);
        self.known.scenario = Some(run.scenario.clone());
        self.known.seed = Some(run.seed);
        self.known.vehicle = run.vehicle.as_deref().map(VehicleRecord::new);
        self.known.planner = Some(run.mission.planner.id.clone());
        self.known.parameters = Some(run.mission.planner.parameters.clone());
        self.channels = Some(Channels::new(&run.mission));
        self.evidence = (!self.leaves_out_floor).then(|| Evidence::new(run));
        self.survey = (!self.leaves_out_floor).then(|| Survey::new(run)).flatten().map(Box::new);
        // A survey drives without its tool.
        let uses_tool = !run.mission.task.is_survey();
        self.scanned =
            uses_tool.then(|| Scanned::new(run.floor.clone(), run.mission.tool(), run.mission.start));
        let may_import = !self.leaves_out_floor && self.survey.is_none();
        let reads = run.mission.instrument.as_ref().is_some_and(|instrument| instrument.sampling.is_some());
        self.way = (may_import && reads).then(TrackedWay::default);
        if let Some(measured) = &run.measured {
            // Adds a located pose; the floor passed there counts only while the tool was on.
            self.known.located = Some(measured.file.clone());
            self.tool = Some(ToolTrack::new(measured, &run.mission));
            return;
        }
        self.tethered = run.mission.tether.as_ref().map(Tethered::new);
        if let TaskConfig::Follow { path, .. } = &run.mission.task {
            self.evidence.iter_mut().for_each(|evidence| evidence.plan(path, &[], true));
            self.tracker = Some(Tracker::new(path));
        }
    }

    fn see_truth(&mut self, pose: Pose, clearance_m: f64, collided: bool) {
        let known = &mut self.known;
        self.turning.pass(pose);
        let before = self.truth.replace(pose).unwrap_or(pose);
        let way_m = (pose.position - before.position).norm();
        known.path_length_m = Some(known.path_length_m.unwrap_or(0.0) + way_m);
        // The readings do not contain collisions.
        if self.run.as_ref().is_none_or(|run| run.measured.is_none()) {
            known.collisions = Some(known.collisions.unwrap_or(0) + u64::from(collided));
        }
        if clearance_m.is_finite() {
            known.clearance_min_m =
                Some(known.clearance_min_m.map_or(clearance_m, |least| least.min(clearance_m)));
        }
        if let Some(scanned) = self.scanned.as_mut().filter(|_| self.tool.is_none()) {
            scanned.pass(before, pose);
        }
        self.tracker.iter_mut().for_each(|tracker| tracker.pass(before.position, pose.position));
    }

    fn choose(&mut self, choice: &PlannerChoice, info: &PlannerInfo) {
        let known = &mut self.known;
        known.sandbox = known.sandbox.take().max(info.sandbox.clone());
        if known.planners.is_empty() {
            known.planner = Some(choice.id.clone());
            known.planner_version = Some(info.version.clone());
        }
        if known.planners.len() < MOST_PLANNERS && !known.planners.contains(&choice.id) {
            known.planners.push(choice.id.clone());
        }
        if known.planner.as_ref() == Some(&choice.id) {
            let mut parameters = defaults(info);
            parameters.extend(choice.parameters.clone());
            known.parameters = Some(parameters);
        }
    }

    fn set_parameters(&mut self, choice: &PlannerChoice) {
        if self.known.planner.as_ref() == Some(&choice.id) {
            let parameters = self.known.parameters.get_or_insert_default();
            parameters.extend(choice.parameters.clone());
        }
    }
}

/// The parameters of a planner if none are set.
fn defaults(info: &PlannerInfo) -> Parameters {
    let default = |kind: &ParamKind| match kind {
        ParamKind::Float { default, .. } => ParamValue::Float(*default),
        ParamKind::Int { default, .. } => ParamValue::Int(*default),
        ParamKind::Flag { default } => ParamValue::Flag(*default),
        ParamKind::Choice { default, .. } => ParamValue::Word(default.clone()),
    };
    info.parameters.iter().map(|parameter| (parameter.key.clone(), default(&parameter.kind))).collect()
}

#[cfg(test)]
mod tests;
