//! The two potential fields that are compared with the rotating field. One escapes from traps by a virtual target, the
//! other by a sideways push.

use crate::potential::{Kind, Potential};
use field::{Escape, FieldSettings, open_points as o, params as p};
use planner_api::{Config, ParamSpec};

/// The list of parameters: those that both fields share, followed by those given.
macro_rules! params {
    ($($own:expr),*) => {
        &[
            p::K_ATT,
            p::K_REP,
            p::RHO_0,
            p::REPULSION_CLASSIC,
            p::EXPONENT,
            o::GATE,
            $($own,)*
            o::PUSH_FORM,
            o::PUSH_OF,
            o::TARGETS,
            o::MOVE_LENGTH,
            p::WALL_GAIN,
            p::STEP,
            p::GOTO_STEP,
            p::FLEXIBLE,
            p::TURN_LIMIT,
            p::MAX_LAG,
            p::GUARD,
            p::GUARD_SIGMAS,
            p::SLOW,
            p::MIN_SHARE,
            p::STUCK,
            p::EVADE,
        ]
    };
}

/// A potential field that escapes from traps by a virtual target beside the obstacle, reconstructed from a description
/// of Yang 2018.
pub type Vt = Potential<VirtualTarget>;

/// A potential field that escapes from traps by a sideways push, reconstructed from a description of Zhao 2022.
pub type Iapf = Potential<Push>;

/// Selects the force law of [`Vt`].
pub enum VirtualTarget {}

/// Selects the force law of [`Iapf`].
pub enum Push {}

impl Kind for VirtualTarget {
    const ID: &'static str = "vt";
    const NAME: &'static str = "Virtual target";
    const ABOUT: &'static str = "Potential field that escapes from traps by a virtual target, \
                                 reconstructed from the description of Yang 2018 in Wang et al. 2023. \
                                 Evades moving obstacles.";
    const PARAMS: &'static [ParamSpec] = params!();

    fn settings(config: &Config<'_>) -> FieldSettings {
        FieldSettings { escape: Escape::VirtualTarget, ..o::read(p::settings(config), config) }
    }
}

impl Kind for Push {
    const ID: &'static str = "iapf";
    const NAME: &'static str = "Improved potential field";
    const ABOUT: &'static str = "Potential field that escapes from traps by a sideways push, \
                                 reconstructed from the description of Zhao 2022 in Wang et al. 2023. \
                                 Evades moving obstacles.";
    const PARAMS: &'static [ParamSpec] = params!(o::PUSH, o::PUSH_SIDE, o::BESIDE);

    fn settings(config: &Config<'_>) -> FieldSettings {
        let mut settings = o::read(p::settings(config), config);
        settings.law.beside = o::beside(config);
        FieldSettings { escape: o::push(config), ..settings }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::plan;
    use planner_api::{Motion, Planner};
    use trials::{Distribution, Layout, Robot, Sampling, cross, fly, score};

    /// Wang et al. 2023, first distribution.
    const PAPER: [(&str, f64); 4] =
        [("k_att", 200.0), ("k_rep", 200.0), ("rho_0_m", 1.5), ("wall_gain", 0.0)];

    fn precision<P: Planner>(values: &[(&str, f64)]) -> f64 {
        let values: Vec<_> = PAPER.iter().chain(values).copied().collect();
        let of = |seed| {
            let layout = Distribution::D1.layout(Sampling::Square, seed, 0.0);
            score(&plan::<P>(&layout, &values).expect("a plan").path, &layout.path).precision
        };
        (0..12).map(of).sum::<f64>() / 12.0
    }

    #[test]
    fn both_follow_as_reconstructions_do_and_better_with_improved_repulsion() {
        for (classic, improved) in [
            (precision::<Vt>(&[]), precision::<Vt>(&[("repulsion", 1.0)])),
            (precision::<Iapf>(&[]), precision::<Iapf>(&[("repulsion", 1.0)])),
        ] {
            assert!((0.4..0.9).contains(&classic) && improved > 0.85, "{classic} {improved}");
        }
    }

    #[test]
    fn what_crosses_their_way_is_met_where_it_will_be() {
        for from_y_m in [-5.0, -4.0, -3.5, -3.0, 3.0, 3.5, 4.0, 5.0] {
            for crossing in [cross::<Vt>(&[], from_y_m), cross::<Iapf>(&[], from_y_m)] {
                assert!(crossing.arrived && crossing.clearance_m > 0.0, "{from_y_m} {crossing:?}");
            }
        }
    }

    #[test]
    fn in_flight_they_touch_nothing() {
        let robot = Robot { motion: Motion::Point, sigma_m: 0.03 };
        for seed in 0..3 {
            let layout = Layout::random(seed);
            assert!(fly::<Vt>(&[], &layout, robot, seed).expect("a flight").clearance_m > 0.0);
            assert!(fly::<Iapf>(&[], &layout, robot, seed).expect("a flight").clearance_m > 0.0);
        }
    }
}
