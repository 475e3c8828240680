//! The force laws as pure functions, each with its source. Forces are newtons in name only: the planners use their
//! direction, so scaling all gains together changes nothing.

use geometry::{Point, Vector, direction_or};
use steering::{Contact, Side};

/// Smallest distance by which a law divides, metres. A preset point may coincide with an obstacle, and the laws are
/// singular there.
pub const FLOOR_M: f64 = 1e-6;

/// Pull of a quadratic well, `k_att * rho(q, g)` towards the goal (Khatib 1986; Wang et al. 2023, section 2.1).
pub fn attraction(k_att: f64, at: Point, goal: Point) -> Vector {
    (goal - at) * k_att
}

/// Khatib's repulsion `k_rep (1/rho - 1/rho_0) / rho^2` away from the outline; zero from `rho_0` on.
pub fn repulsion(k_rep: f64, rho_0_m: f64, contact: &Contact) -> Vector {
    PushForm::Khatib.repulsion(k_rep, rho_0_m, contact)
}

/// How repulsion decreases with the distance from an obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PushForm {
    /// Khatib's `(1/rho - 1/rho_0) / rho^2`.
    Khatib,
    /// `1/rho - 1/rho_0`: one interpretation of Wang et al. 2023, who do not print the formula.
    Inverse,
    /// `1/rho`, which ends at `rho_0` with a jump: eq. 8 of Xu et al. 2022. The paper gives no range and, according to
    /// its eq. 9, the force points towards the obstacle; here it points away.
    Hyperbola,
}

impl PushForm {
    /// The size of the force at a distance, for a gain of one; zero from `rho_0` on.
    fn strength(self, rho_0_m: f64, distance_m: f64) -> f64 {
        match self {
            Self::Khatib => khatib(rho_0_m, distance_m),
            Self::Inverse => inverse_gap(rho_0_m, distance_m),
            Self::Hyperbola if distance_m < rho_0_m => 1.0 / distance_m.max(FLOOR_M),
            Self::Hyperbola => 0.0,
        }
    }

    /// The push away from the outline, for a given gain.
    pub fn repulsion(self, k_rep: f64, rho_0_m: f64, contact: &Contact) -> Vector {
        contact.away * (k_rep * self.strength(rho_0_m, contact.distance_m))
    }
}

/// Repulsion weighted by the distance to the goal, so that a goal beside an obstacle can be reached (GNRON, Ge and
/// Cui 2000): `k_rep (1/rho - 1/rho_0) rho_g^n / rho^2` away from the outline plus `n/2 k_rep (1/rho - 1/rho_0)^2
/// rho_g^(n-1)` towards the goal. Wang et al. 2023 give no `n`; two is the textbook value. `form` states how the first
/// part decreases with `rho`.
pub fn improved_repulsion(
    form: PushForm,
    k_rep: f64,
    rho_0_m: f64,
    exponent: f64,
    contact: &Contact,
    to_goal: Vector,
) -> Vector {
    let goal_m = to_goal.norm();
    let away = contact.away * (k_rep * form.strength(rho_0_m, contact.distance_m) * goal_m.powf(exponent));
    let gap = inverse_gap(rho_0_m, contact.distance_m);
    let pull = exponent / 2.0 * k_rep * gap * gap * goal_m.max(FLOOR_M).powf(exponent - 1.0);
    away + direction_or(to_goal, Vector::zeros()) * pull
}

/// The rotating force of Wang et al. 2023, eq. 3: `k_rot rho_0 / rho` along the tangent. The paper's direction,
/// counter-clockwise, passes on the right.
///
/// At `rho_0`, the force jumps from `k_rot` to zero.
pub fn rotation(k_rot: f64, rho_0_m: f64, side: Side, contact: &Contact) -> Vector {
    let within = contact.distance_m < rho_0_m;
    let strength = if within { k_rot * rho_0_m / contact.distance_m.max(FLOOR_M) } else { 0.0 };
    side.along(contact.away) * strength
}

/// The rotating force without its jump: `k_rot (rho_0 / rho - 1)` along the tangent, our form.
pub fn smooth_rotation(k_rot: f64, rho_0_m: f64, side: Side, contact: &Contact) -> Vector {
    side.along(contact.away) * (k_rot * rho_0_m * inverse_gap(rho_0_m, contact.distance_m))
}

