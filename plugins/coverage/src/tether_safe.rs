//! The tether-safe planner: lanes of a slit domain, so that the cable comes in whatever the order, with a certificate.

use crate::{
    answer::{self, plan_of},
    candidate::{Candidate, Wishes, Worth, candidates, least_cable_m, worth},
    follow::{Follow, GUARD},
    ground::Ground,
    scan::{Draft, Order, Scan},
};
use field::params as p;
use planner_api::{
    Caps, Command, Config, Ctx, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, TetherLimits, choice, float, int,
};
use world::{
    Point, Shape,
    tether::{Cable, Limits},
};

/// The choice by length and turns; candidates that look worse are not worked out for it.
const SHORTEST: &str = "shortest";
/// First tours this much costlier than the best, as a share, never win.
const HOPELESS: f64 = 0.02;

const CHOOSE: ParamSpec = choice("choose", "Candidate", &[SHORTEST, "fewest-turns", "shortest-cable"], 0)
    .help("Which of the candidates within the limits is flown; the log lists all that are worth it.")
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
    .help("Longest cable that a plan may need, as a multiple of the least that can do.")
    .group("Tether");
const WRAP: ParamSpec = float("wrap_deg", "Wrap on one obstacle", "deg", 10.0, 720.0, 75.0)
    .help("Largest angle of the cable about one obstacle; the mission's limit holds if it is smaller.")
    .group("Tether");
const SUM_WRAP: ParamSpec = float("sum_wrap_deg", "Wrap in sum", "deg", 10.0, 3600.0, 80.0)
    .help("Largest sum of the angles about all obstacles; the mission's limit holds if it is smaller.")
    .group("Tether");
const TURN: ParamSpec = float("turn_m", "Price of a whole turn", "m", 0.0, 20.0, 0.7)
    .help("A path may be this much longer for every whole turn that it saves.")
    .group("Plan");
const ENOUGH: ParamSpec = float("coverage_pct", "Coverage asked", "%", 50.0, 100.0, 99.55)
    .help("Touch-ups are added until this share of the floor in reach is scanned.")
    .group("Plan");
const CELL: ParamSpec = float("cell_m", "Cell", "m", 0.01, 0.5, 0.05)
    .help("Edge of the cells in which floor is counted.")
    .group("Plan");
const KICKS: ParamSpec = float("kicks", "Search", "", 0.0, 200.0, 1.5)
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
    scan: Scan,
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
            limits: Limits {
                reel_m: f64::INFINITY,
                max_wrap_rad: config.float("wrap_deg").to_radians(),
                max_sum_wrap_rad: config.float("sum_wrap_deg").to_radians(),
            },
            turn_m: config.float("turn_m"),
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
        let wishes = Wishes { limits: within(self.wishes.limits, task.tether), ..self.wishes };
        let plan = self.planned(request, &task, &ground, &wishes, ctx)?;
        self.follow.take(&plan);
        Ok(plan)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.follow.step(sensed, ctx)
    }
}

