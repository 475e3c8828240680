//! Locates a file of readings.

use crate::{
    clock::{self, Written},
    columns::{Columns, Kind},
    doubts::Doubts,
    found::Found,
    moments::{Moment, Moments},
    problem::Problem,
    pulsing::{Pulsed, Pulsing, series},
    repeats::{Repeats, Scatter},
    rows::Rows,
    tool::{self, Stretches},
};
use flight::{Flight, failure::bad_input};
use mission::{
    Event, EventKind, Locator, MissionConfig, Outcome, PlannerChoice,
    event::{Asked, Measured, ToolTrack},
};
use positioning::{
    Agreement, CommonError, Doubt, Possible, PulseSeries, RangeNoise, SessionConfig, SolverKind, Verdict,
};
use scenario::Scenario;
use std::path::Path;
use world::{CoverageGrid, ObstacleMap, RangeSet, StationId, Tool};

mod calibrating;
mod learning;

/// The number of bad rows that an error lists.
const LISTED: usize = 10;
/// Multiple of the usual interval between motions above which an interval is a gap, in which motions were lost.
const GAP: f64 = 5.0;
/// The number of intervals between motions from which the usual interval is determined.
const INTERVALS: usize = 4_096;

/// Least standard deviation of a pulse, metres: noise-free scenarios have one, too.
const LEAST_SIGMA_M: f64 = 1e-4;

/// Minimum number of contradicting fixes for the motion to be ignored. A wrong start alone makes three fixes contradict
/// the motion.
const CONTRADICTING: u64 = 4;
/// Second condition for the motion to be ignored: at least one in this many fixes contradicts it.
const CONTRADICTING_OF: u64 = 4;

/// A file to locate, with the options.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// The readings.
    pub file: &'a Path,
    /// The name of the file as shown to people.
    pub shown: &'a str,
    /// Stations, tank, start and noise.
    pub scenario: &'a Scenario,
    /// Speed of sound, metres per second; used for files that contain times instead of distances.
    pub sound_speed_m_s: Option<f64>,
    /// Whether to estimate the speed of sound of this session.
    pub finds_sound_speed: bool,
    /// Whether to estimate the offset between the clocks of the robot and the stations.
    pub finds_clock_offset: bool,
    /// Whether to leave out bad rows instead of refusing the file.
    pub skips_bad_rows: bool,
    /// The file that states when the tool was on, if the readings have no column for it.
    pub tool_on: Option<&'a Path>,
}

/// The findings about a whole file before it is located.
#[derive(Debug, Clone)]
pub struct Survey {
    /// The kind of the readings.
    pub kind: Kind,
    /// Whether the motion between the readings was measured and is used.
    pub has_motion: bool,
    /// How well fixes and motion agree; present if they contradict each other so often that the motion is not used.
    pub contradicted: Option<Agreement>,
    /// The number of rows, including bad ones.
    pub rows: u64,
    /// The number of rows left out.
    pub bad: u64,
    /// The first problems found.
    pub problems: Vec<Problem>,
    /// The columns that are not used.
    pub ignored: Vec<String>,
    /// The clock and sound errors found; absent if they were not requested.
    pub calibration: Option<Found>,
    /// The stretches of time in which the tool was on, in seconds after the first moment; absent if neither the
    /// readings nor a file states them.
    pub tool_on_s: Option<Vec<[f64; 2]>>,
    /// The errors of the speed of sound and of the stations according to the residuals, after correction with
    /// `calibration`.
    pub verdict: Verdict,
    /// The scatter of several readings of one station in one emission.
    pub repeats: Repeats,
    /// The calibration of this session; `None` if the scenario asks for none, has too few stations for it, or if all ranges
    /// are wrong by one length, which it does not estimate.
    pub session: Option<SessionConfig>,
    /// The pulse tests of the stations, in chronological order; their corrections are used.
    pub pulses: Vec<Pulsed>,
    /// The first time in the file, as written there, seconds.
    pub first_s: f64,
    /// The first and the last time, with their dates, in UTC; absent if times have no date.
    pub dates: Option<[String; 2]>,
    /// The time between motions, in seconds, beyond which some motions must have been lost.
    gap_s: f64,
}

