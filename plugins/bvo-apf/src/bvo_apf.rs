//! The planner: it plans on the known map and drives tick by tick.

use crate::{
    ahead::{self, Ahead},
    machine::{Machine, News, Next, Phase},
    parameters,
    settings::{MachineSettings, Mode},
    taut,
    thought::{self, Walked},
};
use field::{
    ends,
    outcome::{Shortfall, Walk},
    params as p,
};
use planner_api::{
    Caps, Code, Command, Config, Ctx, Drive, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner,
    PlannerError, Result, Sensed, Site, Status,
};
use steering::{
    Flight, Forces, KnownMap, Pilot, Tick, drawing,
    evade::{self, Around},
};
use world::Point;

/// Distance ahead at which the robot aims during a retreat, metres.
const BACK_AHEAD_M: f64 = 0.2;
/// Factor by which the oscillation window is longer in flight, because the robot slows down and turns.
const FLIGHT_WINDOWS: f64 = 1.5;

/// Maximum number of parts of a map. Larger maps are refused, because every part is compared with every other and the
/// path is simulated.
const PARTS_MOST: usize = 4000;
/// Advice logged when the planner finds no path.
const INSTEAD: &str = "in rooms, choose shortest or navfn, which find a path wherever one exists";

/// The potential field of Xu et al. 2022 with virtual obstacles.
pub(crate) struct BvoApf {
    settings: MachineSettings,
    flight: Flight,
    pilot: Pilot,
    clearance_m: f64,
    map: KnownMap,
    flying: Option<Flying>,
}

/// State kept from tick to tick. If it is lost when planners change, it is built up again.
struct Flying {
    goal: Point,
    machine: Machine,
    back: Option<Point>,
}

impl Planner for BvoApf {
    const ID: &'static str = "bvo-apf";
    const NAME: &'static str = "Field with virtual obstacles";
    const ABOUT: &'static str = "Backs out of traps, seals them with virtual obstacles and goes around \
                                 them, after Xu et al. 2022. By default, the detour begins before the robot \
                                 enters the trap. Evades moving obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = parameters::PARAMS;

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            settings: parameters::settings(config, site, 1.0),
            flight: p::flight(config),
            pilot: Pilot::pursuing(site),
            clearance_m: site.clearance_m,
            map: KnownMap::standing(site),
            flying: None,
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.flight = p::flight(config);
        let wall_gain = config.float("wall_gain");
        self.settings.law.wall_gain = wall_gain;
        if let Some(flying) = &mut self.flying {
            flying.machine.settings.law.wall_gain = wall_gain;
        }
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let (goal, tolerance_m) = ends::single_goal(request, Self::ID)?;
        let start = request.start.position;
        self.map = KnownMap::standing(request.site);
        check_size(self.map.solids.len())?;
        let mut machine = Machine::new(self.settings_for(start, goal), self.map.clone());
        let walked = self.walked(&mut machine, start, goal, tolerance_m, ctx)?;
        report(&machine.news, ctx);
        show_virtual(&machine, ctx);
        ctx.scalar("retreats", f64::from(machine.retreats), "");
        ctx.scalar("virtual_circles", machine.virtual_circles().count() as f64, "");
        Ok(plan_of(walked, &machine, &self.map, goal, request.site.clearance_m, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let (movers, standing) = evade::sorted(sensed, self.pilot.bodies(sensed));
        if let Some(flying) = &mut self.flying {
            // A moving obstacle appears stationary when it is first seen.
            flying.machine.forget(&movers.iter().map(|mover| mover.body.id).collect::<Vec<_>>());
        }
        let tick = Tick::toward_target(sensed, &standing);
        let Some((aim, forces)) = self.aim(sensed, &tick, ctx) else {
            return Ok(Command::still(Status::Stuck));
        };
        let decision = self.pilot.pursue(&self.flight, &tick, aim);
        forces.show(ctx, sensed.pose.position, self.settings.law.k_rep);
        drawing::show_nearest(ctx, sensed.pose.position, self.map.hull_m, &standing);
        if movers.is_empty() {
            return Ok(decision.into());
        }
        for mover in &movers {
            ctx.arrow(Layer::Virtual, mover.body.center(), mover.velocity);
        }
        let around = Around {
            movers: &movers,
            standing: &standing,
            wall: self.pilot.wall(),
            limits: self.pilot.limits(),
            clearance_m: self.clearance_m,
        };
        let velocity = evade::evade(decision.velocity, &sensed.pose, &around);
        Ok(Command { drive: Drive::Velocity(velocity), status: Status::Moving })
    }
}

/// Refuses a map that is too large to plan on in time.
fn check_size(n_parts: usize) -> Result<()> {
    if n_parts <= PARTS_MOST {
        return Ok(());
    }
    let what = format!(
        "bvo-apf compares every part of a map with every other and accepts at most {PARTS_MOST}; this map \
         has {n_parts}: choose shortest, navfn or apf-dwa, or simplify the map (map_tolerance_m)"
    );
    Err(PlannerError::new(Code::Unsupported, what))
}

impl BvoApf {
    fn settings_for(&self, start: Point, goal: Point) -> MachineSettings {
        self.settings.for_trip((goal - start).norm())
    }

