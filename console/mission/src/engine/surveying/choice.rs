//! The choice of the next way.

use super::{super::known::Known, SETTLED, Surveying, ground::Ground, leg::Leg};
use crate::event::{SurveyGoal, SurveyWay};
use exploration::Ways;
use world::{Point, Shape, ZoneKind, polyline};

/// Time between two checks of a way, seconds.
const CHECK_S: f64 = 3.0;
/// Distance between two goals that count as the same, metres.
const SAME_M: f64 = 0.3;
/// Number of arrivals at a goal after which it is left out: what can be seen from there has been seen.
const MOST_TIMES: usize = 2;
/// Time after which a goal that the tether does not reach is tried again, seconds: more of the floor is known by then.
const AGAIN_S: f64 = 60.0;
/// Distance between places on the return path from which other ways to a goal are tried, metres.
const STEP_M: f64 = 1.0;
/// Remaining length of the way back, metres, below which goals that the tether did not reach are tried once more: almost
/// all of the tether is reeled in by then.
const LAST_M: f64 = 1.0;

/// What is left to choose from.
#[derive(Clone, Default)]
pub(super) struct Choice {
    /// Goals that the robot has reached, or could not reach; once for each time.
    tried: Vec<Point>,
    /// Number of times that the robot has driven back in vain.
    times_back: usize,
    /// Goals beyond the tether, each with the mission time from which it is tried again.
    beyond: Vec<(Point, f64)>,
    /// The goals before the frontiers that were left at the last check, the nearest first.
    frontiers: Vec<Point>,
    checked_s: Option<f64>,
    n_beyond: usize,
}

/// A way, with the event that reports it.
pub(super) struct Chosen {
    pub leg: Leg,
    pub event: SurveyWay,
}

impl Choice {
    /// The goals before the frontiers that were left at the last check.
    pub(super) fn frontiers(&self) -> &[Point] {
        &self.frontiers
    }

    /// Leaves the goal of a way out from now on.
    pub(super) fn give_up(&mut self, leg: &Leg) {
        (0..MOST_TIMES).for_each(|_| self.note_end(leg));
    }

    /// Notes that a way has ended. The end of the survey counts by itself: frontiers may lie near it.
    fn note_end(&mut self, leg: &Leg) {
        match leg.to {
            SurveyGoal::Home => self.times_back += 1,
            SurveyGoal::Frontier | SurveyGoal::View => self.tried.push(leg.goal),
        }
    }

    /// Number of goals that the tether did not reach when the robot began to drive back.
    pub(super) fn beyond(&self) -> usize {
        self.n_beyond
    }

    fn is_tried(&self, goal: Point) -> bool {
        self.tried.iter().filter(|tried| is_same(**tried, goal)).count() >= MOST_TIMES
    }

    fn is_beyond(&self, goal: Point, now_s: f64) -> bool {
        self.beyond.iter().any(|(beyond, until_s)| is_same(*beyond, goal) && now_s < *until_s)
    }
}

impl Surveying {
    /// The goals in the order in which they are tried: open frontiers, then the hidden sides of objects.
    fn goals(&self, open: &[Point], ways: &Ways<'_>) -> Vec<(SurveyGoal, Point)> {
        let frontiers = open.iter().map(|goal| (SurveyGoal::Frontier, *goal));
        let views = self.exploration.views(ways).into_iter().map(|view| (SurveyGoal::View, view.at));
        frontiers.chain(views.filter(|(_, goal)| !self.choice.is_tried(*goal))).collect()
    }
}

impl Known {
    /// Whether the map shows the floor around the robot, so that a way can be chosen.
    pub(super) fn may_choose_way(&self) -> bool {
        self.survey.as_ref().is_some_and(|survey| survey.scans >= SETTLED) && !self.locator.is_lost()
    }

