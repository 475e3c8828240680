//! The forces and displacements of one step.
//!
//! Friction is a resistance that does not depend on speed, the links bear only tension, and the solid objects only press.
//! So the displacements are those that minimise the work against friction, plus the strain of links, reel and surfaces: a
//! convex function. Each node couples only with its two neighbours, so each pass solves a block tridiagonal system
//! directly. The pressure of a surface and the turn of the cable, which decide its friction there, are those of the previous
//! pass.

use crate::{
    banded::System,
    feed::Feed,
    law::Law,
    surfaces::{Surfaces, Touch},
};
use geometry::{Point, Vector, direction_or};
use nalgebra::Matrix2;

/// How often the planes that stand for curved surfaces are placed in a step: first where the last displacements lead, then
/// where the nodes have come to.
const ROUNDS: usize = 2;
/// Most passes of a round. Where the cable turns far round a column, it slides only after many: the friction there follows
/// the pressure of the pass before. After 20 passes, a cable with 270 degrees of wrap could stick that theory lets slide.
const MOST_PASSES: usize = 100;
/// Most times that a pass is shortened because it went too far.
const MOST_HALVINGS: usize = 8;
/// Displacement below which a node counts as at rest, metres: friction grows up to it and is constant above.
const REST_M: f64 = 1e-5;
/// Resistance that grows with the displacement, newtons per metre and metre of cable. It keeps a cable without friction
/// from moving without a bound.
const VISCOUS: f64 = 0.01;
/// Stiffness of a surface, as a share of the stiffness of a link.
const SURFACE: f64 = 0.3;
/// Change of the displacements between two passes below which they count as found, metres.
const SETTLED_M: f64 = 1e-6;
/// Pressure of a node, as a share of the pull, below which the cable counts as straight there.
const LITTLE_TURN: f64 = 1e-3;
/// Distance from a surface, metres, within which a node may reach it in a step.
const REACH_M: f64 = 0.1;

/// The links of a cable. Node 0 is the robot, the last node is the anchor; the last link leads onto the reel.
#[derive(Debug, Clone)]
pub(crate) struct Links {
    pub nodes: Vec<Point>,
    /// Length of each link, metres; one less than nodes.
    pub rest_m: Vec<f64>,
    /// The link where the cable is torn: it bears nothing.
    pub torn: Option<usize>,
}

/// The solution of a step; also where the next step begins to search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Solution {
    /// Displacement of each node, metres.
    pub moved: Vec<Vector>,
    /// Pull of each link, newtons.
    pub pull_n: Vec<f64>,
    /// The nearest surface of each node, if one is near.
    touches: Vec<Option<Touch>>,
    /// Friction of the surface at each node, newtons.
    grip_n: Vec<f64>,
    /// Cable fed out in this step, metres; negative if it was taken up.
    pub feed_m: f64,
}

/// One step.
pub(crate) struct Step<'a> {
    pub links: &'a Links,
    pub law: Law,
    pub surfaces: &'a Surfaces,
    /// Displacement of the robot, metres.
    pub robot: Vector,
    pub feed: Feed,
}

