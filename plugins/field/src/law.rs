//! A law with its gains, and the forces it gives at a place.

use crate::laws;
use geometry::{Point, Vector};
use steering::{Contact, Forces, Side, Source};

/// Which repulsion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Repulsion {
    /// Khatib's.
    Classic,
    /// Weighted with the distance to the goal.
    Improved {
        /// Power of that distance.
        exponent: f64,
    },
}

/// Which rotating force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotationForm {
    /// Wang et al. 2023, eq. 3, with its jump at the range.
    Literal,
    /// Ours, without the jump.
    Smooth,
}

/// Gains and ranges of a potential field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Gain of the pull.
    pub k_att: f64,
    /// Gain of the push.
    pub k_rep: f64,
    /// Gain of the rotating force.
    pub k_rot: f64,
    /// Distance at which obstacles begin to act, metres.
    pub rho_0_m: f64,
    /// The wall pushes with this share of `k_rep`, from half of `rho_0_m` on; the papers have no wall.
    pub wall_gain: f64,
    /// Which repulsion.
    pub repulsion: Repulsion,
    /// Which rotating force.
    pub rotation: RotationForm,
}

impl Law {
    /// The forces on a robot at `at` that is bound for `goal`.
    ///
    /// `side` says for each contact whether the rotating force acts, and on which side it leads past.
    pub fn forces(
        &self,
        at: Point,
        goal: Point,
        contacts: &[Contact],
        mut side: impl FnMut(&Contact) -> Option<Side>,
    ) -> Forces {
        let mut forces = Forces { attraction: laws::attraction(self.k_att, at, goal), ..Forces::default() };
        for contact in contacts {
            forces.repulsion += self.push(contact, goal - at);
            forces.rotation += side(contact).map_or_else(Vector::zeros, |side| self.turn(contact, side));
        }
        forces
    }

    /// How far a contact acts, metres.
    pub fn reach_m(&self, source: Source) -> f64 {
        if source == Source::Wall { self.rho_0_m / 2.0 } else { self.rho_0_m }
    }

    fn push(&self, contact: &Contact, to_goal: Vector) -> Vector {
        let share = if contact.source == Source::Wall { self.wall_gain } else { 1.0 };
        let (gain, reach_m) = (self.k_rep * share, self.reach_m(contact.source));
        match self.repulsion {
            Repulsion::Improved { exponent } if contact.source != Source::Wall => {
                laws::improved_repulsion(gain, reach_m, exponent, contact, to_goal)
            }
            _ => laws::repulsion(gain, reach_m, contact),
        }
    }

    fn turn(&self, contact: &Contact, side: Side) -> Vector {
        match self.rotation {
            RotationForm::Literal => laws::rotation(self.k_rot, self.rho_0_m, side, contact),
            RotationForm::Smooth => laws::smooth_rotation(self.k_rot, self.rho_0_m, side, contact),
        }
    }
}
