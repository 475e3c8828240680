//! A survey: the mission itself drives from frontier to frontier and makes a map, then drives back.
//!
//! The next goal is the frontier with the cheapest way over floor that is known to be free. When no frontier is left that
//! the hull can reach within the limits of the tether, the robot looks at the hidden sides of objects, then drives back.

mod choice;
mod ground;
mod leg;

use super::{Mission, happened::Happened, known::Known};
use crate::{
    config::MissionConfig,
    event::{EventKind, Explored, SurveyGoal},
    phase::Phase,
    task::Survey as SurveyTask,
};
use choice::Choice;
use exploration::{CellState, Exploration, Scanning};
use ground::Ground;
use leg::Leg;
use planner_api::{Command, Drive};
use std::f64::consts::TAU;
use world::{Point, Readings, World, coverage::percent_text};

/// Time between two reports of what has been explored, seconds.
const TELL_S: f64 = 5.0;
/// Number of scans before the first way: lost rays hide floor in a single one.
const SETTLED: u32 = 5;
/// Turn rate at which the robot looks for floor on which a way can begin, radians per second, and the angle after which
/// it has seen everything around it.
const SEARCH_RAD_PER_S: f64 = 0.5;
const SEARCHED_RAD: f64 = 1.1 * TAU;
/// Largest number of frontiers in a report.
const MOST_TOLD: usize = 40;

/// The state of a survey.
#[derive(Clone)]
pub(super) struct Surveying {
    exploration: Exploration,
    /// The objects among which the cable lies.
    ground: Ground,
    leg: Option<Leg>,
    choice: Choice,
    /// Number of scans that have been used, up to [`SETTLED`].
    scans: u32,
    told_s: Option<f64>,
    /// The states of the cells in the last report.
    told: Vec<CellState>,
    /// Angle by which the robot has turned on the spot in order to see floor on which a way can begin, radians; `None` if
    /// a way can begin at its place.
    searched_rad: Option<f64>,
}

impl Surveying {
    /// The state before the first scan; `None` unless the task is a survey.
    pub(super) fn new(config: &MissionConfig, drawing: &World) -> Option<Self> {
        let sensor = config.sensor.filter(|_| config.task.is_survey())?;
        let scanning =
            Scanning { sigma_m: sensor.sigma_m, range_m: sensor.range_m, hull_m: config.limits.radius_m };
        let exploration = Exploration::new(&drawing.boundary, scanning);
        Some(Self {
            told: vec![CellState::Unseen; exploration.grid().len()],
            exploration,
            ground: Ground::new(drawing.clone()),
            leg: None,
            choice: Choice::default(),
            scans: 0,
            told_s: None,
            searched_rad: None,
        })
    }

    /// Remaining length of the way that the robot takes, metres, if there is one.
    pub(super) fn left_m(&self, here: Point) -> Option<f64> {
        self.leg.as_ref().map(|leg| leg.left_m(here))
    }

    /// Forgets the way that the robot takes: after a hold, it chooses again.
    pub(super) fn leave_way(&mut self) {
        self.leg = None;
    }

    /// Gives up the way that the robot takes, and its goal.
    pub(super) fn give_up(&mut self) {
        if let Some(leg) = self.leg.take() {
            self.choice.give_up(&leg);
        }
    }

    /// The objects among which the cable lies.
    pub(super) fn ground(&self) -> &Ground {
        &self.ground
    }
}

impl Known {
    /// Adds the scan of this tick to the map, and reports from time to time what has been explored.
    pub(super) fn explore(&mut self, readings: &Readings, happened: &mut Happened) {
        let (now_s, pose, is_lost) = (self.now_s(), self.locator.pose(), self.locator.is_lost());
        let (Some(survey), Some(perception)) = (&mut self.survey, &self.perception) else { return };
        if let Some(scan) = readings.scan.as_ref().filter(|_| perception.agrees() && !is_lost) {
            let is_used = survey.exploration.add(scan, &perception.corrected(&pose), now_s);
            survey.scans = (survey.scans + u32::from(is_used)).min(SETTLED);
        }
        let is_due = survey.told_s.is_none_or(|told_s| now_s - told_s >= TELL_S);
        if !is_due || survey.scans == 0 || !matches!(self.phase, Phase::Running(_) | Phase::Held(_)) {
            return;
        }
        survey.told_s = Some(now_s);
        let share = survey.exploration.share();
        let columns = survey.exploration.columns();
        let frontiers = survey.choice.frontiers().iter().copied().take(MOST_TOLD).collect();
        self.task.survey().into_iter().for_each(|task| task.explored = share);
        let states = survey.exploration.states(&columns);
        let cells = exploration::changes(&survey.told, &states);
        survey.told = states;
        happened.push(EventKind::Explored(Explored { share, frontiers, columns, cells }));
    }

