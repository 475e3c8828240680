//! The cable as it lies on the floor.

use crate::config::{PhysicalCable, SimConfig};
use cable::{Chain, Surfaces};
use std::sync::Arc;
use world::{CableLies, Point, tether::Cable};

/// Distance from the drawn line within which points of the cable are left out of it, metres.
const DRAWN_M: f64 = 0.03;
/// Time between two drawn lines, seconds.
const DRAWN_S: f64 = 1.0;

/// A physical cable in its tank.
#[derive(Clone)]
pub(crate) struct Laid {
    chain: Chain,
    surfaces: Arc<Surfaces>,
    physical: PhysicalCable,
    tick_s: f64,
}

impl Laid {
    /// Lays a cable along a taut one; `None` if the cable of the scenario is taut.
    pub(crate) fn along(taut: Option<&Cable>, config: &SimConfig) -> Option<Self> {
        let physical = config.physical?;
        let chain = Chain::along(&taut?.taut_line(), physical.law)?;
        Some(Self { chain, surfaces: surfaces(config), physical, tick_s: config.tick_s })
    }

    /// Notes that obstacles have moved.
    pub(crate) fn see(&mut self, config: &SimConfig) {
        self.surfaces = surfaces(config);
    }

    /// The cable after the robot has moved in a tick.
    pub(crate) fn moved(&self, robot: Point, tick: u64) -> Self {
        let mut moved = self.clone();
        let PhysicalCable { fails_at_s, breaks_at_s, breaks_at_n, .. } = self.physical;
        let is_past = |at_s: Option<f64>| at_s.is_some_and(|at_s| tick as f64 * self.tick_s >= at_s);
        if is_past(fails_at_s) {
            moved.chain.stop_reel();
        }
        // The pull of a cable that slides is largest at one of its ends.
        let most_n = self.robot_pull_n().max(self.reel_pull_n());
        if is_past(breaks_at_s) || breaks_at_n.is_some_and(|breaks_at_n| most_n > breaks_at_n) {
            moved.chain.tear();
        }
        moved.chain.step(robot, &self.surfaces, self.tick_s);
        moved
    }

    /// Whether the reel is empty and the robot cannot drive on.
    pub(crate) fn is_at_its_end(&self) -> bool {
        self.chain.is_at_its_end()
    }

    /// Length off the reel, metres.
    pub(crate) fn length_m(&self) -> f64 {
        self.chain.paid_out_m()
    }

    /// Pull at the reel, newtons.
    pub(crate) fn reel_pull_n(&self) -> f64 {
        self.chain.pull_at_reel_n()
    }

    /// Pull at the robot, newtons.
    pub(crate) fn robot_pull_n(&self) -> f64 {
        self.chain.pull_at_robot_n()
    }

    /// How the cable lies, with its line in some ticks.
    pub(crate) fn lies(&self, hull_m: f64, tick: u64) -> CableLies {
        let every = (DRAWN_S / self.tick_s).round().max(1.0) as u64;
        let line = if tick.is_multiple_of(every) { self.chain.line(DRAWN_M) } else { Vec::new() };
        CableLies {
            line,
            under_hull: self.chain.is_under(hull_m),
            reel_pull_n: self.reel_pull_n(),
            torn: self.chain.is_torn(),
        }
    }
}

fn surfaces(config: &SimConfig) -> Arc<Surfaces> {
    let link_m = config.physical.map_or(0.0, |physical| Chain::link_m(physical.law.length_m));
    Arc::new(Surfaces::new(&config.world.boundary, &config.world.obstacles, link_m))
}