impl Step<'_> {
    /// Solves the step, beginning with the solution of an earlier one.
    pub(crate) fn solve(&self, found: &mut Solution) {
        let last = self.links.rest_m.len();
        found.moved.resize(last + 1, Vector::zeros());
        found.grip_n.resize(last + 1, 0.0);
        (found.moved[0], found.moved[last]) = (self.robot, Vector::zeros());
        let mut system = System::new(last.saturating_sub(1));
        for _ in 0..ROUNDS {
            self.touch(found);
            for _ in 0..MOST_PASSES {
                self.assemble(found, &mut system);
                system.solve();
                let far_m = self.advance(found, &system.solution);
                self.grip(found);
                if far_m < SETTLED_M {
                    break;
                }
            }
        }
        self.pull(found);
    }

    /// Where a node is at the end of the step.
    fn end(&self, moved: &[Vector], node: usize) -> Point {
        self.links.nodes[node] + moved[node]
    }

    /// Stiffness of a link of a given length, newtons per metre.
    fn stiffness(&self, rest_m: f64) -> f64 {
        1.0 / (self.law.stretch_per_n() * rest_m.max(1e-3))
    }

    fn surface_stiffness(&self, node: usize) -> f64 {
        SURFACE * self.stiffness(self.links.rest_m[node])
    }

    /// A link at the end of the step.
    fn drawn(&self, moved: &[Vector], link: usize) -> Vector {
        let nodes = &self.links.nodes;
        nodes[link + 1] - nodes[link] + moved[link + 1] - moved[link]
    }

    /// Pull of a link of a given drawn length, its growth per metre, and the energy.
    fn strain(&self, link: usize, length_m: f64) -> [f64; 3] {
        if self.links.torn == Some(link) {
            return [0.0; 3];
        }
        let rest_m = self.links.rest_m[link];
        let stiffness = self.stiffness(rest_m);
        let too_long_m = length_m - rest_m;
        if link + 1 == self.links.rest_m.len() {
            return self.feed.strain(stiffness, too_long_m);
        }
        if too_long_m <= 0.0 { [0.0; 3] } else { spring(stiffness, too_long_m) }
    }

    /// Length of cable at a node, metres.
    fn share_m(&self, node: usize) -> f64 {
        0.5 * (self.links.rest_m[node - 1] + self.links.rest_m[node])
    }

    fn friction_n(&self, found: &Solution, node: usize) -> f64 {
        self.law.floor_n_per_m * self.share_m(node) + found.grip_n[node]
    }

    fn assemble(&self, found: &Solution, system: &mut System) {
        system.clear();
        for node in 1..self.links.nodes.len() - 1 {
            let moved = found.moved[node];
            let resistance =
                self.friction_n(found, node) / moved.norm().hypot(REST_M) + VISCOUS * self.share_m(node);
            let (mut force, mut stiffness) = (-moved * resistance, Matrix2::identity() * resistance);
            if let Some(touch) = found.touches[node] {
                let gap_m = touch.gap_at_m(self.end(&found.moved, node));
                if gap_m < 0.0 {
                    let by = self.surface_stiffness(node);
                    force -= touch.away * (by * gap_m);
                    stiffness += touch.away * touch.away.transpose() * by;
                }
            }
            system.push(force, stiffness);
        }
        for link in 0..self.links.rest_m.len() {
            let drawn = self.drawn(&found.moved, link);
            let length_m = drawn.norm();
            if length_m < 1e-12 {
                continue;
            }
            let [pull_n, growth, _] = self.strain(link, length_m);
            let along = drawn / length_m;
            let axial = along * along.transpose();
            let stiffness = axial * growth + (Matrix2::identity() - axial) * (pull_n / length_m);
            system.couple(link, along * pull_n, stiffness);
        }
    }

    /// Goes as far along the change as the energy falls, and no node farther than the longest link: the pull of the reel
    /// does not grow with the length of its link, so almost nothing else bounds a change without friction. Returns the
    /// largest displacement of the change.
    fn advance(&self, found: &mut Solution, change: &[Vector]) -> f64 {
        let before = found.moved.clone();
        let energy = self.energy(found, &before);
        let far_m = change.iter().map(Vector::norm).fold(0.0, f64::max);
        let most_m = self.links.rest_m.iter().copied().fold(0.0, f64::max);
        let mut share = if far_m > most_m { most_m / far_m } else { 1.0 };
        for _ in 0..MOST_HALVINGS {
            for (node, change) in change.iter().enumerate() {
                found.moved[node + 1] = before[node + 1] + change * share;
            }
            if self.energy(found, &found.moved) <= energy + 1e-12 * energy.abs() {
                break;
            }
            share *= 0.5;
        }
        share * far_m
    }

    fn energy(&self, found: &Solution, moved: &[Vector]) -> f64 {
        let of_node = |node: usize| {
            let way_m = moved[node].norm();
            let rubbing = self.friction_n(found, node) * way_m.hypot(REST_M);
            let pressing = found.touches[node].map_or(0.0, |touch| {
                let gap_m = touch.gap_at_m(self.end(moved, node)).min(0.0);
                0.5 * self.surface_stiffness(node) * gap_m * gap_m
            });
            rubbing + 0.5 * VISCOUS * self.share_m(node) * way_m * way_m + pressing
        };
        let of_nodes: f64 = (1..moved.len() - 1).map(of_node).sum();
        let of_links =
            (0..self.links.rest_m.len()).map(|link| self.strain(link, self.drawn(moved, link).norm())[2]);
        of_nodes + of_links.sum::<f64>()
    }

    /// Places the surfaces near the ends of the nodes' ways.
    fn touch(&self, found: &mut Solution) {
        let reach_m = REACH_M.max(self.links.rest_m[0]);
        let touch = |node: usize| self.surfaces.touch(self.end(&found.moved, node), reach_m);
        found.touches = (0..self.links.nodes.len()).map(touch).collect();
    }

    /// Updates the friction of the surfaces.
    fn grip(&self, found: &mut Solution) {
        for node in 1..self.links.nodes.len() - 1 {
            let gap_m = found.touches[node].map_or(0.0, |touch| touch.gap_at_m(self.end(&found.moved, node)));
            let press_n = self.surface_stiffness(node) * (-gap_m).max(0.0);
            found.grip_n[node] = self.coefficient_at(found, node) * press_n;
        }
    }

    /// The coefficient of friction at a node on a surface, so that the pull grows there as round a smooth curve.
    fn coefficient_at(&self, found: &Solution, node: usize) -> f64 {
        let Some(touch) = found.touches[node] else { return self.law.friction };
        let along = |drawn: Vector| direction_or(drawn, Vector::zeros());
        let to_robot = -along(self.drawn(&found.moved, node - 1));
        let to_reel = along(self.drawn(&found.moved, node));
        let moved = found.moved[node];
        let (ahead, behind) = if moved.dot(&to_robot) > moved.dot(&to_reel) {
            (to_robot, to_reel)
        } else {
            (to_reel, to_robot)
        };
        let dips_rad = [ahead, behind].map(|link| (-link.dot(&touch.away)).clamp(-1.0, 1.0).asin());
        friction_at_turn(self.law.friction, dips_rad)
    }

    /// Sets the pulls and the feed that follow from the displacements.
    fn pull(&self, found: &mut Solution) {
        let last = self.links.rest_m.len() - 1;
        found.pull_n.clear();
        for link in 0..=last {
            let length_m = self.drawn(&found.moved, link).norm();
            found.pull_n.push(self.strain(link, length_m)[0]);
        }
        let (rest_m, length_m) = (self.links.rest_m[last], self.drawn(&found.moved, last).norm());
        found.feed_m = self.feed.at(self.stiffness(rest_m), length_m - rest_m);
    }
}

