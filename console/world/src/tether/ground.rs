//! What a cable lies on: obstacles and the shortest paths between them, made once for many paths.

use super::{cable_obstacles::CableObstacles, geodesic::Geodesic};
use crate::tank::Obstacle;
use geometry::{Boundary, Point};
use std::sync::{Arc, OnceLock};

/// Obstacles and wall as a cable from one anchor meets them.
#[derive(Debug)]
pub struct Ground {
    pub(super) anchor: Point,
    pub(super) obstacles: Arc<CableObstacles>,
    /// Searched when it is first needed: most paths on open floor never ask for it.
    geodesic: OnceLock<Geodesic>,
}

impl Ground {
    /// The ground of an anchor, tank frame.
    pub fn new(anchor: Point, boundary: &Boundary, obstacles: &[Obstacle]) -> Self {
        let shapes: Vec<_> = obstacles.iter().map(|o| o.shape.clone()).collect();
        let obstacles = Arc::new(CableObstacles::new(boundary, &shapes));
        Self { anchor, obstacles, geodesic: OnceLock::new() }
    }

    /// The shortest paths from the anchor.
    pub(super) fn geodesic(&self) -> &Geodesic {
        self.geodesic.get_or_init(|| Geodesic::new(self.anchor, Arc::clone(&self.obstacles)))
    }
}
