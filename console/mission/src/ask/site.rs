//! The tank as planners know it.

use planner_api as api;
use world::{Boundary, Shape, Vector};

/// The tank as it is known; the owned form of [`planner_api::Site`].
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Grows whenever an obstacle was found or turned out to stand elsewhere.
    pub revision: u32,
    /// The wall.
    pub boundary: Boundary,
    /// What stands in the tank.
    pub obstacles: Vec<SiteObstacle>,
    /// Areas with a meaning.
    pub zones: Vec<SiteZone>,
    /// What the robot can do.
    pub limits: api::Limits,
    /// Width of floor to count on in one pass, metres.
    pub swath_m: f64,
    /// Distance to keep between hull and anything solid, metres.
    pub clearance_m: f64,
    /// Start of a planner's random choices.
    pub seed: u64,
}

/// An obstacle as planners know it.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteObstacle {
    /// Its number.
    pub id: u32,
    /// Whether it was found under way.
    pub discovered: bool,
    /// Its velocity, metres per second; zero for what stands still.
    pub velocity_m_per_s: Vector,
    /// Its outline.
    pub shape: Shape,
}

/// An area with a meaning.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteZone {
    /// What it means.
    pub kind: api::ZoneKind,
    /// Its outline.
    pub shape: Shape,
}

impl Site {
    /// Lends the site in the form that planners read.
    pub fn lend<R>(&self, call: impl FnOnce(&api::Site<'_>) -> R) -> R {
        let obstacles: Vec<api::Obstacle<'_>> = self.obstacles.iter().map(SiteObstacle::lend).collect();
        let zones: Vec<api::Zone<'_>> = self
            .zones
            .iter()
            .map(|zone| api::Zone { kind: zone.kind, outline: zone.shape.as_ref() })
            .collect();
        call(&api::Site {
            revision: self.revision,
            boundary: self.boundary.as_ref(),
            obstacles: &obstacles,
            zones: &zones,
            limits: self.limits,
            swath_m: self.swath_m,
            clearance_m: self.clearance_m,
            seed: self.seed,
        })
    }
}

impl SiteObstacle {
    /// Lends the obstacle in the form that planners read.
    pub fn lend(&self) -> api::Obstacle<'_> {
        api::Obstacle {
            id: self.id,
            outline: self.shape.as_ref(),
            discovered: self.discovered,
            velocity_m_per_s: self.velocity_m_per_s,
        }
    }
}
