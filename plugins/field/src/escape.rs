//! Escapes from a trap that add a force for a while: a virtual target, or a sideways push.
//!
//! Wang et al. 2023 compare their method with both escapes, but hardly describe them. The positions, gains and
//! durations here are our reconstruction, so the results of these planners are not evidence about the original methods.

use crate::law::{Law, nearest_obstacle};
use geometry::{Point, Vector};
use steering::{Contact, Forces};

/// Number of moves after which a virtual target is given up.
const TARGET_MOVES: usize = 25;
/// Distance of the virtual target from the obstacle, as a share of the obstacle range.
const TARGET_OFF: f64 = 0.7;
/// Pull of the virtual target, as a multiple of the pull of a target at the obstacle range.
const TARGET_PULL: f64 = 3.0;
/// Duration of a held push, moves.
const PUSH_MOVES: usize = 5;
/// Component of a held push across the path, as a multiple of the target's pull.
const PUSH: f64 = 2.0;
/// Component of a held push towards the target, as a share of the component across the path.
const PUSH_AHEAD: f64 = 0.5;
/// Strength of a half-pull push, as a multiple of the target's pull.
const HALF: f64 = 0.5;
/// Seed for the random sides; every plan and every flight starts with it.
const FIRST_RANDOM: u64 = 0x9e37_79b9_7f4a_7c15;

/// The response to a trap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Escape {
    /// No response.
    None,
    /// A target beside the nearest obstacle, on the obstacle's side that faces the path, after Yang 2018.
    VirtualTarget,
    /// A sideways push, after Zhao 2022. The side is chosen again in every trap, so it may alternate.
    Push {
        /// Strength and duration of the push.
        strength: PushStrength,
        /// Side of the push.
        side: PushSide,
    },
}

/// The strength of a sideways push.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PushStrength {
    /// Twice the pull of the target across the path to it, and half as much towards the target, for five moves; our
    /// choice.
    Held,
    /// Half the pull of the target, across the path to it, for one move.
    HalfPull,
    /// As strong as the pull of the target, across the path to it, for one move.
    Pull,
    /// The pull of a target one metre away, across the path to it, for one move.
    UnitPull,
}

/// The side of the push, as seen towards the target; Wang et al. 2023 do not specify it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PushSide {
    /// The side to which obstacles push.
    Repulsion,
    /// The right.
    Right,
    /// Random; every plan and every flight uses the same sequence from its start.
    Random,
    /// The opposite of the last side.
    Alternating,
}

/// The escape in progress, if any.
#[derive(Debug, Clone)]
pub struct Escaping {
    rule: Escape,
    target: Option<Point>,
    side: f64,
    random: u64,
    left: usize,
}

/// The situation before a move.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// The robot's position.
    pub at: Point,
    /// The goal of the move.
    pub goal: Point,
    /// The contacts that act on the robot.
    pub contacts: &'a [Contact],
    /// The law that applies.
    pub law: &'a Law,
    /// Length of a move, metres.
    pub step_m: f64,
}

impl Escaping {
    /// Creates the state without an escape in progress.
    pub fn new(rule: Escape) -> Self {
        Self { rule, target: None, side: 1.0, random: FIRST_RANDOM, left: 0 }
    }

