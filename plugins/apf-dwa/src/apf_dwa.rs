//! The planner: it plans on the known map and drives tick by tick.

use crate::{
    hybrid::{Decision, Hybrid, HybridSettings, State, distances_m, route, run},
    parameters,
    surroundings::{Changed, Surroundings},
    window::{Twist, Window, arc, moved},
};
use field::{
    ends,
    outcome::{Shortfall, Walk},
};
use geometry::motion::{TURN_FIRST_RAD, drive_for};
use planner_api::{
    Caps, Command, Config, Ctx, Drive, Layer, Limits, LogLevel, Motion, ParamSpec, Plan, PlanRequest,
    Planner, Result, Sensed, Site, Status, ZoneKind,
};
use steering::{
    Body, KnownMap,
    evade::{self, Around, Mover},
    stall::Stall,
};
use world::{Pace, Pose, Zone};

/// Maximum number of steps in a plan: a multiple of the number needed for the straight path at the slower pace, plus a
/// constant.
const DETOUR: f64 = 6.0;
const SPARE_STEPS: usize = 2500;
/// When obstacles move, an arc is represented by its mean velocity over this time, seconds.
const WISH_S: f64 = 1.0;

/// Advice logged when the planner finds no path.
const INSTEAD: &str = "choose shortest or navfn, which find a path wherever one exists";

/// A hybrid of potential field and dynamic window, for land and water.
pub(crate) struct ApfDwa {
    settings: HybridSettings,
    hybrid: Hybrid,
    around: Surroundings,
    no_go: Vec<Body>,
    limits: Limits,
    clearance_m: f64,
    evades: bool,
    stuck_s: f64,
    stall: Stall,
    used: u32,
}