/// The coefficient of friction at a node whose links dip below the plane of the surface by these angles, radians, ahead and
/// behind in the direction in which the cable slides.
///
/// The links press with N = T sin a + S sin b, T ahead and S behind, and the node slides when T cos a - S cos b exceeds c N.
/// So the pull grows by T / S = (cos b + c sin b) / (cos a - c sin a). This equals E = e^(f (a + b)), the capstan equation with
/// the coefficient f, for c = (E cos a - cos b) / (sin b + E sin a). With f itself, a turn of 50 degrees at one node multiplied
/// the pull by 2.7 instead of 2.4 at f = 1. Where c would be larger than f, the links behind would be jammed; then it is f.
fn friction_at_turn(friction: f64, [ahead_rad, behind_rad]: [f64; 2]) -> f64 {
    let grows = (friction * (ahead_rad + behind_rad)).exp();
    let presses = behind_rad.sin() + grows * ahead_rad.sin();
    if presses < LITTLE_TURN {
        return friction;
    }
    ((grows * ahead_rad.cos() - behind_rad.cos()) / presses).clamp(0.0, friction)
}

/// Force, stiffness and energy of a spring.
pub(crate) fn spring(stiffness: f64, longer_m: f64) -> [f64; 3] {
    [stiffness * longer_m, stiffness, 0.5 * stiffness * longer_m * longer_m]
}