    /// Takes the situation before the next move, and whether the robot is trapped. Returns the force to add.
    pub fn update(&mut self, now: &Situation<'_>, is_trapped: bool) -> Vector {
        let Some(ahead) = (now.goal - now.at).try_normalize(1e-9) else { return Vector::zeros() };
        match self.rule {
            Escape::None => Vector::zeros(),
            Escape::VirtualTarget => self.toward_target(now, ahead, is_trapped),
            Escape::Push { strength, side } => self.push(now, ahead, is_trapped.then_some(side), strength),
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

    /// The push of this move. A new trap selects its side.
    fn push(
        &mut self,
        now: &Situation<'_>,
        ahead: Vector,
        trap: Option<PushSide>,
        strength: PushStrength,
    ) -> Vector {
        let left = Vector::new(-ahead.y, ahead.x);
        if let Some(rule) = trap {
            self.side = self.chosen(rule, now, left);
            self.left = if strength == PushStrength::Held { PUSH_MOVES } else { 1 };
        }
        if self.left == 0 {
            return Vector::zeros();
        }
        self.left -= 1;
        let (k_att, goal_m) = (now.law.k_att, (now.goal - now.at).norm());
        match strength {
            PushStrength::Held => {
                (left * self.side + ahead * PUSH_AHEAD) * (PUSH * k_att * goal_m.max(now.law.rho_0_m))
            }
            PushStrength::HalfPull => left * (self.side * HALF * k_att * goal_m),
            PushStrength::Pull => left * (self.side * k_att * goal_m),
            PushStrength::UnitPull => left * (self.side * k_att),
        }
    }

    /// The side of the push: 1 for left, -1 for right.
    fn chosen(&mut self, rule: PushSide, now: &Situation<'_>, left: Vector) -> f64 {
        let is_left = match rule {
            PushSide::Repulsion => now.without_rotation().repulsion.dot(&left) >= 0.0,
            PushSide::Right => false,
            PushSide::Alternating => self.side < 0.0,
            PushSide::Random => {
                // Marsaglia's xorshift.
                self.random ^= self.random << 13;
                self.random ^= self.random >> 7;
                self.random ^= self.random << 17;
                self.random >> 63 == 1
            }
        };
        if is_left { 1.0 } else { -1.0 }
    }
}

impl Situation<'_> {
    /// Pull and push without the rotating force.
    pub fn without_rotation(&self) -> Forces {
        self.law.forces(self.at, self.goal, self.contacts, |_| None)
    }
}

fn beside_nearest(now: &Situation<'_>, ahead: Vector) -> Option<Point> {
    let nearest = nearest_obstacle(now.contacts)?;
    let obstacle = now.at - nearest.away * nearest.distance_m;
    let lies_left = ahead.perp(&(obstacle - now.at)) > 0.0;
    let left = Vector::new(-ahead.y, ahead.x);
    let aside = if lies_left { -left } else { left };
    Some(obstacle + aside * (TARGET_OFF * now.law.rho_0_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::tests::LAW;
    use steering::Source;

    const HELD: Escape = Escape::Push { strength: PushStrength::Held, side: PushSide::Repulsion };

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
        let mut escaping = Escaping::new(HELD);
        let push = escaping.update(&situation(&[contact()]), true);
        assert!((push - Vector::new(2.0, -4.0)).norm() < 1e-9);
        let pushed = (0..9).filter(|_| escaping.update(&situation(&[contact()]), false).norm() > 0.0);
        assert_eq!(pushed.count(), PUSH_MOVES - 1);
    }

    /// The pushes of five moves that are all traps.
    fn pushes(strength: PushStrength, side: PushSide) -> [Vector; 5] {
        let mut escaping = Escaping::new(Escape::Push { strength, side });
        [(); 5].map(|()| escaping.update(&situation(&[contact()]), true))
    }

    #[test]
    fn a_push_of_one_move_goes_across_the_way_and_ends_with_the_trap() {
        let half = pushes(PushStrength::HalfPull, PushSide::Right)[0];
        assert!((half - Vector::new(0.0, -1.0)).norm() < 1e-9);
        let unit = pushes(PushStrength::UnitPull, PushSide::Alternating);
        assert!(unit.iter().zip([-1.0, 1.0, -1.0, 1.0, -1.0]).all(|(push, y)| (push.y - y).abs() < 1e-9));
        let mut escaping =
            Escaping::new(Escape::Push { strength: PushStrength::UnitPull, side: PushSide::Right });
        escaping.update(&situation(&[contact()]), true);
        assert_eq!(escaping.update(&situation(&[contact()]), false), Vector::zeros());
    }

    #[test]
    fn random_sides_differ_and_are_the_same_in_every_plan() {
        let random = || pushes(PushStrength::UnitPull, PushSide::Random);
        assert_eq!(random(), random());
        assert!(random().iter().any(|push| push.y > 0.0) && random().iter().any(|push| push.y < 0.0));
    }
}