/// `(1/rho - 1/rho_0) / rho^2`, zero from `rho_0` on.
fn khatib(rho_0_m: f64, distance_m: f64) -> f64 {
    let rho = distance_m.max(FLOOR_M);
    inverse_gap(rho_0_m, distance_m) / (rho * rho)
}

/// `1/rho - 1/rho_0`, zero from `rho_0` on.
fn inverse_gap(rho_0_m: f64, distance_m: f64) -> f64 {
    if distance_m < rho_0_m { 1.0 / distance_m.max(FLOOR_M) - 1.0 / rho_0_m } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use steering::Source;

    fn east_of_it(distance_m: f64) -> Contact {
        Contact { source: Source::Obstacle(0), distance_m, away: Vector::x() }
    }

    #[test]
    fn khatibs_force_has_the_value_of_its_formula() {
        let force = repulsion(200.0, 1.0, &east_of_it(0.5));
        assert!((force - Vector::new(200.0 * (2.0 - 1.0) / 0.25, 0.0)).norm() < 1e-9);
        assert_eq!(repulsion(200.0, 1.0, &east_of_it(1.0)), Vector::zeros());
    }

    #[test]
    fn the_inverse_form_falls_with_the_first_power() {
        let force = PushForm::Inverse.repulsion(100.0, 1.0, &east_of_it(0.5));
        assert!((force - Vector::new(100.0 * (2.0 - 1.0), 0.0)).norm() < 1e-9);
        assert_eq!(PushForm::Inverse.repulsion(100.0, 1.0, &east_of_it(1.0)), Vector::zeros());
        let plain = PushForm::Hyperbola.repulsion(100.0, 1.0, &east_of_it(0.5));
        assert!((plain - Vector::new(200.0, 0.0)).norm() < 1e-9);
        assert_eq!(PushForm::Hyperbola.repulsion(100.0, 1.0, &east_of_it(1.0)), Vector::zeros());
    }

    #[test]
    fn the_improved_force_vanishes_at_the_goal_and_pulls_toward_it() {
        assert!(
            improved_repulsion(PushForm::Khatib, 1.0, 1.0, 2.0, &east_of_it(0.5), Vector::zeros()).norm()
                < 1e-9
        );
        let force =
            improved_repulsion(PushForm::Khatib, 1.0, 1.0, 2.0, &east_of_it(0.5), Vector::new(0.0, 2.0));
        assert!((force - Vector::new(16.0, 2.0)).norm() < 1e-9);
    }

    #[test]
    fn the_printed_rotation_jumps_at_its_range_and_the_smooth_one_does_not() {
        let (inside, outside) = (east_of_it(1.0 - 1e-9), east_of_it(1.0));
        let turn = |law: fn(f64, f64, Side, &Contact) -> Vector, contact: &Contact| {
            law(3.0, 1.0, Side::Right, contact)
        };
        assert!((turn(rotation, &inside) - Vector::new(0.0, 3.0)).norm() < 1e-6);
        assert!(turn(smooth_rotation, &inside).norm() < 1e-6);
        assert_eq!((turn(rotation, &outside), turn(smooth_rotation, &outside)), Default::default());
    }

    proptest! {
        #[test]
        fn no_law_gives_anything_but_numbers(
            distance in prop_oneof![-5.0..5.0_f64, Just(0.0), Just(1e-300), Just(-0.0)],
            goal in prop_oneof![(-50.0..50.0_f64, -50.0..50.0_f64), Just((0.0, 0.0))],
            exponent in 0.0..4.0_f64,
        ) {
            let contact = east_of_it(distance);
            let to_goal = Vector::new(goal.0, goal.1);
            for force in [
                attraction(1e3, Point::origin(), Point::from(to_goal)),
                repulsion(1e3, 0.05, &contact),
                improved_repulsion(PushForm::Khatib, 1e3, 0.05, exponent, &contact, to_goal),
                improved_repulsion(PushForm::Inverse, 1e3, 0.05, exponent, &contact, to_goal),
                PushForm::Inverse.repulsion(1e3, 0.05, &contact),
                rotation(1e3, 5.0, Side::Left, &contact),
                smooth_rotation(1e3, 5.0, Side::Left, &contact),
            ] {
                prop_assert!(force.x.is_finite() && force.y.is_finite());
            }
        }
    }
}
