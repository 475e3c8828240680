//! Drives straight to its target. The planner guide shows this file.

use planner_api::{
    Caps, Code, Command, Config, Ctx, Layer, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, Task, export_planners, float,
};

struct Straight {
    speed_m_per_s: f64,
}

impl Planner for Straight {
    const ID: &'static str = "straight";
    const NAME: &'static str = "Straight to the target";
    const CAPS: Caps = Caps::LOCAL;
    const PARAMS: &'static [ParamSpec] =
        &[float("speed", "Speed", "m/s", 0.01, 2.0, 0.2).help("Speed on the way.").live()];

    fn configure(config: &Config<'_>, _site: &Site<'_>, _ctx: &Ctx<'_>) -> Result<Self> {
        Ok(Self { speed_m_per_s: config.float("speed") })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, _ctx: &Ctx<'_>) -> Result<Plan> {
        let Task::Goto { goal, .. } = request.task else {
            return Err(PlannerError::new(Code::Unsupported, "straight flies to single goals only"));
        };
        let start = request.start.position;
        let cost = (goal - start).norm();
        Ok(Plan { path: vec![start, goal], cost, complete: true, ..Plan::default() })
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        let way = sensed.target - sensed.pose.position;
        ctx.arrow(Layer::Attraction, sensed.pose.position, way);
        Ok(Command::velocity(way.cap_magnitude(self.speed_m_per_s)))
    }
}

export_planners!(Straight);

#[cfg(test)]
mod tests {
    #[test]
    fn the_guide_shows_this_file() {
        let guide = include_str!("../../../../console/docs/planner-guide.md");
        let source = include_str!("lib.rs").split("\n#[cfg(test)]").next().unwrap_or_default();
        let (_, code) = source.split_once("\n\n").expect("a line of documentation comes first");
        assert!(
            guide.contains(&format!("```rust\n{code}```\n")),
            "console/docs/planner-guide.md shows other code"
        );
    }
}
