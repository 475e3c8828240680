//! A planner that drives from target to target.

use planner_api::{
    Caps, Code, Command, Config, Ctx, Layer, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, Task, export_planners, float,
};

struct Mine {
    speed_m_per_s: f64,
    limit_m_per_s: f64,
}

impl Planner for Mine {
    const ID: &'static str = env!("CARGO_PKG_NAME");
    const NAME: &'static str = "Straight to the target";
    const ABOUT: &'static str = "Drives directly to the target and ignores obstacles.";
    const CAPS: Caps = Caps::LOCAL;
    const PARAMS: &'static [ParamSpec] =
        &[float("speed", "Speed", "m/s", 0.01, 2.0, 0.2).help("Speed on the way to the target.").live()];

    fn configure(config: &Config<'_>, site: &Site<'_>, _ctx: &Ctx<'_>) -> Result<Self> {
        Ok(Self { speed_m_per_s: config.float("speed"), limit_m_per_s: site.limits.v_max_m_per_s })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, _ctx: &Ctx<'_>) -> Result<Plan> {
        let targets = match request.task {
            Task::Goto { goal, .. } => vec![goal],
            Task::Follow { targets, .. } => targets.to_vec(),
            Task::Cover { .. } => return Err(PlannerError::new(Code::Unsupported, "does not cover floors")),
        };
        let path = [vec![request.start.position], targets].concat();
        let cost = path.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        Ok(Plan { path, cost, complete: true, ..Plan::default() })
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        let way = sensed.target - sensed.pose.position;
        ctx.arrow(Layer::Attraction, sensed.pose.position, way);
        Ok(Command::velocity(way.cap_magnitude(self.speed_m_per_s.min(self.limit_m_per_s))))
    }

    fn reconfigure(&mut self, config: &Config<'_>, _ctx: &Ctx<'_>) -> Result<()> {
        self.speed_m_per_s = config.float("speed");
        Ok(())
    }
}

export_planners!(Mine);
