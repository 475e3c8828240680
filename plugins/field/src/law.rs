//! A force law with its gains, and the forces it gives at a position.

use crate::laws::{self, PushForm};
use geometry::{Point, Vector};
use steering::{Contact, Forces, Side, Source};

/// The form of repulsion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Repulsion {
    /// Khatib's repulsion.
    Classic,
    /// Weighted by the distance to the goal, with a component towards the goal (Ge and Cui 2000).
    Improved {
        /// Power of the distance to the goal.
        exponent: f64,
    },
    /// Weighted by the distance to the goal, without a component towards the goal; one interpretation of Wang et al.
    /// 2023.
    Scaled {
        /// Power of the distance to the goal.
        exponent: f64,
    },
}

/// The forces that act together with an active rotating force or sideways push.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    /// Pull and push, as in the text of Wang et al. 2023.
    All,
    /// Only the pull: the push of obstacles is replaced.
    Pull,
    /// Nothing: pull and push are both replaced.
    Nothing,
}

/// The form of the rotating force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotationForm {
    /// Wang et al. 2023, eq. 3, with its jump at the range.
    Literal,
    /// Our form, without the jump.
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
    /// Push of the wall, as a share of `k_rep`, within half of `rho_0_m`; the papers have no wall.
    pub wall_gain: f64,
    /// The form of repulsion.
    pub repulsion: Repulsion,
    /// How the push decreases with distance.
    pub form: PushForm,
    /// Whether only the nearest obstacle pushes, instead of all in range.
    pub nearest_only: bool,
    /// The form of the rotating force.
    pub rotation: RotationForm,
    /// The forces that act together with the rotating force.
    pub beside: Beside,
}

impl Law {
    /// The forces on a robot at `at` bound for `goal`.
    ///
    /// For each contact, `side` returns the side on which the rotating force leads past it, or `None` if the force does
    /// not act.
    pub fn forces(
        &self,
        at: Point,
        goal: Point,
        contacts: &[Contact],
        mut side: impl FnMut(&Contact) -> Option<Side>,
    ) -> Forces {
        let mut forces = Forces { attraction: laws::attraction(self.k_att, at, goal), ..Forces::default() };
        let pushing = self.nearest_only.then(|| nearest_obstacle(contacts)).flatten();
        let pushes = |contact: &Contact| {
            contact.source == Source::Wall || pushing.is_none_or(|nearest| nearest.source == contact.source)
        };
        for contact in contacts {
            if pushes(contact) {
                forces.repulsion += self.push(contact, goal - at);
            }
            forces.rotation += side(contact).map_or_else(Vector::zeros, |side| self.turn(contact, side));
        }
        self.beside.left_of(forces, forces.rotation != Vector::zeros())
    }

    /// The distance within which a contact acts, metres.
    pub fn reach_m(&self, source: Source) -> f64 {
        if source == Source::Wall { self.rho_0_m / 2.0 } else { self.rho_0_m }
    }

    fn push(&self, contact: &Contact, to_goal: Vector) -> Vector {
        let share = if contact.source == Source::Wall { self.wall_gain } else { 1.0 };
        let (gain, reach_m) = (self.k_rep * share, self.reach_m(contact.source));
        match self.repulsion {
            _ if contact.source == Source::Wall => laws::repulsion(gain, reach_m, contact),
            Repulsion::Classic => self.form.repulsion(gain, reach_m, contact),
            Repulsion::Scaled { exponent } => {
                self.form.repulsion(gain, reach_m, contact) * to_goal.norm().powf(exponent)
            }
            Repulsion::Improved { exponent } => {
                laws::improved_repulsion(self.form, gain, reach_m, exponent, contact, to_goal)
            }
        }
    }

    fn turn(&self, contact: &Contact, side: Side) -> Vector {
        match self.rotation {
            RotationForm::Literal => laws::rotation(self.k_rot, self.rho_0_m, side, contact),
            RotationForm::Smooth => laws::smooth_rotation(self.k_rot, self.rho_0_m, side, contact),
        }
    }
}

impl Beside {
    /// The forces without those that are replaced while the rotating force or the sideways push acts.
    pub(crate) fn left_of(self, forces: Forces, acts: bool) -> Forces {
        if !acts {
            return forces;
        }
        match self {
            Self::All => forces,
            Self::Pull => Forces { repulsion: Vector::zeros(), ..forces },
            Self::Nothing => Forces { rotation: forces.rotation, ..Forces::default() },
        }
    }
}

/// The nearest contact that is not the wall.
pub(crate) fn nearest_obstacle(contacts: &[Contact]) -> Option<&Contact> {
    let obstacles = contacts.iter().filter(|contact| contact.source != Source::Wall);
    obstacles.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A plain law for tests.
    pub(crate) const LAW: Law = Law {
        k_att: 1.0,
        k_rep: 1.0,
        k_rot: 0.0,
        rho_0_m: 1.0,
        wall_gain: 0.0,
        repulsion: Repulsion::Classic,
        form: PushForm::Khatib,
        nearest_only: false,
        rotation: RotationForm::Smooth,
        beside: Beside::All,
    };

    fn contact(id: u32, distance_m: f64, away: Vector) -> Contact {
        Contact { source: Source::Obstacle(id), distance_m, away }
    }

    fn forces(law: &Law, contacts: &[Contact]) -> Forces {
        law.forces(Point::origin(), Point::new(0.0, 4.0), contacts, |_| Some(Side::Right))
    }

    #[test]
    fn of_the_nearest_obstacle_alone_the_others_do_not_push() {
        let contacts = [contact(1, 0.5, Vector::x()), contact(2, 0.8, Vector::y())];
        let law = Law { nearest_only: true, ..LAW };
        assert_eq!(forces(&law, &contacts).repulsion, forces(&LAW, &contacts[..1]).repulsion);
        assert!(forces(&LAW, &contacts).repulsion.y > 0.0);
    }

    #[test]
    fn a_scaled_push_is_the_classic_one_times_a_power_of_the_way_left() {
        let contacts = [contact(1, 0.5, Vector::x())];
        let law = Law { repulsion: Repulsion::Scaled { exponent: 0.5 }, form: PushForm::Inverse, ..LAW };
        let push = forces(&law, &contacts).repulsion;
        assert!((push - Vector::new(1.0 * 2.0, 0.0)).norm() < 1e-12, "{push}");
    }

    #[test]
    fn a_rotating_force_replaces_what_it_is_told_to() {
        let contacts = [contact(1, 0.5, Vector::x())];
        let beside = |beside| forces(&Law { k_rot: 1.0, beside, ..LAW }, &contacts);
        let all = beside(Beside::All);
        assert!(all.rotation.norm() > 0.0 && all.repulsion.norm() > 0.0);
        assert_eq!(beside(Beside::Pull), Forces { repulsion: Vector::zeros(), ..all });
        assert_eq!(beside(Beside::Nothing), Forces { rotation: all.rotation, ..Forces::default() });
        // Without the rotating force, everything acts.
        let still = forces(&Law { beside: Beside::Nothing, ..LAW }, &contacts);
        assert_eq!(still, forces(&LAW, &contacts));
    }
}
