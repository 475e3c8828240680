//! The surroundings of a cable, made once for many paths.

use super::cable_obstacles::CableObstacles;
use crate::tank::Obstacle;
use geometry::{Boundary, Point};
use std::sync::Arc;

/// Obstacles and wall as they affect a cable from one anchor.
#[derive(Debug)]
pub struct Ground {
    pub(super) anchor: Point,
    pub(super) obstacles: Arc<CableObstacles>,
}

impl Ground {
    /// Creates the ground for an anchor, tank frame.
    pub fn new(anchor: Point, boundary: &Boundary, obstacles: &[Obstacle]) -> Self {
        let shapes: Vec<_> = obstacles.iter().map(|o| o.shape.clone()).collect();
        Self { anchor, obstacles: Arc::new(CableObstacles::new(boundary, &shapes)) }
    }
}