impl Task<'_> {
    fn open(&self) -> anyhow::Result<(Moments, Columns)> {
        let shown = self.shown;
        let rows = Rows::open(self.file).map_err(|what| bad_input(format!("{shown}: {what}")))?;
        let stations = &self.scenario.sim.world.stations;
        let mut columns = Columns::new(rows.header(), stations, self.sound_speed_m_s)
            .map_err(|what| bad_input(format!("{shown}: {what}")))?;
        columns.has_commas = rows.has_commas();
        Ok((Moments::new(rows, columns.clone(), self.possible()), columns))
    }

    fn noise(&self) -> RangeNoise {
        let normal = RangeNoise::Gaussian { sigma_ratio: self.scenario.mission.range_sigma_ratio };
        self.scenario.mission.locating.noise.unwrap_or(normal)
    }

    /// The bounds of possible ranges before any correction.
    fn possible(&self) -> Possible {
        let world = &self.scenario.sim.world;
        let too_long = if self.finds_sound_speed { learning::MOST_TOO_LONG } else { 0.0 };
        let noise = (&self.noise(), self.scenario.mission.locating.timing);
        Possible::new(&world.boundary, &world.stations, noise, too_long)
    }

    fn scatter(&self, kind: Kind) -> Scatter {
        // Without the emission time, the distance to a station is unknown; the span of the tank is the largest distance
        // possible.
        let (low, high) = self.scenario.sim.world.boundary.bounds();
        let distance_m = (kind == Kind::Differences).then(|| (high - low).amax());
        Scatter { noise: self.noise(), timing: self.scenario.mission.locating.timing, distance_m }
    }

    /// Reads the whole file once to collect its contents and problems, and again to estimate clock and sound errors.
    ///
    /// # Errors
    /// The file cannot be read, or it has bad rows that were not to be left out.
    pub fn survey(&self) -> anyhow::Result<Survey> {
        let (mut moments, columns) = self.open()?;
        let in_file = self.tool_on_in_file()?;
        let mut stretches = Stretches::default();
        self.check_findable(&columns)?;
        let (mut problems, mut bad) = (Vec::new(), 0);
        let (mut first, mut last): (Option<Moment>, Option<Moment>) = (None, None);
        let (mut repeats, scatter) = (Repeats::default(), self.scatter(columns.kind()));
        let mut pulsing = Pulsing::default();
        let (mut intervals_s, mut moved_s): (Vec<f64>, Option<f64>) = (Vec::new(), None);
        for moment in moments.by_ref() {
            match moment {
                Ok(moment) => {
                    repeats.take(&moment, &scatter);
                    pulsing.take(&moment);
                    stretches.take(moment.t_s, moment.tool_on);
                    if moment.odometry.is_some() {
                        let since_s = moved_s.replace(moment.t_s).map(|before_s| moment.t_s - before_s);
                        intervals_s.extend(since_s.filter(|_| intervals_s.len() < INTERVALS));
                    }
                    first.get_or_insert_with(|| moment.clone());
                    last = Some(moment);
                }
                Err(problem) => {
                    bad += 1;
                    if problems.len() < LISTED || problem.is_end {
                        problems.push(problem);
                    }
                }
            }
        }
        problems.sort_by_key(|problem: &Problem| problem.line);
        let is_cut = problems.iter().any(|problem| problem.is_end);
        if bad > 0 && (is_cut || !self.skips_bad_rows) {
            return Err(bad_input(self.listed(&problems, bad)));
        }
        let (first, last) = first.zip(last).ok_or_else(|| bad_input(format!("{}: no rows", self.shown)))?;
        let pulses = self.pulsed(&pulsing)?;
        let pulse_series = series(&pulses);
        let known = (&columns, &repeats, &pulse_series);
        let calibration = self.found(known)?;
        let assumed = match calibration {
            None if self.scenario.mission.locating.calibrate_sound_speed => self.found_under_way(known)?,
            found => found,
        };
        let by_pulses = pulse_series.sigmas().unwrap_or_default();
        let whole = self.judged(known, assumed.as_ref())?.verdict().beside(by_pulses);
        let session = self.session(columns.kind(), &whole);
        let verdict = if session.is_some() { Verdict::default() } else { whole };
        intervals_s.sort_by(f64::total_cmp);
        let tool_on = self.tool_on(in_file, stretches, [first.t_s, last.t_s])?;
        let from_first = |[from_s, to_s]: [f64; 2]| [from_s - first.t_s, to_s - first.t_s];
        let mut survey = Survey {
            kind: columns.kind(),
            has_motion: columns.has_motion() && moved_s.is_some(),
            contradicted: None,
            rows: moments.count,
            bad: bad + moments.left_behind,
            problems,
            ignored: columns.ignored().map(str::to_owned).collect(),
            calibration,
            tool_on_s: tool_on.map(|stretches| stretches.into_iter().map(from_first).collect()),
            verdict,
            repeats,
            session,
            pulses,
            first_s: first.t_s,
            dates: (first.written == Written::Dated).then(|| [first.t_s, last.t_s].map(clock::written)),
            gap_s: intervals_s.get(intervals_s.len() / 2).map_or(f64::INFINITY, |usual_s| GAP * usual_s),
        };
        if survey.has_motion {
            let agreement = self.track(&survey, None, |_| {})?.locator.agreement();
            let Agreement { sound, contradicting } = agreement;
            let is_contradicted = contradicting >= CONTRADICTING && contradicting * CONTRADICTING_OF >= sound;
            survey.contradicted = Some(agreement).filter(|_| is_contradicted);
            survey.has_motion = !is_contradicted;
        }
        self.judge_calibrated(&mut survey)?;
        Ok(survey)
    }

    /// Evaluates the pulse tests of the file.
    fn pulsed(&self, pulsing: &Pulsing) -> anyhow::Result<Vec<Pulsed>> {
        let (noise, timing) = (self.noise(), self.scenario.mission.locating.timing);
        let sigma_m = |distance_m: f64| {
            let share_m = noise.sigma_ratio() * distance_m.abs();
            share_m.hypot(timing.mean_sigma_m(share_m, 1.0)).max(LEAST_SIGMA_M)
        };
        let scatter = self.scatter(Kind::Ranges);
        let tests = pulsing.tests(&self.scenario.sim.world.stations, (sigma_m, &scatter)).map_err(
            |(phase, what)| bad_input(format!("{}: pulses {}: {what}", self.shown, phase.words())),
        )?;
        if !tests.is_empty() && self.finds_sound_speed {
            return Err(bad_input(format!(
                "{}: the pulses of the stations already give the speed of sound; leave out --find sound-speed",
                self.shown
            )));
        }
        Ok(tests)
    }

    /// Iterates over the moments of the file. Readings that are copies of each other are merged into one, and the
    /// corrections by pulse tests are applied.
    fn moments(
        &self,
        repeats: &Repeats,
        pulses: &PulseSeries,
    ) -> anyhow::Result<impl Iterator<Item = Moment> + use<>> {
        let (are_one, pulses) = (repeats.are_narrow(), pulses.clone());
        let counted = move |mut moment: Moment| {
            if are_one {
                moment.ranges.iter_mut().for_each(as_one);
            }
            pulses.correct(moment.t_s, &mut moment.ranges);
            moment
        };
        Ok(self.open()?.0.flatten().map(counted))
    }

    /// Reads the file that states when the tool was on.
    fn tool_on_in_file(&self) -> anyhow::Result<Option<Vec<[f64; 2]>>> {
        let read =
            |file: &Path| tool::read(file).map_err(|what| bad_input(format!("{}, {what}", file.display())));
        self.tool_on.map(read).transpose()
    }

    /// Returns the times when the tool was on, from that file or from the readings, which cover the times in `span`,
    /// seconds.
    fn tool_on(
        &self,
        in_file: Option<Vec<[f64; 2]>>,
        of_readings: Stretches,
        span: [f64; 2],
    ) -> anyhow::Result<Option<Vec<[f64; 2]>>> {
        let of_readings = of_readings.finish();
        let (Some(file), Some(stretches)) = (self.tool_on, in_file) else { return Ok(of_readings) };
        if of_readings.is_some() {
            let (readings, file) = (self.file.display(), file.display());
            return Err(bad_input(format!(
                "{file} and the column tool_on of {readings} both state when the tool was on; remove one of them"
            )));
        }
        match tool::outside(&stretches, span) {
            Some(wrong) => Err(bad_input(format!("{}: {wrong}", file.display()))),
            None => Ok(Some(stretches)),
        }
    }

    fn listed(&self, problems: &[Problem], bad: u64) -> String {
        let file = self.shown;
        let mut lines: Vec<String> = problems.iter().map(|problem| format!("{file}, {problem}")).collect();
        let more = bad - problems.len() as u64;
        lines.extend((more > 0).then(|| format!("and {more} more")));
        let is_cut = problems.iter().any(|problem| problem.is_end);
        lines.push(if is_cut {
            "the rest of the file cannot be read; export the readings again".into()
        } else {
            "correct the rows, or leave them out with --skip-bad-rows".into()
        });
        lines.join("\n")
    }

    /// Locates the readings, and passes the events of each moment to `take`, as a run records them.
    ///
    /// # Errors
    /// The file can no longer be read.
    pub fn locate(&self, survey: &Survey, mut take: impl FnMut(&[Event])) -> anyhow::Result<Doubts> {
        let config = self.config(survey);
        let mut opened = Flight::prepare(self.scenario, false).opened();
        let mut tool = None;
        if let EventKind::RunOpened(run) = &mut opened.kind {
            run.mission = config.clone();
            let measured = Measured {
                file: self.shown.to_owned(),
                sha256: recording::sha256(self.file)?,
                asked: Asked {
                    sound_speed_m_per_s: self.sound_speed_m_s,
                    finds_sound_speed: self.finds_sound_speed,
                    finds_clock_offset: self.finds_clock_offset,
                    skips_bad_rows: self.skips_bad_rows,
                },
                has_motion: survey.has_motion,
                tool_on_s: survey.tool_on_s.clone(),
            };
            let passes = || (ToolTrack::new(&measured, &config), CoverageGrid::new(run.floor.clone()));
            tool = survey.tool_on_s.is_some().then(passes);
            run.measured = Some(measured);
        }
        take(&[opened]);
        let swept = tool.map(|(track, grid)| Swept { tool: config.tool(), track, grid });
        let track = self.track(survey, swept, &mut take)?;
        let reason = format!("end of {}", self.shown);
        // The last pulse test may come after the last position.
        let last_s = survey.pulses.last().map_or(track.t_s, |pulsed| pulsed.t_s - survey.first_s);
        let kind = EventKind::Ended { outcome: Outcome::Complete, reason };
        take(&[Event { tick: track.tick, t_s: track.t_s.max(last_s), kind }.rounded()]);
        Ok(track.doubts)
    }

    /// Computes the track and the swept floor, and passes the events of each moment to `take`.
    fn track(
        &self,
        survey: &Survey,
        swept: Option<Swept>,
        mut take: impl FnMut(&[Event]),
    ) -> anyhow::Result<Track> {
        let config = self.config(survey);
        let drawing = self.scenario.sim.world.as_drawn();
        let mut track = Track {
            locator: Locator::new(&config, &drawing),
            map: ObstacleMap::new(&drawing.boundary, &drawing.obstacles),
            most_m_per_s: config.limits.v_max_m_per_s,
            most_rad_per_s: config.limits.w_max_rad_per_s,
            gap_s: survey.gap_s,
            has_motion: survey.has_motion,
            has_moved: false,
            doubts: Doubts::default(),
            radius_m: config.limits.radius_m,
            swept,
            tick: 0,
            t_s: 0.0,
        };
        let scatter = self.scatter(survey.kind);
        let scale = survey.verdict.scale;
        let ratio = scale.filter(|scale| scale.is_proven).map_or(0.0, |scale| scale.value.abs());
        let is_emission_free = survey.kind == Kind::Differences;
        let pulses = series(&survey.pulses);
        let (pulse_share, pulse_m) = pulses.sigmas().unwrap_or_default();
        let likely_errors = match survey.verdict.likely_errors(is_emission_free) {
            [CommonError::Share(share), length] => [CommonError::Share(share.hypot(pulse_share)), length],
            errors => errors,
        };
        let mut tests = survey.pulses.iter().peekable();
        for mut moment in self.moments(&survey.repeats, &pulses)? {
            while let Some(pulsed) = tests.next_if(|pulsed| pulsed.t_s <= moment.t_s) {
                take(&[track.pulses_tested(pulsed, survey.first_s)]);
            }
            if moment.is_test() {
                continue;
            }
            moment.t_s -= survey.first_s;
            if let Some(calibration) = &survey.calibration {
                calibration.correct(&mut moment.ranges);
            }
            let repeats = survey.repeats.doubt_m(&moment, &scatter);
            let is_suspect = repeats.is_some() || survey.verdict.is_wrong();
            let offset = survey.verdict.offset_m.filter(|offset| offset.is_proven);
            let sigma_m = repeats.unwrap_or_default().hypot(offset.map_or(0.0, |offset| offset.value));
            let likely_m = survey.repeats.likely_m(&moment, &scatter).hypot(pulse_m);
            track.locator.doubt(Doubt { ratio, likely_errors, sigma_m, likely_m, is_suspect });
            take(&track.events(&moment));
        }
        Ok(track)
    }

    /// Returns the configuration of the mission, reduced to what locating needs.
    fn config(&self, survey: &Survey) -> MissionConfig {
        let mut config = self.scenario.mission.clone();
        config.planner =
            PlannerChoice { id: "none".into(), parameters: std::collections::BTreeMap::default() };
        config.fallback = None;
        if survey.kind == Kind::Differences {
            config.locating.solver = SolverKind::Differences;
        } else if config.locating.solver == SolverKind::Differences {
            // The readings state distances, whatever the scenario expects of a mission.
            config.locating.solver = SolverKind::default();
        }
        // Readings whose stations have clocks of their own are refused (see `check_findable`).
        config.locating.clocks = None;
        if survey.kind == Kind::Differences || survey.calibration.is_some() {
            config.locating.calibrate_sound_speed = false;
        }
        config.locating.session = survey.session;
        if let Some(found) = &survey.calibration {
            config.locating.scale_sigma_ratio = found.scale().1;
        }
        config
    }
}

