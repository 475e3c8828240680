//! The planner: offline on the known map, and tick by tick.

use crate::{
    machine::{Machine, News, Next, Phase},
    parameters,
    settings::{Mode, Settings},
    taut,
    thought::{self, Walked},
};
use field::{
    Flight, Ground, Pilot, Scene, Side, drawing, law::Forces, offline, outcome, params as p, pilot::Tick,
};
use planner_api::{
    Caps, Code, Command, Config, Ctx, Drive, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner,
    PlannerError, Result, Sensed, Site, Status, Task,
};
use world::Point;

/// On its way back the robot aims this far ahead, metres.
const BACK_AHEAD_M: f64 = 0.2;
/// In flight the window of oscillation is this many times as long: the robot slows down and turns.
const FLIGHT_WINDOWS: f64 = 1.5;

/// The potential field of Xu et al. 2022 that builds virtual obstacles.
pub(crate) struct BvoApf {
    settings: Settings,
    flight: Flight,
    pilot: Pilot,
    ground: Ground,
    flying: Option<Flying>,
}

/// What is kept from tick to tick; lost in a swap, it is built up again.
struct Flying {
    goal: Point,
    machine: Machine,
    back: Option<Point>,
}

impl Planner for BvoApf {
    const ID: &'static str = "bvo-apf";
    const NAME: &'static str = "Field with virtual obstacles";
    const ABOUT: &'static str = "Leaves traps, closes them with virtual obstacles and goes round, after Xu et al. 2022; \
                                 by default the detour begins before the trap is entered.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL);
    const PARAMS: &'static [ParamSpec] = parameters::PARAMS;

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            settings: parameters::settings(config, site, 1.0),
            flight: p::flight(config),
            pilot: Pilot::pursuing(site),
            ground: Ground::new(site),
            flying: None,
        })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let Task::Goto { goal, tolerance_m } = request.task else {
            let message = "bvo-apf goes to single goals; for preset paths choose apf or rpf";
            return Err(PlannerError::new(Code::Unsupported, message));
        };
        let scene = Scene::new(request.site);
        let start = request.start.position;
        offline::check_start(&scene, start, request.site.limits.radius_m)?;
        offline::check_goal(&scene, goal, tolerance_m)?;
        self.ground = Ground::new(request.site);
        let mut machine = Machine::new(self.settings_for(start, goal), self.ground.clone());
        let walked = self.walked(&mut machine, start, goal, tolerance_m, ctx)?;
        report(&machine.news, ctx);
        show_virtual(&machine, ctx);
        ctx.scalar("retreats", f64::from(machine.retreats), "");
        ctx.scalar("virtual_circles", machine.virtual_circles().count() as f64, "");
        Ok(plan_of(walked, &machine, &self.ground, goal, request.site.clearance_m, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let bodies = self.pilot.bodies(sensed);
        let tick = Tick {
            t_s: sensed.t_s,
            pose: sensed.pose,
            target: sensed.target,
            is_last: sensed.targets_ahead.len() <= 1,
            bodies: &bodies,
        };
        let Some((aim, forces)) = self.aim(sensed, &tick, ctx) else {
            return Ok(Command::still(Status::Stuck));
        };
        let decision = self.pilot.pursue(&self.flight, &tick, aim);
        drawing::show(ctx, sensed.pose.position, &forces, self.settings.law.k_rep);
        let near_m = bodies.iter().map(|b| b.hull_distance_m(sensed.pose.position, self.ground.hull_m));
        let near_m = near_m.fold(f64::INFINITY, f64::min);
        if near_m.is_finite() {
            ctx.scalar("obstacle_distance", near_m, "m");
        }
        Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status })
    }
}

impl BvoApf {
    fn settings_for(&self, start: Point, goal: Point) -> Settings {
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
        let walked = thought::ahead_of_traps(machine, start, goal, tolerance_m, || ctx.check())?;
        let path = taut::paced(&walked.path, self.settings.step_m);
        Ok(Walked { path, ..walked })
    }

    /// Where to go now and by what forces; `None` when it has given up.
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

    /// What is kept between ticks, reset for another goal.
    fn flying(&mut self, sensed: &Sensed<'_>) -> &mut Flying {
        let goal = sensed.target;
        let fits = self.flying.as_ref().is_some_and(|flying| (flying.goal - goal).norm() < 1e-6);
        if !fits {
            let step_m = (self.pilot.limits().v_max_m_per_s * sensed.dt_s).max(1e-3);
            let settings = self.settings_for(sensed.pose.position, goal);
            let settings = Settings { step_m, window_m: settings.window_m * FLIGHT_WINDOWS, ..settings };
            let machine = Machine::new(settings, self.ground.clone());
            self.flying = Some(Flying { goal, machine, back: None });
        }
        self.flying.as_mut().expect("it has just been made")
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
    }
}

fn report(news: &[News], ctx: &Ctx<'_>) {
    for item in news {
        let (level, message) = match item {
            News::Retreats { at } => {
                (LogLevel::Info, format!("trapped at ({:.2}, {:.2}): retreats", at.x, at.y))
            }
            News::Sealed { circles } => {
                (LogLevel::Info, format!("seals the trap with {circles} virtual circles"))
            }
            News::Escapes { at, side } => {
                let side = if *side == Side::Left { "left" } else { "right" };
                (LogLevel::Info, format!("goes round on the {side} from ({:.2}, {:.2})", at.x, at.y))
            }
            News::Resumes { at } => {
                (LogLevel::Info, format!("clear of the obstacle at ({:.2}, {:.2})", at.x, at.y))
            }
            News::GivesUp { at, escapes } => {
                (LogLevel::Warn, format!("gives up at ({:.2}, {:.2}) after {escapes} escapes", at.x, at.y))
            }
        };
        ctx.log(level, &message);
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

/// The plan, and what is wrong with it in the log.
fn plan_of(
    walked: Walked,
    machine: &Machine,
    ground: &Ground,
    goal: Point,
    demanded_m: f64,
    ctx: &Ctx<'_>,
) -> Plan {
    let end = walked.path[walked.path.len() - 1];
    let shortfall = (!walked.arrived).then(|| match machine.phase() {
        Phase::Stuck => outcome::Shortfall::Trapped { at: end },
        _ => outcome::Shortfall::Short { missing_m: (goal - end).norm(), at: end },
    });
    let walk = outcome::Walk { path: walked.path, shortfall };
    let clearance_m = ground.path_clearance_m(&walk.path, demanded_m + 1.0);
    offline::plan_of(walk, clearance_m, demanded_m, ctx)
}

#[cfg(test)]
mod tests;
