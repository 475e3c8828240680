//! A file of readings, located.

use crate::{
    columns::{Columns, Kind},
    moments::{Moment, Moments},
    problem::Problem,
    rows::Rows,
    tool::{self, Stretches},
};
use flight::{Flight, failure::bad_input};
use mission::{
    Event, EventKind, Locator, MissionConfig, Outcome, PlannerChoice,
    event::{Asked, Measured, ToolTrack},
};
use positioning::{Calibration, RangeNoise, Ranging, SolverKind, Unknowns};
use scenario::Scenario;
use std::path::Path;
use world::{CoverageGrid, ObstacleMap, RangeSet, Tool};

/// Bad rows that an error lists.
const LISTED: usize = 10;
/// Times that a session is taken at most to find out about clocks and sound,
const ROUNDS: usize = 10;
/// or until that changes by less than this share of its standard deviation.
const SETTLED: f64 = 0.1;
/// Offsets of clocks up to some of these are looked for, metres.
const OFFSET_SIGMA_M: f64 = 20.0;
/// Errors of the speed of sound up to some of these are looked for, as a share.
const SOUND_SIGMA_RATIO: f64 = 0.05;

/// What is to be located, and how.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// The readings.
    pub file: &'a Path,
    /// Stations, tank, start and noise.
    pub scenario: &'a Scenario,
    /// Metres per second; for times.
    pub sound_speed_m_s: Option<f64>,
    /// Whether the session's own speed of sound is found out.
    pub finds_sound_speed: bool,
    /// Whether the offset between the clocks of robot and stations is found out.
    pub finds_clock_offset: bool,
    /// Whether bad rows are left out instead of refused.
    pub skips_bad_rows: bool,
    /// The file that says when the tool was on, if the readings have no column for it.
    pub tool_on: Option<&'a Path>,
}

/// What a look over the whole file found, before anything is located.
#[derive(Debug, Clone)]
pub struct Survey {
    /// What the readings are.
    pub kind: Kind,
    /// Whether the motion between them was measured.
    pub has_motion: bool,
    /// Rows, bad ones among them.
    pub rows: u64,
    /// Rows that are left out.
    pub bad: u64,
    /// Some of them.
    pub problems: Vec<Problem>,
    /// Columns that say nothing here.
    pub ignored: Vec<String>,
    /// What was found out about clocks and sound; absent if it was not asked for.
    pub calibration: Option<Calibration>,
    /// From when to when the tool was on, seconds after the first moment; absent if nothing says it.
    pub tool_on_s: Option<Vec<[f64; 2]>>,
    first_s: f64,
}