/// Merges the readings of each station in an emission into their mean.
fn as_one(set: &mut RangeSet) {
    let mean_m = set.ranges_m.iter().sum::<f64>() / set.ranges_m.len().max(1) as f64;
    set.ranges_m = vec![mean_m];
}

/// The position of the robot, moment by moment.
struct Track {
    locator: Locator,
    map: ObstacleMap,
    most_m_per_s: f64,
    most_rad_per_s: f64,
    gap_s: f64,
    /// Whether measured motion is used.
    has_motion: bool,
    /// Whether any motion has been measured so far.
    has_moved: bool,
    doubts: Doubts,
    radius_m: f64,
    swept: Option<Swept>,
    tick: u64,
    t_s: f64,
}

/// The floor that the tool passed over while it was on.
struct Swept {
    tool: Tool,
    track: ToolTrack,
    grid: CoverageGrid,
}

impl Swept {
    /// Adds the floor that the tool swept up to an estimated pose. Returns the part that was not swept before.
    fn visit(&mut self, Event { t_s, kind, .. }: &Event) -> Option<EventKind> {
        let EventKind::Estimated { pose } = kind else { return None };
        let (from, to) = self.track.visit(*t_s, pose)?;
        let runs = self.grid.not_covered_under(self.tool, from, to);
        self.grid.apply(&runs);
        (!runs.is_empty()).then_some(EventKind::Covered { runs })
    }
}

