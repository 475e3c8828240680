//! The tether-safe planner: lanes of a slit domain, so that the cable comes in whatever the order, with a certificate.

use crate::{
    answer::{self, plan_of},
    candidate::{Wishes, Worth, candidates, least_cable_m, worth},
    follow::{Follow, GUARD},
    ground::Ground,
    scan::{Draft, Order, Scan},
    side_by_side::side_by_side,
    stages::Stages,
};
use planner_api::{
    Caps, Command, Config, Ctx, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, TetherLimits, choice, float, int,
};
use steering::params as p;
use world::{
    Point, Shape,
    tether::{Cable, Certificate, Limits},
};

/// The choice by length and turns; candidates that look worse are not worked out for it.
const SHORTEST: &str = "shortest";
const UNLIMITED: Limits =
    Limits { reel_length_m: f64::INFINITY, wrap_max_rad: f64::INFINITY, wrap_total_max_rad: f64::INFINITY };
/// Most cells of the floor: more take memory and time, and the edges where cells matter are a smaller share of a large tank.
const MOST_CELLS: f64 = 4e6;
/// Share of the floor by which a plan may miss what is asked for without the reel being to blame.
const BY_REEL: f64 = 0.001;
/// First tours this much costlier than the best, as a share, never win.
const HOPELESS: f64 = 0.02;
/// How far a plan is when all candidates are tried, and when those of one angle are: about half of all tanks need
/// straighter cuts as well, nobody knows before.
const ALL_TRIED: f64 = 0.98;
const ONE_ANGLE: f64 = 0.7;
/// Nearer to home than so many swaths no cable lies across a cut.
const FAR: f64 = 4.0;
/// Share of the time for one angle that first tours take, and share of these that cuts take.
const FIRST_TOURS: f64 = 0.25;
const CUTS: f64 = 0.25;

const CHOOSE: ParamSpec = choice("choose", "Candidate", &[SHORTEST, "fewest-turns", "shortest-cable"], 0)
    .help("Which of the candidates within the limits is flown, shortest by length and turns. The log lists those that no other \
           beats in length, turns and cable; those that would cost over 2 % more are left and listed with an estimate.")
    .group("Plan");
const PATTERN: ParamSpec = choice("pattern", "Lanes", &["all", "contours", "straight"], 0)
    .help("Lanes along the wall, straight lanes within a lap along the wall, or whichever is better.")
    .group("Plan");
const DIRECTIONS: ParamSpec = int("directions", "Directions tried", "", 1, 24, 2)
    .help("Straight lanes are tried in this many directions.")
    .group("Plan");
const ALPHA: ParamSpec = float("alpha_deg", "Angle of cuts", "deg", 0.0, 80.0, 50.0)
    .help("Largest angle between a cut and the ray from the anchor: 0 gives the shortest cable, more a shorter path.")
    .group("Tether");
const CABLE: ParamSpec = float("cable_share", "Cable over least", "", 1.0, 10.0, 1.04)
    .help("Longest cable, as a multiple of the least that can do, if any candidate keeps it; the reel always limits it.")
    .group("Tether");
const WRAP: ParamSpec = float("wrap_deg", "Wrap on one obstacle", "deg", 10.0, 720.0, 75.0)
    .help("Largest angle of the cable about one obstacle, if any candidate keeps it; the mission's limit always holds.")
    .group("Tether");
const SUM_WRAP: ParamSpec = float("wrap_total_deg", "Wrap in sum", "deg", 10.0, 3600.0, 80.0)
    .help("Largest sum of the angles about all obstacles, if any candidate keeps it; the mission's limit always holds.")
    .group("Tether");
const TURN: ParamSpec = float("turn_m", "Turn in the search", "m", 0.0, 20.0, 1.0)
    .help("While a path is sought it may get this much longer for every whole turn saved; more leaves more floor to touch-ups.")
    .group("Plan");
const CHOICE_TURN: ParamSpec = float("choice_turn_m", "Turn in the choice", "m", 0.0, 20.0, 3.0)
    .help("Among candidates one may be this much longer for every whole turn that it saves.")
    .group("Plan");