    fn walked(
        &self,
        machine: &mut Machine,
        start: Point,
        goal: Point,
        tolerance_m: f64,
        ctx: &Ctx<'_>,
    ) -> Result<Walked> {
        if machine.settings.mode != Mode::Pre {
            return thought::walk(machine, start, goal, tolerance_m, || ctx.check());
        }
        let ahead = ahead::of_traps(machine, start, goal, tolerance_m, || ctx.check())?;
        report_attempts(&ahead, ctx);
        let path = taut::paced(&ahead.walked.path, self.settings.step_m);
        Ok(Walked { path, ..ahead.walked })
    }

    /// Returns the next target and the forces behind it; `None` if the planner has given up.
    fn aim(&mut self, sensed: &Sensed<'_>, tick: &Tick<'_>, ctx: &Ctx<'_>) -> Option<(Point, Forces)> {
        let at = sensed.pose.position;
        if self.settings.mode == Mode::Pre
            && let Some(next) = sensed.path_ahead.first()
        {
            let forces = Forces { attraction: self.settings.law.pull.force(at, *next), ..Forces::default() };
            return Some((*next, forces));
        }
        let flying = self.flying(sensed);
        flying.machine.learn(tick.bodies);
        let next = flying.next(at, sensed.target);
        report(&std::mem::take(&mut flying.machine.news), ctx);
        ctx.scalar("phase", phase_number(flying.machine.phase()), "");
        ctx.scalar("virtual_circles", flying.machine.virtual_circles().count() as f64, "");
        show_virtual(&flying.machine, ctx);
        next.map(|aim| (aim, flying.machine.forces))
    }

    /// The state kept between ticks; reset for a new goal.
    fn flying(&mut self, sensed: &Sensed<'_>) -> &mut Flying {
        let goal = sensed.target;
        let fits = self.flying.as_ref().is_some_and(|flying| (flying.goal - goal).norm() < 1e-6);
        if !fits {
            let step_m = (self.pilot.limits().v_max_m_per_s * sensed.dt_s).max(1e-3);
            let settings = self.settings_for(sensed.pose.position, goal);
            let settings =
                MachineSettings { step_m, window_m: settings.window_m * FLIGHT_WINDOWS, ..settings };
            let machine = Machine::new(settings, self.map.clone());
            self.flying = Some(Flying { goal, machine, back: None });
        }
        self.flying.as_mut().expect("it has just been created")
    }
}

impl Flying {
    fn next(&mut self, at: Point, goal: Point) -> Option<Point> {
        loop {
            if let Some(back) = self.back.filter(|back| (back - at).norm() > BACK_AHEAD_M) {
                return Some(back);
            }
            match self.machine.next(at, goal) {
                Next::By(way) => {
                    self.back = None;
                    let along = way.try_normalize(1e-12);
                    return Some(
                        along.map_or(at, |along| at + along.cap_magnitude((goal - at).norm().max(0.05))),
                    );
                }
                Next::Back(place) => self.back = Some(place),
                Next::Nowhere => return None,
            }
        }
    }
}

fn phase_number(phase: &Phase) -> f64 {
    match phase {
        Phase::Approach => 0.0,
        Phase::Retreat(_) => 1.0,
        Phase::Escape(_) => 2.0,
        Phase::Stuck => 3.0,
        Phase::Follow(_) => 4.0,
    }
}

fn report(news: &[News], ctx: &Ctx<'_>) {
    for item in news {
        item.report(ctx);
    }
}

/// Logs how a path was found, unless it was found by the configured method.
fn report_attempts(ahead: &Ahead, ctx: &Ctx<'_>) {
    let follows = ahead.news.iter().filter(|item| matches!(item, News::Follows { .. }));
    let said: Vec<String> = follows.map(ToString::to_string).collect();
    let tried = ahead.tried.iter().filter(|_| ahead.tried.len() > 1).map(ToString::to_string);
    let said: Vec<String> = said.into_iter().chain(tried).collect();
    if !said.is_empty() {
        ctx.log(LogLevel::Warn, &said.join("; "));
    }
}

fn show_virtual(machine: &Machine, ctx: &Ctx<'_>) {
    if !ctx.wants_drawing() {
        return;
    }
    for (center, radius_m) in machine.virtual_circles() {
        ctx.circle(Layer::Virtual, center, radius_m);
    }
    if let (Phase::Escape(escape), Mode::Literal) = (machine.phase(), machine.settings.mode) {
        let (center, radius_m) = escape.circle();
        ctx.circle(Layer::Virtual, center, radius_m);
    }
}

/// Turns a walk into a plan, and logs what is wrong with it.
fn plan_of(
    walked: Walked,
    machine: &Machine,
    map: &KnownMap,
    goal: Point,
    demanded_m: f64,
    ctx: &Ctx<'_>,
) -> Plan {
    let end = walked.path[walked.path.len() - 1];
    let shortfall = (!walked.arrived).then(|| match machine.phase() {
        Phase::Stuck => Shortfall::Trapped { at: end },
        _ => Shortfall::Short { missing_m: (goal - end).norm(), at: end },
    });
    let clearance_m = map.path_clearance_m(&walked.path, demanded_m + 1.0);
    Walk { path: walked.path, shortfall }.into_plan_or(clearance_m, demanded_m, INSTEAD, ctx)
}

#[cfg(test)]
mod tests;
