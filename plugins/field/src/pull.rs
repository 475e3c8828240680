//! The pull of a goal: linear, logarithmic, or capped.

use geometry::{Point, Vector};
use std::f64::consts::LN_2;

/// Minimum distance from the goal at which the laws are evaluated, metres; they are singular at the goal itself.
const FLOOR_M: f64 = 1e-9;

/// The interpretation of the logarithmic pull near the goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NearLaw {
    /// `n log2(1/rho + 1)`: grows without bound towards the goal, as the text of Xu et al. claims.
    Corrected,
    /// `n |log2(1 / (rho + 1))|`, as printed: vanishes at the goal, so an obstacle beside the goal pushes the robot
    /// away.
    Printed,
}

/// A law of attraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pull {
    /// `k rho` (Khatib 1986).
    Linear {
        /// Force per metre.
        k: f64,
    },
    /// `m log_k(rho + 1)` far from the goal and a different logarithm near it (Xu et al. 2022, eq. 4).
    Logarithm {
        /// Force at the start.
        m: f64,
        /// Distance from start to goal, metres.
        trip_m: f64,
        /// The base of the logarithm. `None`: the trip distance plus one, so that the force starts at `m` and falls.
        k: Option<f64>,
        /// Gain of the near law, newtons. `None`: chosen so that the two laws meet.
        n: Option<f64>,
        /// Distance from the goal below which the near law applies, metres.
        rho_1_m: f64,
        /// The form of the near law.
        near: NearLaw,
    },
    /// `k rho`, but never more than `k d_0` (Yang et al. 2021, eq. 17 with its third case read as a constant force).
    Capped {
        /// Force per metre.
        k: f64,
        /// Distance beyond which the force no longer grows, metres.
        d_0_m: f64,
    },
}

impl Pull {
    /// The pull of a goal on a robot.
    pub fn force(&self, at: Point, goal: Point) -> Vector {
        let way = goal - at;
        let rho = way.norm().max(FLOOR_M);
        way / rho * self.strength(rho)
    }

    /// The size of the pull at a distance from the goal.
    pub fn strength(&self, rho_m: f64) -> f64 {
        let rho = rho_m.max(FLOOR_M);
        match *self {
            Self::Linear { k } => k * rho,
            Self::Capped { k, d_0_m } => k * rho.min(d_0_m),
            Self::Logarithm { m, trip_m, k, n, rho_1_m, near } => {
                let base_ln = k.map_or_else(|| trip_m.max(FLOOR_M).ln_1p(), f64::ln);
                let far = |rho: f64| m * rho.ln_1p() / base_ln;
                match n {
                    _ if rho > rho_1_m => far(rho),
                    Some(n) => n * near.logarithm(rho),
                    None => far(rho_1_m) * near.share(rho, rho_1_m),
                }
            }
        }
    }
}

impl NearLaw {
    /// Force for a gain of one.
    fn logarithm(self, rho: f64) -> f64 {
        match self {
            Self::Corrected => (1.0 / rho).ln_1p() / LN_2,
            Self::Printed => rho.ln_1p() / LN_2,
        }
    }

    /// The force at `rho` as a multiple of the force at `rho_1`, where the two branches meet.
    fn share(self, rho: f64, rho_1: f64) -> f64 {
        match self {
            Self::Corrected => (1.0 / rho).ln_1p() / (1.0 / rho_1).ln_1p(),
            Self::Printed => rho.ln_1p() / rho_1.ln_1p(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn logarithm(near: NearLaw) -> Pull {
        Pull::Logarithm { m: 10.0, trip_m: 50.0, k: None, n: None, rho_1_m: 1.0, near }
    }

    #[test]
    fn the_logarithm_falls_from_its_gain_on_the_way_and_its_branches_meet() {
        for near in [NearLaw::Corrected, NearLaw::Printed] {
            let pull = logarithm(near);
            assert!((pull.strength(50.0) - 10.0).abs() < 1e-12);
            assert!((pull.strength(1.0 + 1e-9) - pull.strength(1.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn at_the_goal_the_corrected_law_grows_and_the_printed_one_vanishes() {
        assert!(logarithm(NearLaw::Corrected).strength(1e-3) > 10.0);
        assert!(logarithm(NearLaw::Printed).strength(1e-3) < 1e-2);
    }

    #[test]
    fn base_and_near_gain_can_be_set() {
        let pull =
            |k, n| Pull::Logarithm { m: 10.0, trip_m: 50.0, k, n, rho_1_m: 1.0, near: NearLaw::Printed };
        assert!((pull(Some(4.0), None).strength(15.0) - 20.0).abs() < 1e-12);
        // n |log2(1 / (rho + 1))| at rho 1.
        assert!((pull(None, Some(16.0)).strength(1.0) - 16.0).abs() < 1e-12);
        let far = |n| pull(None, n).strength(2.0);
        assert!((far(Some(16.0)) - far(None)).abs() < 1e-12);
    }

    #[test]
    fn a_capped_pull_is_linear_up_to_its_cap_and_finite_everywhere() {
        let pull = Pull::Capped { k: 15.0, d_0_m: 3.0 };
        assert!((pull.force(Point::origin(), Point::new(0.0, 2.0)) - Vector::new(0.0, 30.0)).norm() < 1e-9);
        assert!((pull.strength(100.0) - 45.0).abs() < 1e-12);
        assert!(pull.force(Point::origin(), Point::origin()).norm() < 1e-6);
    }
}
