//! Ways out of a trap that add a force for a while: a virtual target, or a push to the side.
//!
//! Wang et al. 2023 compare with both by name only; places, gains and times are reconstructed, so figures of these
//! planners are not evidence about the originals.

use crate::law::Law;
use geometry::{Point, Vector};
use steering::{Contact, Source};

/// A virtual target is given up after this many moves.
const TARGET_MOVES: usize = 25;
/// It lies this far from the obstacle, as a share of the range of obstacles.
const TARGET_OFF: f64 = 0.7;
/// Its pull, in pulls of a target as far away as the range of obstacles.
const TARGET_PULL: f64 = 3.0;
/// A push to the side lasts this many moves.
const PUSH_MOVES: usize = 5;
/// Its strength, in pulls of the target.
const PUSH: f64 = 2.0;
/// Its part ahead.
const PUSH_AHEAD: f64 = 0.5;

/// What is done about a trap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Escape {
    /// Nothing.
    None,
    /// A target beside the nearest obstacle, on the side away from it as seen along the way, after Yang 2018.
    VirtualTarget,
    /// A push to the side to which obstacles push, after Zhao 2022; chosen again in every trap, so it may alternate.
    Push,
}

/// An escape under way.
#[derive(Debug, Clone)]
pub struct Escaping {
    rule: Escape,
    target: Option<Point>,
    side: f64,
    left: usize,
}

/// The situation at a move.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// Where the robot is.
    pub at: Point,
    /// Where it is bound.
    pub goal: Point,
    /// What acts on it.
    pub contacts: &'a [Contact],
    /// By which law.
    pub law: &'a Law,
    /// Length of a move, metres.
    pub step_m: f64,
}

impl Escaping {
    /// None under way.
    pub fn new(rule: Escape) -> Self {
        Self { rule, target: None, side: 1.0, left: 0 }
    }

    /// Takes the situation of the next move, and whether it is a trap; returns the force to add.
    pub fn update(&mut self, now: &Situation<'_>, is_trapped: bool) -> Vector {
        let Some(ahead) = (now.goal - now.at).try_normalize(1e-9) else { return Vector::zeros() };
        match self.rule {
            Escape::None => Vector::zeros(),
            Escape::VirtualTarget => self.toward_target(now, ahead, is_trapped),
            Escape::Push => self.push(now, ahead, is_trapped),
        }
    }

    fn toward_target(&mut self, now: &Situation<'_>, ahead: Vector, is_trapped: bool) -> Vector {
        self.left = self.left.saturating_sub(1);
        self.target = self.target.filter(|target| self.left > 0 && (target - now.at).norm() >= now.step_m);
        if self.target.is_none() && is_trapped {
            self.target = beside_nearest(now, ahead);
            self.left = TARGET_MOVES;
        }
        let toward = self.target.and_then(|target| (target - now.at).try_normalize(1e-9));
        toward.map_or_else(Vector::zeros, |toward| toward * (TARGET_PULL * now.law.k_att * now.law.rho_0_m))
    }

    fn push(&mut self, now: &Situation<'_>, ahead: Vector, is_trapped: bool) -> Vector {
        let left = Vector::new(-ahead.y, ahead.x);
        if is_trapped {
            let repulsion = now.law.forces(now.at, now.goal, now.contacts, |_| None).repulsion;
            self.side = if repulsion.dot(&left) >= 0.0 { 1.0 } else { -1.0 };
            self.left = PUSH_MOVES;
        }
        if self.left == 0 {
            return Vector::zeros();
        }
        self.left -= 1;
        let strength = PUSH * now.law.k_att * (now.goal - now.at).norm().max(now.law.rho_0_m);
        (left * self.side + ahead * PUSH_AHEAD) * strength
    }
}

fn beside_nearest(now: &Situation<'_>, ahead: Vector) -> Option<Point> {
    let obstacles = now.contacts.iter().filter(|contact| contact.source != Source::Wall);
    let nearest = obstacles.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))?;
    let obstacle = now.at - nearest.away * nearest.distance_m;
    let lies_left = ahead.perp(&(obstacle - now.at)) > 0.0;
    let left = Vector::new(-ahead.y, ahead.x);
    let aside = if lies_left { -left } else { left };
    Some(obstacle + aside * (TARGET_OFF * now.law.rho_0_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Repulsion, RotationForm};

    const LAW: Law = Law {
        k_att: 1.0,
        k_rep: 1.0,
        k_rot: 0.0,
        rho_0_m: 1.0,
        wall_gain: 0.0,
        repulsion: Repulsion::Classic,
        rotation: RotationForm::Smooth,
    };

    /// An obstacle ahead and a little to the left of a robot that is bound east.
    fn situation(contacts: &[Contact]) -> Situation<'_> {
        let (at, goal) = (Point::origin(), Point::new(2.0, 0.0));
        Situation { at, goal, contacts, law: &LAW, step_m: 0.2 }
    }

    fn contact() -> Contact {
        let away = Vector::new(-0.5, -0.1).normalize();
        Contact { source: Source::Obstacle(1), distance_m: 0.5, away }
    }

    #[test]
    fn a_virtual_target_lies_on_the_free_side_and_is_given_up() {
        let mut escaping = Escaping::new(Escape::VirtualTarget);
        assert_eq!(escaping.update(&situation(&[contact()]), false), Vector::zeros());
        let pull = escaping.update(&situation(&[contact()]), true);
        assert!(pull.y < 0.0 && (pull.norm() - 3.0).abs() < 1e-9);
        let pulled = (0..40).filter(|_| escaping.update(&situation(&[contact()]), false).norm() > 0.0);
        assert_eq!(pulled.count(), TARGET_MOVES - 1);
    }

    #[test]
    fn a_push_goes_where_obstacles_push_and_lasts_five_moves() {
        let mut escaping = Escaping::new(Escape::Push);
        let push = escaping.update(&situation(&[contact()]), true);
        assert!((push - Vector::new(2.0, -4.0)).norm() < 1e-9);
        let pushed = (0..9).filter(|_| escaping.update(&situation(&[contact()]), false).norm() > 0.0);
        assert_eq!(pushed.count(), PUSH_MOVES - 1);
    }
}