    /// Why a survey counts as done, as a sentence.
    pub(super) fn mapped_reason(&self, task: &SurveyTask) -> String {
        let place = if self.config.tether.is_some() { "anchor" } else { "start" };
        let explored = self.survey.as_ref().map_or(task.explored, |survey| survey.exploration.share());
        let share = percent_text(explored, 1);
        let beyond = self.survey.as_ref().map_or(0, |survey| survey.choice.beyond());
        let left_out = match beyond {
            0 => String::new(),
            1 => "; 1 place not seen, beyond the tether".into(),
            n => format!("; {n} places not seen, beyond the tether"),
        };
        format!("back at the {place}, {share} % of the floor seen{left_out}")
    }

    /// Notes whether the map shows no floor with room for the hull at the robot's place.
    fn mark_shut_in(&mut self, is_shut_in: bool) {
        if let Some(survey) = &mut self.survey {
            survey.searched_rad = is_shut_in.then(|| survey.searched_rad.unwrap_or(0.0));
        }
        if let Some(task) = self.task.survey() {
            task.is_shut_in = is_shut_in;
        }
    }

    /// The command of a robot whose scanner does not show floor on which a way can begin: it turns on the spot, once
    /// around, because a scanner with a narrow field of view has to be pointed everywhere.
    fn look_around(&mut self) -> Option<Command> {
        let rate_rad_per_s = SEARCH_RAD_PER_S.min(self.config.limits.w_max_rad_per_s);
        let searched_rad = self.survey.as_mut()?.searched_rad.as_mut().filter(|rad| **rad < SEARCHED_RAD)?;
        *searched_rad += rate_rad_per_s * self.config.tick_s;
        Some(self.sending().as_sent(Command::twist(0.0, rate_rad_per_s)))
    }

    /// The robot's place on the map. Scans show where the robot is on the map more exactly than its position estimate; the
    /// way is followed there, so that the clearance is that on the map.
    pub(super) fn place_on_map(&self) -> Point {
        let pose = self.locator.pose();
        self.perception.as_ref().map_or(pose.position, |perception| perception.corrected(&pose).position)
    }

    /// The objects among which the cable lies: the chart or, in a survey, the chart together with the map.
    pub(super) fn cable_world(&self) -> &World {
        self.survey.as_ref().map_or_else(|| self.chart.world(), |survey| survey.ground().world())
    }
}

impl Mission {
    /// The drive of a survey for this tick.
    pub(super) fn drive_survey(&mut self) -> Drive {
        if !self.known.knows_medium() || !self.known.may_choose_way() {
            return Drive::STILL;
        }
        self.choose_way();
        let wanted = self.known.command_of_survey().or_else(|| self.known.look_around());
        let Some(wanted) = wanted else { return Drive::STILL };
        let (sent, limits) = self.known.made_safe(wanted);
        let asked = (sent != wanted).then_some(wanted);
        self.happened.push(EventKind::Commanded { ask: None, command: sent, asked });
        self.happened.extend(limits.into_iter().flatten());
        sent.drive
    }

    /// Reports the map of a survey that ends.
    pub(super) fn report_map(&mut self) {
        if let Some(survey) = self.known.survey.as_ref().filter(|survey| survey.scans > 0) {
            let map = Box::new(survey.exploration.map());
            self.happened.push(EventKind::Mapped { map });
        }
    }

    /// Drops a way that has ended or is blocked, and takes the next one.
    fn choose_way(&mut self) {
        let Some(chosen) = self.known.next_way() else { return };
        self.rules.stuck.restart();
        self.known.mark_shut_in(false);
        if let Some(task) = self.known.task.survey() {
            (task.target, task.is_over) = (chosen.leg.goal, chosen.event.to == SurveyGoal::Home);
        }
        self.happened.push(EventKind::SurveyWay(chosen.event));
        if let Some(survey) = &mut self.known.survey {
            survey.leg = Some(chosen.leg);
        }
    }
}