    /// The next way, if the current one has ended, leads to nothing new, or is blocked.
    ///
    /// Cost: a search over the whole map, once every few seconds and at the end of each way.
    pub(super) fn next_way(&mut self) -> Option<Chosen> {
        let (now_s, here) = (self.now_s(), self.place_on_map());
        let survey = self.survey.as_mut()?;
        let is_done = survey.leg.as_ref().is_some_and(|leg| leg.is_done(here, now_s));
        if is_done && let Some(leg) = survey.leg.take() {
            survey.choice.note_end(&leg);
        }
        let is_due = survey.choice.checked_s.is_none_or(|checked_s| now_s - checked_s >= CHECK_S);
        if !is_done && !is_due {
            return None;
        }
        survey.choice.checked_s = Some(now_s);
        self.refresh_ground();
        let solids = self.solids();
        let survey = self.survey.as_ref()?;
        let ways = survey.exploration.ways(here, self.guarded_room_m(), solids.iter());
        // Without room at the robot's place, the map is not complete enough to choose a way.
        let is_shut_in = ways.is_empty();
        if is_shut_in {
            self.mark_shut_in(survey.leg.is_none());
            return None;
        }
        let open = ways.frontiers(|goal| !survey.choice.is_tried(goal));
        let open: Vec<Point> = open.into_iter().map(|frontier| frontier.at).collect();
        let leg = survey.leg.as_ref();
        let stays = leg.is_some_and(|leg| self.is_worth_going_on(leg, &open, &ways));
        let chosen = match leg.filter(|_| stays) {
            Some(leg) if leg.to == SurveyGoal::Home => self.chosen_on_way_home(leg, &open, &ways, &solids),
            Some(_) => None,
            None => self.chosen(&open, &ways, &solids),
        };
        let given_up = leg.filter(|leg| leg.to != SurveyGoal::Home).map(|leg| leg.goal);
        let beyond = chosen.as_ref().map_or_else(Vec::new, |(_, beyond)| beyond.clone());
        let choice = &mut self.survey.as_mut()?.choice;
        if let Some((chosen, _)) = &chosen {
            choice.n_beyond = chosen.event.beyond_tether;
            // Counts as tried, so that the robot does not turn back to the same goal again and again.
            choice.tried.extend(given_up.filter(|_| chosen.event.to == SurveyGoal::Home));
        }
        choice.frontiers = open;
        choice.beyond.retain(|(_, until_s)| now_s < *until_s);
        choice.beyond.extend(beyond.into_iter().map(|goal| (goal, now_s + AGAIN_S)));
        if chosen.is_none() {
            self.mark_shut_in(!stays);
        }
        chosen.map(|(chosen, _)| chosen)
    }

    /// Whether a way is still clear and leads to something that is worth a look.
    fn is_worth_going_on(&self, leg: &Leg, open: &[Point], ways: &Ways<'_>) -> bool {
        let is_open = leg.to != SurveyGoal::Frontier || open.iter().any(|goal| is_same(*goal, leg.goal));
        is_open && self.is_passable(leg.remaining(), ways, 0.0)
    }

    /// Whether the hull fits everywhere along a way, with a share of the clearance, according to the map.
    fn is_passable(&self, way: &[Point], ways: &Ways<'_>, share: f64) -> bool {
        let hull_m = self.config.limits.radius_m + share * self.config.clearance_m;
        let places = polyline::resampled(way, 0.5 * ways.grid().cell_m);
        // The hull may stand where it has less room, and the end may be close to the wall.
        let (here, end) = (self.place_on_map(), way.last().copied());
        let is_at_end =
            |at: Point| [Some(here), end].into_iter().flatten().any(|end| (at - end).norm() < 2.0 * hull_m);
        places.iter().all(|at| is_at_end(*at) || ways.spare_at_m(*at) >= hull_m)
    }

    /// The way to a goal that could not be reached from the place where the robot began to drive back, with the goals that
    /// the tether still does not reach. Goals are tried directly and, near the end of the way back, in every way.
    fn chosen_on_way_home(
        &self,
        leg: &Leg,
        open: &[Point],
        ways: &Ways<'_>,
        solids: &[Shape],
    ) -> Option<(Chosen, Vec<Point>)> {
        if leg.left_m(self.place_on_map()) <= LAST_M {
            return self.chosen(open, ways, solids).filter(|(chosen, _)| chosen.event.to != SurveyGoal::Home);
        }
        let direct = self.survey.as_ref()?.goals(open, ways).into_iter().find_map(|(to, goal)| {
            let way = ways.to(goal)?;
            let bears = self.tether.as_ref().is_none_or(|tether| tether.bears_with_reserve(&way));
            bears.then(|| chosen((to, goal), way, 0, self.now_s()))
        });
        direct.map(|chosen| (chosen, Vec::new()))
    }

