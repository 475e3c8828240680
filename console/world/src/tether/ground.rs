//! What a cable lies on, made once for many paths.

use super::cable_obstacles::CableObstacles;
use crate::tank::Obstacle;
use geometry::{Boundary, Point};
use std::sync::Arc;

/// Obstacles and wall as a cable from one anchor meets them.
#[derive(Debug)]
pub struct Ground {
    pub(super) anchor: Point,
    pub(super) obstacles: Arc<CableObstacles>,
}

impl Ground {
    /// The ground of an anchor, tank frame.
    pub fn new(anchor: Point, boundary: &Boundary, obstacles: &[Obstacle]) -> Self {
        let shapes: Vec<_> = obstacles.iter().map(|o| o.shape.clone()).collect();
        Self { anchor, obstacles: Arc::new(CableObstacles::new(boundary, &shapes)) }
    }
}
