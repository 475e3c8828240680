//! The field of the goal planners: a pull, Khatib's push, and a tangent force around obstacles in the way.

use crate::{
    laws::{self, PushForm},
    pull::Pull,
};
use geometry::{Point, Vector};
use steering::{Contact, Forces, KnownMap, Nearby, Side, wall_contacts};

/// Smallest distance by which repulsion divides, metres.
const CLOSEST_M: f64 = 1e-2;
/// Smallest distance by which the tangent force divides, metres.
const SHORTEST_M: f64 = 0.3;

/// When the tangent force acts (Xu et al. 2022 do not specify it).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentUse {
    /// Never.
    Off,
    /// Always, towards the left tangent of every obstacle in range. Of the variants tried, only with this one does the
    /// robot stop where the paper says: with a weight of 0.02 and an obstacle of 1 m radius, or with full weight and an
    /// obstacle of 3.2 to 3.55 m radius.
    Always,
    /// Around whatever blocks the path to the goal; the robot passes on the side away from the centre of the obstacle.
    Blocking,
}

/// Gains and ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalLaw {
    /// The pull of the goal.
    pub pull: Pull,
    /// Gain of push and tangent force; mu or `k_rep` in the papers.
    pub k_rep: f64,
    /// How the push decreases with distance.
    pub push: PushForm,
    /// Distance between hull and outline at which both forces begin, metres.
    pub rho_m: f64,
    /// When the tangent force acts.
    pub tangent: TangentUse,
    /// The weight of the tangent force.
    pub tangent_weight: f64,
    /// Push of the wall as a share of `k_rep`, within half the range; the papers have no wall.
    pub wall_gain: f64,
}

/// The side on which each solid is being passed.
#[derive(Debug, Clone, Default)]
pub struct Sides {
    kept: Vec<(usize, Side)>,
}

impl Sides {
    /// Discards all choices of side.
    pub fn forget(&mut self) {
        self.kept.clear();
    }

    fn of(&mut self, index: usize, choose: impl FnOnce() -> Side) -> Side {
        if let Some((_, side)) = self.kept.iter().find(|(known, _)| *known == index) {
            return *side;
        }
        let side = choose();
        self.kept.push((index, side));
        side
    }

    fn release(&mut self, index: usize) {
        if self.kept.is_empty() {
            return;
        }
        self.kept.retain(|(known, _)| *known != index);
    }
}

impl GoalLaw {
    /// The forces on a robot at `at` bound for `goal`; `nearby` must contain everything within range of the law.
    pub fn forces(
        &self,
        at: Point,
        goal: Point,
        map: &KnownMap,
        nearby: &mut Nearby,
        sides: &mut Sides,
    ) -> Forces {
        let mut forces = Forces { attraction: self.pull.force(at, goal), ..Forces::default() };
        for &index in nearby.update(map, at) {
            let Some(contact) = map.solids[index].contact(at, map.hull_m, self.rho_m) else {
                sides.release(index);
                continue;
            };
            forces.repulsion += self.push.repulsion(self.k_rep, self.rho_m, &not_too_near(contact));
            forces.rotation += self.turn(index, at, goal, map, sides);
        }
        if self.wall_gain > 0.0 && nearby.sees_wall() {
            for contact in wall_contacts(&map.wall, at, map.hull_m, self.rho_m / 2.0) {
                let gain = self.k_rep * self.wall_gain;
                forces.repulsion += laws::repulsion(gain, self.rho_m / 2.0, &not_too_near(contact));
            }
        }
        forces
    }

    fn turn(&self, index: usize, at: Point, goal: Point, map: &KnownMap, sides: &mut Sides) -> Vector {
        let solid = &map.solids[index];
        let side = match self.tangent {
            TangentUse::Off => return Vector::zeros(),
            TangentUse::Always => Side::Left,
            TangentUse::Blocking => {
                let (way, there) = (goal - at, solid.center - at);
                let is_ahead = there.dot(&way) > 0.0;
                if !is_ahead || solid.segment_distance_m(at, goal, map.hull_m) >= map.hull_m {
                    sides.release(index);
                    return Vector::zeros();
                }
                sides.of(index, || if way.perp(&there) > 0.0 { Side::Right } else { Side::Left })
            }
        };
        let tangent = solid.tangent(at, map.hull_m, side);
        tangent.direction * tangent_strength(self.tangent_weight, self.k_rep, tangent.length_m)
    }
}

fn not_too_near(contact: Contact) -> Contact {
    Contact { distance_m: contact.distance_m.max(CLOSEST_M), ..contact }
}

/// Strength of the tangent force, `w mu / L` (Xu et al. 2022, eq. 13); `L` below 0.3 m is taken as 0.3 m.
fn tangent_strength(weight: f64, mu: f64, length_m: f64) -> f64 {
    weight * mu / length_m.max(SHORTEST_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use steering::Solid;

    const LAW: GoalLaw = GoalLaw {
        pull: Pull::Linear { k: 1.0 },
        k_rep: 10.0,
        push: PushForm::Khatib,
        rho_m: 2.0,
        tangent: TangentUse::Blocking,
        tangent_weight: 1.0,
        wall_gain: 0.0,
    };

    fn forces(law: &GoalLaw, disc: (f64, f64, f64)) -> Forces {
        let map = KnownMap {
            solids: vec![Solid::disc(0, Point::new(disc.0, disc.1), disc.2)],
            wall: geometry::Boundary::Circle { radius_m: 50.0 },
            hull_m: 0.3,
        };
        let goal = Point::new(10.0, 0.0);
        law.forces(Point::origin(), goal, &map, &mut Nearby::new(3.0), &mut Sides::default())
    }

    #[test]
    fn what_blocks_is_passed_on_the_side_where_its_middle_is_not() {
        assert!(forces(&LAW, (2.0, 0.2, 0.5)).rotation.y < 0.0);
        assert!(forces(&LAW, (2.0, -0.2, 0.5)).rotation.y > 0.0);
        // A tie goes to the left.
        assert!(forces(&LAW, (2.0, 0.0, 0.5)).rotation.y > 0.0);
        assert_eq!(forces(&LAW, (2.0, 1.0, 0.5)).rotation, Vector::zeros());
        assert_eq!(forces(&LAW, (-2.0, 0.0, 0.5)).rotation, Vector::zeros());
    }

    #[test]
    fn always_on_it_turns_left_about_everything_in_range() {
        let law = GoalLaw { tangent: TangentUse::Always, tangent_weight: 0.02, ..LAW };
        let forces = forces(&law, (0.0, 2.0, 0.5));
        assert!(forces.rotation.norm() > 0.0 && forces.rotation.x < 0.0);
    }

    #[test]
    fn the_push_is_khatibs_from_the_hull() {
        let push = forces(&LAW, (2.0, 0.0, 0.7)).repulsion;
        assert!((push - Vector::new(-10.0 * (1.0 - 0.5), 0.0)).norm() < 1e-9);
    }
}