impl Track {
    fn event(&self, kind: EventKind) -> Event {
        Event { tick: self.tick, t_s: self.t_s, kind }.rounded()
    }

    /// The event about a pulse test.
    fn pulses_tested(&self, pulsed: &Pulsed, first_s: f64) -> Event {
        let kind = EventKind::PulsesTested { phase: pulsed.phase, test: pulsed.test.clone() };
        Event { tick: self.tick, t_s: pulsed.t_s - first_s, kind }.rounded()
    }

    fn events(&mut self, moment: &Moment) -> Vec<Event> {
        let waited_s = moment.t_s - self.t_s;
        self.t_s = moment.t_s;
        let odometry = moment.odometry.filter(|_| self.has_motion);
        let is_measured = odometry.is_some() && (!self.has_moved || waited_s <= self.gap_s);
        if !is_measured && waited_s > 0.0 {
            self.locator.wander(self.most_m_per_s * waited_s, self.most_rad_per_s * waited_s);
        }
        self.has_moved |= odometry.is_some();
        let truth = moment.truth.map(|pose| EventKind::Truth {
            pose,
            clearance_m: self.map.clearance_m(pose.position) - self.radius_m,
            collided: false,
        });
        let readings = world::Readings {
            ranging_cycle: !moment.ranges.is_empty(),
            ranges: moment.ranges.clone(),
            odometry: odometry.unwrap_or_default(),
            ..world::Readings::default()
        };
        let located = self.locator.take(&readings, self.t_s);
        if readings.ranging_cycle {
            let heard: Vec<StationId> = readings.ranges.iter().map(|set| set.station).collect();
            self.doubts.take(self.t_s, self.locator.sides(), &heard, self.locator.impossible());
        }
        let mut events: Vec<Event> = truth.into_iter().chain(located).map(|kind| self.event(kind)).collect();
        if let Some(swept) = &mut self.swept {
            let covered: Vec<EventKind> = events.iter().filter_map(|event| swept.visit(event)).collect();
            events.extend(covered.into_iter().map(|kind| self.event(kind)));
        }
        self.tick += 1;
        events
    }
}