/// The stricter of the operator's and the mission's limits.
fn within(own: Limits, task: Option<TetherLimits>) -> Limits {
    let Some(task) = task else { return own };
    Limits {
        reel_m: own.reel_m.min(task.reel_m),
        max_wrap_rad: own.max_wrap_rad.min(task.max_wrap_rad),
        max_sum_wrap_rad: own.max_sum_wrap_rad.min(task.max_sum_wrap_rad),
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
        let least_m = least_cable_m(ground);
        let reel_m = wishes.limits.reel_m;
        if reel_m < ground.swath_m {
            return Err(PlannerError::new(
                planner_api::Code::Config,
                format!(
                    "the reel holds {reel_m:.2} m of cable; the farthest floor is {least_m:.1} m from the anchor"
                ),
            ));
        }
        let home = ground.home();
        let start = request.start.position;
        let laid = laid_cable(ground, request);
        let order = Order {
            start,
            regions: task.regions,
            reel_m: if reel_m > least_m * wishes.cable_share { f64::INFINITY } else { reel_m },
            cell_m: self.cell_m,
        };
        let mut tried = self.try_all(request.site, ground, wishes, &order, laid.as_ref(), ctx)?;
        let mut lead_in: Vec<Point> = Vec::new();
        if (start - home).norm() > task.tolerance_m && tried.iter().all(|t| !t.worth.certificate.certified) {
            // Under way the cable may lie as no cut of the new map allows: take it in first.
            if let Some(way) = laid.as_ref().and_then(|cable| answer::way_home(ground, request.site, cable)) {
                ctx.log(
                    LogLevel::Warn,
                    "the cable lies across a cut of the new plan: back along the cable first",
                );
                lead_in = way;
                let from_home = Order { start: home, ..order };
                tried = self.try_all(request.site, ground, wishes, &from_home, None, ctx)?;
            }
        }
        let chosen = self.chosen(tried, wishes, ctx).ok_or_else(|| answer::no_room(ground))?;
        answer::tell_unreachable(ground, &chosen.scan, &order, ctx);
        if ctx.wants_drawing() {
            chosen.scan.cuts.iter().for_each(|cut| ctx.polyline(Layer::Tether, &cut.line));
        }
        let mut plan = plan_of(&chosen.scan, start, &lead_in);
        let reachable = chosen.worth.coverage >= wishes.enough.min(0.99);
        plan.complete = reachable && order.reel_m.is_infinite();
        if !chosen.worth.certificate.certified {
            let why = chosen.worth.certificate.reasons.join("; ");
            ctx.log(LogLevel::Warn, &format!("not certified: {why}"));
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
        ctx: &Ctx<'_>,
    ) -> Result<Vec<Tried>> {
        let mut tried: Vec<Tried> = Vec::new();
        for share in [1.0, 0.5, 0.0] {
            let mut drafts: Vec<(f64, String, Draft<'_>)> = Vec::new();
            for Candidate { name, recipe } in candidates(ground, wishes, wishes.alpha_rad * share) {
                if let Some(draft) = Draft::new(ground, &recipe, order, ctx)? {
                    drafts.push((draft.estimate_m(), name, draft));
                }
            }
            drafts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let least_m = drafts.first().map_or(0.0, |draft| draft.0);
            let n = drafts.len() as f64;
            for (done, (estimate_m, name, draft)) in drafts.into_iter().enumerate() {
                ctx.scalar("candidates done", done as f64 / n, "");
                let is_hopeless = self.choose == SHORTEST && estimate_m > least_m * (1.0 + HOPELESS);
                if is_hopeless && tried.iter().any(|t| is_within(&t.worth, wishes)) {
                    ctx.log(
                        LogLevel::Info,
                        &format!("{name}: left, it would cost about {:.0} m more", estimate_m - least_m),
                    );
                    continue;
                }
                let scan = draft.finished(ctx)?;
                let worth = worth(ground, site, wishes.limits, &scan, laid);
                tried.push(Tried { name, scan, worth });
            }
            if wishes.alpha_rad == 0.0 || tried.iter().any(|t| is_within(&t.worth, wishes)) {
                break;
            }
        }
        Ok(tried)
    }

    /// The candidate that the operator wants among those within the limits, with the others told.
    fn chosen(&self, tried: Vec<Tried>, wishes: &Wishes, ctx: &Ctx<'_>) -> Option<Tried> {
        for t in &tried {
            if !tried.iter().any(|other| t.worth.is_beaten_by(&other.worth)) {
                ctx.log(LogLevel::Info, &t.worth.told(&t.name));
            }
        }
        let figure = |t: &Tried| match self.choose {
            "fewest-turns" => t.worth.turns,
            "shortest-cable" => t.worth.certificate.max_cable_m,
            _ => t.worth.length_m + wishes.turn_m * t.worth.turns,
        };
        let rank = |t: &Tried| (!t.worth.certificate.certified, !is_within(&t.worth, wishes));
        tried.into_iter().min_by(|a, b| rank(a).cmp(&rank(b)).then(figure(a).total_cmp(&figure(b))))
    }
}

fn is_within(worth: &Worth, wishes: &Wishes) -> bool {
    worth.certificate.certified && worth.cable_share() <= wishes.cable_share + 1e-6
}

/// The cable as it lies after the path flown so far; none at the anchor.
fn laid_cable(ground: &Ground, request: &PlanRequest<'_>) -> Option<Cable> {
    let shapes: Vec<Shape> = crate::candidate::solids(request.site).into_iter().map(|o| o.shape).collect();
    let mut cable = Cable::new(ground.anchor, &ground.wall, &shapes).ok()?;
    cable.drag_along(request.previous);
    cable.drag_to(request.start.position);
    (!request.previous.is_empty()).then_some(cable)
}

#[cfg(test)]
mod tests;
