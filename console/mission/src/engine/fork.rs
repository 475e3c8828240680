//! A mission as it stands now, for a forecast of how it would go on.

use super::Mission;
use crate::config::BetterPlan;
use world::{Pose, World, tether::Cable};

/// A mission as it stands now, and everything that a simulation of how it goes on has to start from.
#[derive(Clone)]
pub struct Fork {
    /// The mission. No planner is open: the first order has to choose one.
    pub mission: Mission,
    /// The tank as the mission knows it: the drawing, and what was found. What nobody has seen yet is not in it.
    pub world: World,
    /// Where the robot believes it is.
    pub pose: Pose,
    /// The cable as it is believed to lie; `None` without a tether.
    pub cable: Option<Cable>,
}

impl Mission {
    /// The mission as it stands now, by the estimate and the map alone.
    ///
    /// Costs a copy of the coverage grid and of the map.
    pub fn fork(&self) -> Fork {
        let mut mission = self.clone();
        (mission.preparing, mission.shadow) = (None, None);
        // The robot of the forecast stands.
        mission.known.governor.stand();
        // Nobody is there to take one.
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
            mission,
        }
    }
}
