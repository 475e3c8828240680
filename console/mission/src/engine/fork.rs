//! A copy of the mission as it is now, for forecasting how it would continue.

use super::Mission;
use crate::config::BetterPlan;
use world::{Pose, StationId, World, tether::Cable};

/// A copy of the mission, with everything needed to start a simulation of its continuation.
#[derive(Clone)]
pub struct Fork {
    /// The mission. No planner is open: the first order has to choose one.
    pub mission: Mission,
    /// The tank as the mission knows it: the drawing, the obstacles found, and the zones drawn. Obstacles that have not
    /// been seen yet are missing.
    pub world: World,
    /// The robot's estimated pose.
    pub pose: Pose,
    /// The estimated geometry of the cable; `None` without a tether.
    pub cable: Option<Cable>,
    /// The estimated clock of each station: its offset and the change of the offset in an hour, metres. Empty if the
    /// stations share one clock.
    pub clocks_m: Vec<(StationId, f64, f64)>,
}

impl Mission {
    /// Copies the mission as it is now, using only the estimate and the map.
    ///
    /// Cost: copies the coverage grid and the map.
    pub fn fork(&self) -> Fork {
        let mut mission = self.clone();
        (mission.preparing, mission.shadow) = (None, None);
        // In the forecast the robot is simulated, is told the outlines of obstacles, and starts at rest.
        (mission.known.config.live, mission.known.config.guard_reaction_s) = (false, None);
        (mission.known.config.sensor, mission.known.perception) = (None, None);
        mission.known.governor.stand();
        // No operator is present to take a better plan.
        if mission.known.config.better_plan == BetterPlan::Offer {
            mission.known.config.better_plan = BetterPlan::Off;
        }
        mission.driving.leave_worker();
        mission.driving.worker.saved = None;
        let estimate = mission.known.locator.pose();
        Fork {
            world: mission.known.chart.world().clone(),
            pose: Pose { position: estimate.position, heading_rad: estimate.heading_rad },
            cable: mission.known.tether.as_ref().map(|tether| tether.cable().clone()),
            clocks_m: mission.known.locator.clocks_m(),
            mission,
        }
    }
}