impl Task<'_> {
    fn open(&self) -> anyhow::Result<(Moments, Columns)> {
        let shown = self.file.display();
        let rows = Rows::open(self.file).map_err(|what| bad_input(format!("{shown}: {what}")))?;
        let stations = &self.scenario.sim.world.stations;
        let mut columns = Columns::new(rows.header(), stations, self.sound_speed_m_s)
            .map_err(|what| bad_input(format!("{shown}: {what}")))?;
        columns.has_commas = rows.has_commas();
        Ok((Moments::new(rows, columns.clone()), columns))
    }

    /// Reads the whole file once: what it holds, what is wrong with it, and what it says about clocks and sound.
    ///
    /// # Errors
    /// It cannot be read, or has bad rows and those are not to be left out.
    pub fn survey(&self) -> anyhow::Result<Survey> {
        let (mut moments, columns) = self.open()?;
        let calibration = self.calibration(&columns)?;
        let tool_on = self.tool_on(&columns)?;
        let mut stretches = Stretches::default();
        let (mut problems, mut bad, mut first_s) = (Vec::new(), 0, None);
        for moment in moments.by_ref() {
            match moment {
                Ok(moment) => {
                    first_s.get_or_insert(moment.t_s);
                    stretches.take(moment.t_s, moment.tool_on);
                }
                Err(problem) => {
                    bad += 1;
                    if problems.len() < LISTED || problem.is_end {
                        problems.push(problem);
                    }
                }
            }
        }
        let is_cut = problems.iter().any(|problem| problem.is_end);
        if bad > 0 && (is_cut || !self.skips_bad_rows) {
            return Err(bad_input(self.listed(&problems, bad)));
        }
        let first_s = first_s.ok_or_else(|| bad_input(format!("{}: no rows", self.file.display())))?;
        let calibration = calibration.map(|calibration| self.calibrated(calibration)).transpose()?;
        let tool_on = tool_on.or_else(|| columns.has_tool().then(|| stretches.finish()));
        let from_first = |[from_s, to_s]: [f64; 2]| [from_s - first_s, to_s - first_s];
        Ok(Survey {
            kind: columns.kind(),
            has_motion: columns.has_motion(),
            rows: moments.count,
            bad,
            problems,
            ignored: columns.ignored().map(str::to_owned).collect(),
            calibration,
            tool_on_s: tool_on.map(|stretches| stretches.into_iter().map(from_first).collect()),
            first_s,
        })
    }

    /// The stretches of the file that says when the tool was on.
    fn tool_on(&self, columns: &Columns) -> anyhow::Result<Option<Vec<[f64; 2]>>> {
        let Some(file) = self.tool_on else { return Ok(None) };
        if columns.has_tool() {
            let (readings, file) = (self.file.display(), file.display());
            return Err(bad_input(format!(
                "{readings} has a column tool_on, and {file} says it as well; keep one of the two"
            )));
        }
        let stretches = tool::read(file).map_err(|what| bad_input(format!("{}, {what}", file.display())))?;
        Ok(Some(stretches))
    }

    fn listed(&self, problems: &[Problem], bad: u64) -> String {
        let file = self.file.display();
        let mut lines: Vec<String> = problems.iter().map(|problem| format!("{file}, {problem}")).collect();
        let more = bad - problems.len() as u64;
        lines.extend((more > 0).then(|| format!("and {more} more")));
        let is_cut = problems.iter().any(|problem| problem.is_end);
        lines.push(if is_cut {
            "what follows cannot be read; export the readings again".into()
        } else {
            "correct the rows, or leave them out with --skip-bad-rows".into()
        });
        lines.join("\n")
    }

    fn calibration(&self, columns: &Columns) -> anyhow::Result<Option<Calibration>> {
        if !self.finds_clock_offset && !self.finds_sound_speed {
            return Ok(None);
        }
        if columns.kind() == Kind::Differences {
            return Err(bad_input(format!(
                "{}: without the time of emission there is neither a clock offset nor a speed of sound to be found; add a \
                 column emitted_s",
                self.file.display()
            )));
        }
        let unknowns = Unknowns {
            sound_sigma_ratio: if self.finds_sound_speed { SOUND_SIGMA_RATIO } else { 0.0 },
            survey_sigma_m: 0.0,
            offset_sigma_m: if self.finds_clock_offset { OFFSET_SIGMA_M } else { 0.0 },
        };
        Ok(Some(Calibration::new(&self.scenario.sim.world.stations, unknowns)))
    }

    /// What the session says of clocks and sound, taken again until it no longer changes.
    fn calibrated(&self, mut calibration: Calibration) -> anyhow::Result<Calibration> {
        for _ in 0..ROUNDS {
            let before = (calibration.scale().0, calibration.offset_m().0);
            calibration = calibration.again();
            for moment in self.open()?.0.flatten() {
                self.learn(&mut calibration, &moment);
            }
            let ((scale, scale_sigma), (offset_m, offset_sigma_m)) =
                (calibration.scale(), calibration.offset_m());
            let is_settled = (scale - before.0).abs() <= SETTLED * scale_sigma
                && (offset_m - before.1).abs() <= SETTLED * offset_sigma_m;
            if is_settled {
                break;
            }
        }
        Ok(calibration)
    }

    fn learn(&self, calibration: &mut Calibration, moment: &Moment) {
        let locating = &self.scenario.mission.locating;
        let normal = RangeNoise::Gaussian { sigma_ratio: self.scenario.mission.range_sigma_ratio };
        let noise = locating.noise.unwrap_or(normal);
        if let Ok(rangings) = locating.aggregation.aggregate(&moment.ranges, &noise) {
            // A cycle without a position contributes nothing; its fix states why there is none.
            let _ = calibration.take(&rangings, None);
        }
    }

    /// Locates; gives the events of each moment, as a run has them.
    ///
    /// # Errors
    /// The file cannot be read any more.
    pub fn locate(&self, survey: &Survey, mut take: impl FnMut(&[Event])) -> anyhow::Result<()> {
        let (moments, _) = self.open()?;
        let config = self.config(survey);
        let mut opened = Flight::prepare(self.scenario, false).opened();
        let mut tool = None;
        if let EventKind::RunOpened(run) = &mut opened.kind {
            run.mission = config.clone();
            let measured = Measured {
                file: self.file.display().to_string(),
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
        let drawing = self.scenario.sim.world.as_drawn();
        let mut track = Track {
            locator: Locator::new(&config, &drawing),
            map: ObstacleMap::new(&drawing.boundary, &drawing.obstacles),
            // Two standard deviations are as far as it can have come.
            wander_m_per_s: if survey.has_motion { 0.0 } else { config.limits.v_max_m_per_s / 2.0 },
            radius_m: config.limits.radius_m,
            swept: tool.map(|(track, grid)| Swept { tool: config.tool(), track, grid }),
            tick: 0,
            t_s: 0.0,
        };
        take(&[opened]);
        for mut moment in moments.flatten() {
            moment.t_s -= survey.first_s;
            if let Some(calibration) = &survey.calibration {
                correct(calibration, &mut moment.ranges);
            }
            take(&track.events(&moment));
        }
        let reason = format!("end of {}", self.file.display());
        take(&[track.event(EventKind::Ended { outcome: Outcome::Complete, reason })]);
        Ok(())
    }

    /// The mission as far as locating goes.
    fn config(&self, survey: &Survey) -> MissionConfig {
        let mut config = self.scenario.mission.clone();
        config.planner =
            PlannerChoice { id: "none".into(), parameters: std::collections::BTreeMap::default() };
        config.fallback = None;
        if survey.kind == Kind::Differences {
            config.locating.solver = SolverKind::Differences;
        }
        if survey.kind == Kind::Differences || survey.calibration.is_some() {
            config.locating.calibrate_sound_speed = false;
        }
        config
    }
}

/// Takes out what is common to all ranges.
fn correct(calibration: &Calibration, sets: &mut [RangeSet]) {
    for set in sets {
        let singles: Vec<Ranging> =
            set.ranges_m.iter().map(|range_m| Ranging::single(set.station, *range_m, 1.0)).collect();
        set.ranges_m = calibration.corrected(&singles).iter().map(|ranging| ranging.range_m).collect();
        set.ranges_m.retain(|range_m| *range_m > 0.0);
    }
}

struct Track {
    locator: Locator,
    map: ObstacleMap,
    wander_m_per_s: f64,
    radius_m: f64,
    swept: Option<Swept>,
    tick: u64,
    t_s: f64,
}

/// The floor that the tool passed while it was on.
struct Swept {
    tool: Tool,
    track: ToolTrack,
    grid: CoverageGrid,
}

impl Swept {
    /// What an estimate adds to it.
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

    fn events(&mut self, moment: &Moment) -> Vec<Event> {
        let waited_s = moment.t_s - self.t_s;
        self.t_s = moment.t_s;
        if self.wander_m_per_s > 0.0 {
            self.locator.wander(self.wander_m_per_s * waited_s);
        }
        let truth = moment.truth.map(|pose| EventKind::Truth {
            pose,
            clearance_m: self.map.clearance_m(pose.position) - self.radius_m,
            collided: false,
        });
        let readings = world::Readings {
            ranging_cycle: !moment.ranges.is_empty(),
            ranges: moment.ranges.clone(),
            odometry: moment.odometry,
            ..world::Readings::default()
        };
        let located = self.locator.take(&readings);
        let mut events: Vec<Event> = truth.into_iter().chain(located).map(|kind| self.event(kind)).collect();
        if let Some(swept) = &mut self.swept {
            let covered: Vec<EventKind> = events.iter().filter_map(|event| swept.visit(event)).collect();
            events.extend(covered.into_iter().map(|kind| self.event(kind)));
        }
        self.tick += 1;
        events
    }
}