impl Planner for ApfDwa {
    const ID: &'static str = "apf-dwa";
    const NAME: &'static str = "Field and dynamic window";
    const ABOUT: &'static str = "A potential field with virtual goals steers a dynamic window with \
                                 separate limits on land and under water, after Yang et al. 2021. Evades \
                                 moving obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = parameters::PARAMS;

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let settings = parameters::settings(config, site);
        Ok(Self {
            settings,
            hybrid: Hybrid::new(settings, zones(site), site.limits.radius_m),
            around: Surroundings::of_site(site),
            no_go: Body::no_go(site),
            limits: site.limits,
            clearance_m: site.clearance_m,
            evades: config.flag("evade"),
            stuck_s: config.float("stuck_s"),
            stall: Stall::default(),
            used: 0,
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        let keep_m = parameters::keep_m(config, self.limits.radius_m, self.clearance_m);
        let wall_gain = config.float("wall_gain");
        self.settings.keep(keep_m, wall_gain);
        self.hybrid.keep(keep_m, wall_gain);
        self.evades = config.flag("evade");
        self.stuck_s = config.float("stuck_s");
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let (goal, tolerance_m) = ends::single_goal(request, Self::ID)?;
        let (site, start) = (request.site, request.start);
        let map = KnownMap::standing(site);
        let run = if Surroundings::is_small(&map) {
            let pose = Pose { position: start.position, heading_rad: start.heading_rad };
            let mut hybrid = Hybrid::new(self.settings, zones(site), site.limits.radius_m);
            let steps_max = self.steps_max((goal - start.position).norm());
            let run = run(&mut hybrid, pose, goal, tolerance_m, steps_max, &map, || ctx.check())?;
            ctx.scalar("virtual_goals", f64::from(hybrid.guide().used()), "");
            ctx.scalar("overspeed", run.overspeed_m_per_s, "m/s");
            run
        } else {
            ctx.log(
                LogLevel::Info,
                "on a map of this size the plan is the shortest path; the dynamic window follows it",
            );
            route(&map, start.position, goal, self.settings.field.keep_m, || ctx.check())?
        };
        let at = run.path[run.path.len() - 1];
        let missing_m = (goal - at).norm();
        let shortfall = (!run.arrived).then_some(Shortfall::Short { missing_m, at });
        let clearance_m = map.path_clearance_m(&run.path, site.clearance_m + 1.0);
        self.around = Surroundings::new(map);
        self.hybrid.take_change(Changed { parts: true, ways: true });
        Ok(Walk { path: run.path, shortfall }.into_plan_or(clearance_m, site.clearance_m, INSTEAD, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let pose = Pose { position: sensed.pose.position, heading_rad: sensed.pose.heading_rad };
        let twist = Twist { v_m_per_s: sensed.v_m_per_s.max(0.0), w_rad_per_s: sensed.w_rad_per_s };
        let (movers, standing) = evade::sorted_if(self.evades, sensed, Body::sensed(sensed, &[]));
        let moves = |id| sensed.obstacles.iter().any(|o| o.id == id && evade::moves(o));
        let changed = self.around.look(pose.position, self.hybrid.reach_m(), &standing, moves);
        self.hybrid.take_change(changed);
        self.hybrid.set_tick(sensed.dt_s);
        let state = State { pose, twist };
        let decision = self.hybrid.decide(&state, sensed.target, sensed.path_ahead, &self.around);
        decision.forces.show(ctx, pose.position, self.settings.field.square.k_att);
        for (name, distance_m) in DISTANCES.iter().zip(distances_m(self.around.map(), pose.position)) {
            ctx.scalar(name, distance_m, "m");
        }
        ctx.scalar("safe_distance", self.settings.window.keep_m - self.around.map().hull_m, "m");
        ctx.scalar("mode", self.hybrid.mode().unwrap_or(0.0), "");
        ctx.scalar("speed_limit", decision.pace.v_max_m_per_s, "m/s");
        self.report(&pose, decision.twist, ctx);
        let idle_s = self.stall.update(sensed.t_s, pose.position, sensed.target);
        let is_stuck = idle_s > self.stuck_s && movers.is_empty();
        let status = if is_stuck { Status::Stuck } else { Status::Moving };
        for mover in &movers {
            mover.show(ctx);
        }
        let drive = if movers.is_empty() {
            self.drive(&pose, decision.twist)
        } else {
            self.past(&movers, standing, &decision, sensed)
        };
        Ok(Command { drive, status })
    }
}

/// Names of the distances to the nearest obstacles (Figs 12 to 15 of the paper plot ten).
const DISTANCES: [&str; 10] = [
    "obstacle_distance",
    "obstacle_distance_2",
    "obstacle_distance_3",
    "obstacle_distance_4",
    "obstacle_distance_5",
    "obstacle_distance_6",
    "obstacle_distance_7",
    "obstacle_distance_8",
    "obstacle_distance_9",
    "obstacle_distance_10",
];

impl ApfDwa {
    fn steps_max(&self, straight_m: f64) -> usize {
        let slowest =
            self.settings.robot.land.v_max_m_per_s.min(self.settings.robot.underwater.v_max_m_per_s);
        let Window { dt_s, .. } = self.settings.window;
        let straight = straight_m / (slowest.max(1e-3) * dt_s);
        if self.settings.steps_max > 0 {
            self.settings.steps_max
        } else {
            (DETOUR * straight) as usize + SPARE_STEPS
        }
    }

    fn report(&mut self, pose: &Pose, twist: Twist, ctx: &Ctx<'_>) {
        let guide = self.hybrid.guide();
        if guide.used() > self.used {
            self.used = guide.used();
            ctx.log(LogLevel::Debug, "in a local minimum: heading for a virtual goal");
        }
        if !ctx.wants_drawing() {
            return;
        }
        if let Some(corner) = guide.virtual_goal() {
            ctx.circle(Layer::Virtual, corner, 0.2);
        }
        ctx.polyline(Layer::Path, guide.way());
        ctx.polyline(Layer::Other, &arc(pose, twist));
    }

    /// Converts a twist to a drive command. A robot that can move in any direction gets the velocity along the arc.
    fn drive(&self, pose: &Pose, twist: Twist) -> Drive {
        if self.limits.motion == Motion::Unicycle {
            return Drive::Twist { v_m_per_s: twist.v_m_per_s, w_rad_per_s: twist.w_rad_per_s };
        }
        let dt_s = self.settings.window.dt_s;
        let turned = moved(pose, Twist { v_m_per_s: 0.0, ..twist }, dt_s);
        // A point robot faces the direction in which it moves: it cannot turn on the spot.
        Drive::Velocity(turned.direction() * twist.v_m_per_s.max(1e-3))
    }

    /// Returns the drive command for a decision, or the velocity closest to its arc that stays clear of moving
    /// obstacles.
    fn past(
        &self,
        movers: &[Mover],
        mut standing: Vec<Body>,
        decision: &Decision,
        sensed: &Sensed<'_>,
    ) -> Drive {
        let pose = Pose { position: sensed.pose.position, heading_rad: sensed.pose.heading_rad };
        let Pace { v_max_m_per_s, w_max_rad_per_s } = decision.pace;
        let limits = Limits { v_max_m_per_s, w_max_rad_per_s, ..self.limits };
        standing.extend(self.no_go.iter().cloned());
        let around = Around {
            movers,
            standing: &standing,
            wall: &self.around.map().wall,
            limits: &limits,
            clearance_m: self.clearance_m,
        };
        let wish = (moved(&pose, decision.twist, WISH_S).position - pose.position) / WISH_S;
        let velocity = evade::evade(wish, &sensed.pose, &around);
        if velocity == wish {
            return self.drive(&pose, decision.twist);
        }
        drive_for(Drive::Velocity(velocity), pose.heading_rad, &limits, TURN_FIRST_RAD)
    }
}

fn zones(site: &Site<'_>) -> Vec<Zone> {
    let kind = |kind: ZoneKind| match kind {
        ZoneKind::NoGo => world::ZoneKind::NoGo,
        ZoneKind::Land => world::ZoneKind::Land,
        ZoneKind::Underwater => world::ZoneKind::Underwater,
    };
    let zone = |zone: &planner_api::Zone<'_>| Zone {
        name: String::new(),
        kind: kind(zone.kind),
        shape: zone.outline.to_owned(),
    };
    site.zones.iter().map(zone).collect()
}

#[cfg(test)]
mod clearance;
#[cfg(test)]
mod tests;