const ENOUGH: ParamSpec = float("coverage_pct", "Coverage asked", "%", 50.0, 100.0, 99.58)
    .help("Touch-ups are added until this share of the floor in reach is scanned.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.025)
    .help("Edge of the cells in which floor is counted; in large tanks as much larger as keeps them below four million.")
    .group("Plan");
const KICKS: ParamSpec = float("kicks", "Search", "", 0.0, 200.0, 3.0)
    .help("Changes tried per lane in the search for the order of lanes; more takes longer and shortens the path.")
    .group("Plan");

/// Plans in the slit domain.
pub struct TetherSafe {
    wishes: Wishes,
    choose: &'static str,
    cell_m: f64,
    follow: Follow,
}

/// A candidate with what came of it.
struct Tried {
    name: String,
    /// Left out once another candidate is better: the floor of a large tank takes megabytes.
    scan: Option<Scan>,
    worth: Worth,
}

impl Planner for TetherSafe {
    const ID: &'static str = "tether-safe";
    const NAME: &'static str = "Tether-safe coverage";
    const ABOUT: &'static str = "Scans all floor in reach and never crosses a cut, so that the tether always comes in: \
                                 lanes of a simply connected domain, toured by local search, with a certificate.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::COVERAGE);
    const PARAMS: &'static [ParamSpec] = &[
        CHOOSE,
        PATTERN,
        DIRECTIONS,
        ALPHA,
        CABLE,
        WRAP,
        SUM_WRAP,
        TURN,
        CHOICE_TURN,
        ENOUGH,
        CELL,
        KICKS,
        GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let pattern = config.choice("pattern");
        let wishes = Wishes {
            alpha_rad: config.float("alpha_deg").to_radians(),
            cable_share: config.float("cable_share"),
            demanded: UNLIMITED,
            limits: Limits {
                reel_length_m: f64::INFINITY,
                wrap_max_rad: config.float("wrap_deg").to_radians(),
                wrap_total_max_rad: config.float("wrap_total_deg").to_radians(),
            },
            turn_m: config.float("turn_m"),
            choice_turn_m: config.float("choice_turn_m"),
            enough: config.float("coverage_pct") / 100.0,
            directions: if pattern == "contours" { 0 } else { config.int("directions") as usize },
            contours: pattern != "straight",
            kicks_per_lane: config.float("kicks"),
            seed: site.seed,
        };
        let follow = Follow::new(config, site);
        Ok(Self { wishes, choose: config.choice("choose"), cell_m: config.float("cell_m"), follow })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let task = answer::cover(request, Self::ID)?;
        let ground = Ground::new(request.site, task.anchor)?;
        let demanded = demanded(task.tether);
        let wishes = Wishes { limits: stricter(self.wishes.limits, demanded), demanded, ..self.wishes };
        let plan = self.planned(request, &task, &ground, &wishes, ctx)?;
        self.follow.take(&plan);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

/// What the mission demands: nothing of a robot without a tether.
fn demanded(task: Option<TetherLimits>) -> Limits {
    task.map_or(UNLIMITED, |task| Limits {
        reel_length_m: task.reel_length_m,
        wrap_max_rad: task.wrap_max_rad,
        wrap_total_max_rad: task.wrap_total_max_rad,
    })
}

/// Why not even one lane can be planned, if so: the swath is wider than the floor, or the reel does not reach one.
fn no_lane(ground: &Ground, reel_length_m: f64, home: Point) -> Option<String> {
    let (low, high) = ground.wall.bounds();
    let (swath_m, floor_m) = (ground.swath_m, (high.x - low.x).min(high.y - low.y));
    if swath_m > floor_m {
        return Some(format!(
            "the swath of {swath_m:.2} m is wider than the floor of {floor_m:.2} m; it must be narrower"
        ));
    }
    // The nearest lane that is not at the anchor itself lies a swath away; a robot beside the anchor is out already.
    let needed_m = (home - ground.anchor).norm() + swath_m.min(least_cable_m(ground));
    (reel_length_m < needed_m).then(|| {
        let farthest_m = least_cable_m(ground);
        format!(
            "the reel holds {reel_length_m:.2} m of cable; the nearest lanes need {needed_m:.2} m, the farthest floor is \
             {farthest_m:.1} m from the anchor"
        )
    })
}

/// Smallest cells that the floor is counted in, metres.
fn least_cell_m(ground: &Ground) -> f64 {
    let (low, high) = ground.wall.bounds();
    ((high.x - low.x) * (high.y - low.y) / MOST_CELLS).sqrt()
}

fn stricter(a: Limits, b: Limits) -> Limits {
    Limits {
        reel_length_m: a.reel_length_m.min(b.reel_length_m),
        wrap_max_rad: a.wrap_max_rad.min(b.wrap_max_rad),
        wrap_total_max_rad: a.wrap_total_max_rad.min(b.wrap_total_max_rad),
    }
}

impl TetherSafe {
    fn planned(
        &self,
        request: &PlanRequest<'_>,
        task: &answer::Cover<'_>,
        ground: &Ground,
        wishes: &Wishes,
        ctx: &Ctx<'_>,
    ) -> Result<Plan> {
        let mut stages = Stages::new(ctx);
        let least_m = least_cable_m(ground);
        let reel_length_m = wishes.limits.reel_length_m;
        let home = ground.home();
        if let Some(why) = no_lane(ground, reel_length_m, home) {
            return Err(PlannerError::new(planner_api::Code::Config, why));
        }
        let start = request.start.position;
        let laid = laid_cable(ground, request);
        let order = Order {
            start,
            regions: task.regions,
            reel_length_m: if reel_length_m > least_m * wishes.cable_share {
                f64::INFINITY
            } else {
                reel_length_m
            },
            cell_m: self.cell_m.max(least_cell_m(ground)),
        };
        let (away_m, is_out) = ((start - home).norm(), laid.is_some());
        // A cable that is well out may have to come in first, and then all is tried again.
        stages.until(if is_out && away_m > FAR * ground.swath_m { ALL_TRIED / 2.0 } else { ALL_TRIED });
        let mut tried = self.try_all(request.site, ground, wishes, &order, laid.as_ref(), &mut stages)?;
        let mut lead_in: Vec<Point> = Vec::new();
        if away_m > task.tolerance_m && tried.iter().all(|t| !t.worth.certificate.certified) {
            // Under way the cable may lie as no cut of the new map allows: take it in first.
            if let Some(way) =
                laid.as_ref().and_then(|cable| answer::return_path(ground, request.site, cable))
            {
                ctx.log(
                    LogLevel::Warn,
                    "the cable lies across a cut of the new plan: back along the cable first",
                );
                lead_in = way;
                let from_home = Order { start: home, ..order };
                stages.until(ALL_TRIED);
                tried = self.try_all(request.site, ground, wishes, &from_home, None, &mut stages)?;
            }
        }
        let (worth, scan) = Self::chosen(tried, ctx).ok_or_else(|| answer::no_room(ground))?;
        stages.until(1.0);
        stages.next(1.0, "floor out of reach").begin();
        answer::report_unreachable(ground, &scan, &order, ctx);
        // A reel near the least that can do may still reach all there is.
        let least = if order.reel_length_m.is_finite() { wishes.enough - BY_REEL } else { 0.99 };
        let is_whole = worth.coverage >= wishes.enough.min(least);
        if !is_whole && order.reel_length_m.is_infinite() {
            let share = 100.0 * worth.coverage;
            ctx.log(
                LogLevel::Warn,
                &format!("the plan scans {share:.1} % of the floor that is to be scanned"),
            );
        }
        if ctx.wants_drawing() {
            scan.cuts.iter().for_each(|cut| ctx.polyline(Layer::Tether, &cut.line));
        }
        let mut plan = plan_of(&scan, start, &lead_in);
        plan.complete = is_whole;
        if !is_within(&worth, wishes) && worth.certificate.certified {
            ctx.log(
                LogLevel::Warn,
                "no candidate keeps the cable as short and straight as the parameters ask",
            );
        }
        if !worth.certificate.certified {
            let why = worth.certificate.reasons.join("; ");
            ctx.log(LogLevel::Warn, &format!("not certified: {why}"));
        }
        if !plan.complete {
            ctx.log(LogLevel::Warn, &why_incomplete(worth.coverage, &order));
        }
        Ok(plan)
    }

    /// The candidates worth working out; straighter cuts as well if none keeps the limits.
    fn try_all(
        &self,
        site: &Site<'_>,
        ground: &Ground,
        wishes: &Wishes,
        order: &Order<'_>,
        laid: Option<&Cable>,
        stages: &mut Stages<'_>,
    ) -> Result<Vec<Tried>> {
        let (ctx, end) = (stages.ctx(), stages.end());
        let mut tried: Vec<Tried> = Vec::new();
        for share in [1.0, 0.5, 0.0] {
            let alpha_rad = wishes.alpha_rad * share;
            let is_first = share > 0.99;
            stages.until(stages.toward(end, ONE_ANGLE));
            let part = stages
                .next(FIRST_TOURS, if is_first { "first tours" } else { "first tours, straighter cuts" });
            let drafted = side_by_side(candidates(ground, wishes, alpha_rad), &part, |candidate, stop| {
                stop.stage(CUTS);
                let (recipe, domain) = candidate.recipe(ground, wishes, alpha_rad);
                let Some(domain) = domain else { return Ok(None) };
                let draft = Draft::new(ground, &recipe, domain, order, stop)?;
                Ok(Some((draft.estimate_m(wishes.choice_turn_m), candidate.name, draft)))
            })?;
            let mut drafts: Vec<(f64, String, Draft<'_>)> = drafted.into_iter().flatten().collect();
            drafts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let least_m = drafts.first().map_or(0.0, |draft| draft.0);
            let is_worth_it = |draft: &(f64, String, Draft<'_>)| {
                self.choose != SHORTEST || draft.0 <= least_m * (1.0 + HOPELESS)
            };
            let (good, hopeless): (Vec<_>, Vec<_>) = drafts.into_iter().partition(is_worth_it);
            ctx.scalar("candidates worked out", good.len() as f64, "");
            let mut n_to_come = hopeless.len();
            for drafts in [good, hopeless] {
                if tried.iter().any(|t| is_within(&t.worth, wishes)) {
                    for (estimate_m, name, _) in &drafts {
                        let more_m = estimate_m - least_m;
                        ctx.log(
                            LogLevel::Info,
                            &format!("{name}: left, it would cost about {more_m:.0} m more"),
                        );
                    }
                    break;
                }
                // It is even whether those that look worse are worked out as well.
                let n_left = drafts.len() as f64 + n_to_come as f64 / 2.0;
                n_to_come = 0;
                let what = if is_first { "candidates" } else { "candidates, straighter cuts" };
                let part = stages.next(drafts.len() as f64 / n_left.max(1.0), what);
                tried.extend(side_by_side(drafts, &part, |(_, name, draft), stop| {
                    let scan = draft.finished(stop)?;
                    stop.stage(1.0);
                    let worth = worth(ground, site, wishes.demanded, &scan, laid);
                    Ok(Tried { name, scan: Some(scan), worth })
                })?);
                self.keep_best(&mut tried, wishes);
            }
            if wishes.alpha_rad == 0.0 || tried.iter().any(|t| is_within(&t.worth, wishes)) {
                break;
            }
        }
        Ok(tried)
    }

    /// The candidate that was kept; logs every candidate that no other beats.
    fn chosen(tried: Vec<Tried>, ctx: &Ctx<'_>) -> Option<(Worth, Scan)> {
        for t in &tried {
            if !tried.iter().any(|other| t.worth.is_beaten_by(&other.worth)) {
                ctx.log(LogLevel::Info, &t.worth.summary(&t.name));
            }
        }
        tried.into_iter().find_map(|t| t.scan.map(|scan| (t.worth, scan)))
    }

    /// Leaves the scan of the best candidate only.
    fn keep_best(&self, tried: &mut [Tried], wishes: &Wishes) {
        let figure = |t: &Tried| match self.choose {
            "fewest-turns" => t.worth.turns,
            "shortest-cable" => t.worth.certificate.tether_length_max_m,
            _ => t.worth.length_m + wishes.choice_turn_m * t.worth.turns,
        };
        let rank = |t: &Tried| (!t.worth.certificate.certified, !is_within(&t.worth, wishes));
        let places = 0..tried.len();
        let best = places.min_by(|a, b| {
            let (a, b) = (&tried[*a], &tried[*b]);
            rank(a).cmp(&rank(b)).then(figure(a).total_cmp(&figure(b)))
        });
        for (place, other) in tried.iter_mut().enumerate() {
            if Some(place) != best {
                other.scan = None;
            }
        }
    }
}

/// Whether a candidate is certified and keeps what the operator wants of the cable as well.
fn is_within(worth: &Worth, wishes: &Wishes) -> bool {
    let Certificate { certified, wrap_max_rad, wrap_total_max_rad, .. } = worth.certificate;
    certified
        && worth.cable_share() <= wishes.cable_share + 1e-6
        && wrap_max_rad <= wishes.limits.wrap_max_rad
        && wrap_total_max_rad <= wishes.limits.wrap_total_max_rad
}

/// The cable as it lies after the path flown so far; none at the anchor.
fn laid_cable(ground: &Ground, request: &PlanRequest<'_>) -> Option<Cable> {
    let shapes: Vec<Shape> = crate::candidate::solids(request.site).into_iter().map(|o| o.shape).collect();
    let mut cable = Cable::new(ground.anchor, &ground.wall, &shapes).ok()?;
    cable.drag_along(request.previous);
    cable.drag_to(request.start.position);
    (!request.previous.is_empty()).then_some(cable)
}

/// Why a plan that scans this share of the floor in reach is not complete; logged last, because it is the reason given.
fn why_incomplete(coverage: f64, order: &Order<'_>) -> String {
    let scanned = format!("the plan scans {:.1} % of the floor in reach", 100.0 * coverage);
    if order.reel_length_m.is_finite() {
        format!("{scanned} of a reel of {:.1} m, which is too short for all of it", order.reel_length_m)
    } else {
        format!("{scanned}: the rest is left out")
    }
}

#[cfg(test)]
mod tests;