    /// The way to the first goal that the tether reaches, or else the way back; with the goals that it does not reach.
    fn chosen(&self, open: &[Point], ways: &Ways<'_>, solids: &[Shape]) -> Option<(Chosen, Vec<Point>)> {
        let survey = self.survey.as_ref()?;
        let now_s = self.now_s();
        let mut beyond = Vec::new();
        let goals = survey.goals(open, ways);
        // Before the robot gives up, it tries again what the tether did not reach on a map that showed less.
        for again in [false, true] {
            for (to, goal) in goals.iter().filter(|(_, goal)| survey.choice.is_beyond(*goal, now_s) == again)
            {
                match self.way_within_limits(*goal, ways, solids) {
                    Some(way) => return Some((chosen((*to, *goal), way, beyond.len(), now_s), beyond)),
                    None => beyond.push(*goal),
                }
            }
        }
        let n_beyond = beyond.len();
        let home = self.config.task.end()?;
        // A robot that does not get there stands still, so that the rule for a stuck robot applies.
        if survey.choice.times_back >= MOST_TIMES {
            return None;
        }
        Some((chosen((SurveyGoal::Home, home), self.way_home(home, ways)?, n_beyond, now_s), beyond))
    }

    /// A way to a goal on which the tether stays within its limits: straight there or, if the cable would then lie on the
    /// wrong side of something, back first: along the return path or, if the hull does not fit there, as it came.
    fn way_within_limits(&self, goal: Point, ways: &Ways<'_>, solids: &[Shape]) -> Option<Vec<Point>> {
        let direct = ways.to(goal)?;
        let Some(tether) = &self.tether else { return Some(direct) };
        if tether.bears_with_reserve(&direct) {
            return Some(direct);
        }
        if !tether.can_reach_straight(goal) {
            return None;
        }
        let from_goal = self.survey.as_ref()?.exploration.ways(goal, self.guarded_room_m(), solids.iter());
        let taut = self.widest(|room_m| tether.return_path(self.cable_world(), room_m));
        let mut driven = vec![self.place_on_map()];
        driven.extend(tether.way_driven().iter().rev());
        let backs = taut.into_iter().chain([driven]);
        backs.into_iter().find_map(|back| {
            let back = polyline::resampled(&back, STEP_M);
            (1..back.len()).find_map(|last| {
                let mut onward = from_goal.to(back[last])?;
                onward.reverse();
                let way: Vec<Point> = back[..=last].iter().copied().chain(onward).collect();
                let is_way = self.is_passable(&way, ways, 0.5) && tether.bears_with_reserve(&way);
                is_way.then_some(way)
            })
        })
    }

    /// The way back: the cheapest way on the map if the tether is reeled in on it, else the return path along the tether.
    fn way_home(&self, home: Point, ways: &Ways<'_>) -> Option<Vec<Point>> {
        let map = self.chart.map();
        let hull_m = self.config.limits.radius_m;
        let direct = ways.to(home).map(|mut way| {
            // The start may be closer to something than the robot otherwise keeps.
            let last = way[way.len() - 1];
            if last != home && map.segment_clearance_m(last, home) >= hull_m {
                way.push(home);
            }
            way
        });
        let Some(tether) = &self.tether else { return direct };
        direct
            .filter(|way| tether.is_reeled_in_along(way))
            .or_else(|| {
                self.way_back().ok().map(|back| back.path).filter(|way| self.is_passable(way, ways, 0.0))
            })
            .or_else(|| self.way_back().ok().map(|back| back.path))
    }

    /// Everything on the chart that the hull must not touch.
    fn solids(&self) -> Vec<Shape> {
        let world = self.chart.world();
        let zones = world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo).map(|zone| &zone.shape);
        world.obstacles.iter().map(|obstacle| &obstacle.shape).chain(zones).cloned().collect()
    }

    /// Joins the objects of the map and of the chart again, and lays the cable among them.
    pub(in crate::engine) fn refresh_ground(&mut self) {
        let Some(survey) = &mut self.survey else { return };
        let Some(tether) = &mut self.tether else { return };
        let mapped: Vec<Shape> =
            survey.exploration.bodies().iter().flat_map(exploration::Body::shapes).collect();
        let been: Vec<Point> =
            tether.way_driven().iter().copied().chain([tether.anchor(), self.locator.position()]).collect();
        let ground = Ground::of(self.chart.world(), &mapped, &been);
        if ground.world() != survey.ground.world() {
            survey.ground = ground;
            tether.lay_again(survey.ground.world());
        }
    }
}

fn chosen(goal: (SurveyGoal, Point), path: Vec<Point>, beyond_tether: usize, now_s: f64) -> Chosen {
    let leg = Leg::along(goal, &path, now_s);
    let length_m = polyline::length_m(&path);
    Chosen { leg, event: SurveyWay { to: goal.0, path, length_m, beyond_tether } }
}

fn is_same(one: Point, other: Point) -> bool {
    (one - other).norm() < SAME_M
}
