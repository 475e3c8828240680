//! Groups of obstacles that the robot cannot pass between; each group is treated as one obstacle.

use crate::inflation::SLACK_M;
use crate::workspace::{Workspace, reach_m, wall_gap_m};
use geometry::convex::Part;
use world::Point;

/// Parts too close together for the robot to pass between them.
pub(super) struct Cluster {
    /// Indices of the parts.
    pub parts: Vec<usize>,
    /// The foot, where the cut begins: the centre of the part farthest from the anchor.
    pub foot: Point,
    /// Distance of the foot from the anchor, metres.
    pub rho_m: f64,
    /// Whether the robot cannot pass between cluster and wall either, so that the cluster needs no cut.
    pub is_at_wall: bool,
    /// Largest distance from the foot to the outline of its part, metres.
    pub reach_m: f64,
    /// The points along the cuts from the foot to the wall, once these cuts exist.
    pub chain: Vec<Point>,
}

impl Cluster {
    /// The clusters of a workspace, in the order of their first parts.
    pub(super) fn all(workspace: &Workspace) -> Vec<Self> {
        let parts = &workspace.parts;
        let near_m = 2.0 * workspace.keep_m + 4.0 * SLACK_M;
        let mut of: Vec<usize> = (0..parts.len()).collect();
        for a in 0..parts.len() {
            for b in 0..a {
                if of[a] != of[b] && are_near(&parts[a], &parts[b], near_m) {
                    let (keep, drop) = (of[a].min(of[b]), of[a].max(of[b]));
                    of.iter_mut().filter(|cluster| **cluster == drop).for_each(|cluster| *cluster = keep);
                }
            }
        }
        let members = (0..parts.len()).map(|first| (0..parts.len()).filter(|k| of[*k] == first).collect());
        let clusters = members.filter(|members: &Vec<usize>| !members.is_empty());
        clusters.map(|members| Self::of(workspace, members, near_m)).collect()
    }

    fn of(workspace: &Workspace, parts: Vec<usize>, near_m: f64) -> Self {
        let part = |k: &usize| &workspace.parts[*k];
        let rho_m = |k: &usize| (part(k).middle() - workspace.anchor).norm();
        let last = parts
            .iter()
            .max_by(|a, b| rho_m(a).total_cmp(&rho_m(b)))
            .expect("a cluster has at least one part");
        let (foot, rho_m, reach_m) = (part(last).middle(), rho_m(last), reach_m(part(last)));
        let is_at_wall = parts.iter().any(|k| wall_gap_m(&workspace.wall, part(k)) < near_m);
        Self { parts, foot, rho_m, is_at_wall, reach_m, chain: vec![foot] }
    }
}

fn are_near(a: &Part, b: &Part, near_m: f64) -> bool {
    (a.middle() - b.middle()).norm() <= reach_m(a) + reach_m(b) + near_m && a.gap(b).width_m < near_m
}
