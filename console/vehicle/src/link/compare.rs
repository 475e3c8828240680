//! Compares measured with commanded motion, both smoothed, over the last seconds. The delay
//! of the vehicle is not known, so the commands are compared with several delays; a difference counts only if it exists
//! with each of them.

use crate::wire::message::{Drive, Limits, Odometry};
use std::{collections::VecDeque, fmt};

/// Number of delays of the vehicle with which commands are compared, and the step from one delay to the next, seconds.
const DELAYS: usize = 6;
const DELAY_STEP_S: f64 = 0.1;
/// Number of commands kept for this comparison. At more than 50 readings a second, the kept commands do not reach back
/// to the longest delays.
const KEPT_MAX: usize = 64;
/// Time over which both motions are smoothed, seconds.
const SMOOTHED_S: f64 = 0.5;
/// Age, seconds, above which motion is dropped.
const FORGOTTEN_S: f64 = 3.0;
/// Minimum commanded motion for a finding, metres and radians.
const NEEDED_M: f64 = 0.2;
const NEEDED_RAD: f64 = 0.35;
/// Time for which a finding must last, seconds.
const LASTING_S: f64 = 0.5;
/// Ratio of measured to commanded motion below which the vehicle counts as not moving.
const FROZEN: f64 = 0.05;
/// Ratio of measured to commanded motion below which the motion counts as reversed.
const REVERSED: f64 = -0.3;
/// Ratio of sideways to commanded motion above which the axes count as swapped.
const SWAPPED: f64 = 0.5;
/// The range within which slip and friction explain the ratio of measured to commanded motion.
const RATIO_MIN: f64 = 0.4;
const RATIO_MAX: f64 = 1.6;
/// Squared correlation of measured and commanded motion above which their ratio counts as steady.
const STEADY: f64 = 0.9;

/// A direction of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Ahead.
    Forward,
    /// Counter-clockwise.
    Turn,
}

/// A difference between commanded and measured motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finding {
    /// The odometry shows no motion while the vehicle is commanded to move.
    Frozen(Axis),
    /// The odometry moves in the opposite direction.
    Reversed(Axis),
    /// The odometry moves sideways while the vehicle is commanded ahead.
    Swapped,
    /// The odometry has a different scale.
    Scale {
        /// The direction of motion.
        axis: Axis,
        /// Measured divided by commanded motion.
        ratio: f64,
        /// Whether the ratio was the same all the time, so that a mix-up of units can be its cause.
        is_steady: bool,
    },
}

impl fmt::Display for Finding {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frozen(Axis::Forward) => {
                out.write_str("odometry shows a standstill while the vehicle is driven")
            }
            Self::Frozen(Axis::Turn) => {
                out.write_str("the heading does not change while the vehicle is turned")
            }
            Self::Reversed(Axis::Forward) => out.write_str("odometry runs backward: x must be ahead"),
            Self::Reversed(Axis::Turn) => {
                out.write_str("turns are mirrored: counter-clockwise must be positive")
            }
            Self::Swapped => out.write_str("axes are swapped: odometry moves sideways, but x must be ahead"),
            Self::Scale { axis, ratio, is_steady } => {
                let what = if *axis == Axis::Forward { "odometry" } else { "turning" };
                let unit = if *is_steady { unit(*axis, *ratio) } else { "" };
                write!(out, "{what} is {ratio:.2} times the commanded motion{unit}")
            }
        }
    }
}

/// The mix-up of units that a ratio suggests, as the end of a sentence; empty if it suggests none.
fn unit(axis: Axis, ratio: f64) -> &'static str {
    let units: &[(f64, &str)] = match axis {
        Axis::Forward => {
            &[(3.28, ": feet instead of metres?"), (0.305, ": is the command taken as feet per second?")]
        }
        Axis::Turn => &[
            (57.3, ": degrees instead of radians?"),
            (0.0175, ": is the command taken as degrees per second?"),
        ],
    };
    units.iter().find(|(is, _)| (ratio / is - 1.0).abs() < 0.2).map_or("", |(_, unit)| unit)
}

/// Commanded and measured motion along one axis.
#[derive(Debug, Clone, Default)]
struct Track {
    /// Smoothed rates.
    commanded: f64,
    measured: f64,
    across: f64,
    /// Sums, over the last seconds, of squares, products and magnitudes of the rates.
    square: f64,
    square_measured: f64,
    product: f64,
    product_across: f64,
    path: f64,
    path_measured: f64,
}

impl Track {
    fn add(&mut self, commanded: f64, measured: f64, across: f64, over_s: f64) {
        let share = 1.0 - (-over_s / SMOOTHED_S).exp();
        self.commanded += share * (commanded - self.commanded);
        self.measured += share * (measured - self.measured);
        self.across += share * (across - self.across);
        let kept = (-over_s / FORGOTTEN_S).exp();
        let grow = |sum: &mut f64, rate: f64| *sum = *sum * kept + rate * over_s;
        grow(&mut self.square, self.commanded * self.commanded);
        grow(&mut self.square_measured, self.measured * self.measured);
        grow(&mut self.product, self.commanded * self.measured);
        grow(&mut self.product_across, self.commanded * self.across);
        grow(&mut self.path, self.commanded.abs());
        grow(&mut self.path_measured, self.measured.hypot(self.across));
    }

    fn finding(&self, axis: Axis, needed: f64) -> Option<Finding> {
        if self.path < needed {
            return None;
        }
        let (ratio, across) = (self.product / self.square, self.product_across / self.square);
        let fits = (RATIO_MIN..=RATIO_MAX).contains(&ratio);
        // Motion that was measured before the odometry froze leaves the sums only slowly.
        let stands = self.measured.hypot(self.across) < FROZEN * self.commanded.abs();
        if self.path_measured < FROZEN * self.path || (stands && !fits) {
            Some(Finding::Frozen(axis))
        } else if across.abs() > SWAPPED && ratio.abs() < RATIO_MIN {
            Some(Finding::Swapped)
        } else if ratio < REVERSED {
            Some(Finding::Reversed(axis))
        } else if !fits {
            let is_steady = self.product * self.product > STEADY * self.square * self.square_measured;
            Some(Finding::Scale { axis, ratio, is_steady })
        } else {
            None
        }
    }
}

/// Compares commands with motion.
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    /// The commanded rates, and the speed that the vehicle can have reached by its acceleration.
    forward_m_per_s: f64,
    turn_rad_per_s: f64,
    reached_m_per_s: f64,
    /// Time of the motions so far, and the rates that were commanded at earlier times, in order.
    time_s: f64,
    earlier: VecDeque<(f64, f64, f64)>,
    forward: [Track; DELAYS],
    turn: [Track; DELAYS],
    /// The current finding, and for how long it has lasted.
    current: Option<(Finding, f64)>,
}

impl Comparison {
    /// Takes a command that applies from now on; `None` to stand still.
    pub fn command(&mut self, drive: Option<&Drive>) {
        self.forward_m_per_s = drive.map_or(0.0, |drive| drive.forward_m_per_s);
        self.turn_rad_per_s = drive.map_or(0.0, |drive| drive.turn_rad_per_s);
    }

    /// Takes a measured motion.
    pub fn moved(&mut self, motion: &Odometry, limits: &Limits) {
        let over_s = motion.over_s;
        self.time_s += over_s;
        let change = limits.acceleration_m_per_s2 * over_s;
        self.reached_m_per_s += (self.forward_m_per_s - self.reached_m_per_s).clamp(-change, change);
        self.keep((self.time_s, self.reached_m_per_s, self.turn_rad_per_s));
        let rate = |moved: f64| moved / over_s;
        for delay in 0..DELAYS {
            let (forward, turn) = self.commanded(self.time_s - DELAY_STEP_S * delay as f64);
            self.forward[delay].add(forward, rate(motion.forward_m), rate(motion.sideways_m), over_s);
            self.turn[delay].add(turn, rate(motion.turn_rad), 0.0, over_s);
        }
        let found = least_wrong(&self.forward, Axis::Forward, NEEDED_M);
        let found = found.or_else(|| least_wrong(&self.turn, Axis::Turn, NEEDED_RAD));
        self.current = found.map(|found| match self.current {
            // Once reported, the same finding keeps its ratio: each change would be another report.
            Some((before, lasted_s)) if is_same(before, found) => {
                (if lasted_s >= LASTING_S { before } else { found }, lasted_s + over_s)
            }
            _ => (found, 0.0),
        });
    }

    fn keep(&mut self, commanded: (f64, f64, f64)) {
        if self.earlier.len() == KEPT_MAX {
            self.earlier.pop_front();
        }
        self.earlier.push_back(commanded);
    }

    /// The rates that were commanded at an earlier time.
    fn commanded(&self, at_s: f64) -> (f64, f64) {
        let since = self.earlier.iter().rev().find(|(since_s, ..)| *since_s <= at_s + 1e-9);
        since.map_or((0.0, 0.0), |(_, forward, turn)| (*forward, *turn))
    }

    /// The difference that has lasted for some time, if any.
    pub fn finding(&self) -> Option<Finding> {
        self.current.filter(|(_, lasted_s)| *lasted_s >= LASTING_S).map(|(finding, _)| finding)
    }
}

/// The finding for the delay that explains the motion best; `None` if, for at least one delay, the motion fits the
/// commands.
fn least_wrong(tracks: &[Track], axis: Axis, needed: f64) -> Option<Finding> {
    let findings: Option<Vec<Finding>> = tracks.iter().map(|track| track.finding(axis, needed)).collect();
    let fit = |track: &Track| track.product.abs().max(track.product_across.abs()) / track.square.sqrt();
    let best = (0..tracks.len()).max_by(|one, other| fit(&tracks[*one]).total_cmp(&fit(&tracks[*other])));
    findings?.get(best?).copied()
}

fn is_same(one: Finding, other: Finding) -> bool {
    match (one, other) {
        (Finding::Scale { axis: one, .. }, Finding::Scale { axis: other, .. }) => one == other,
        _ => one == other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMITS: Limits =
        Limits { speed_m_per_s: 0.4, turn_rad_per_s: 1.0, acceleration_m_per_s2: 0.5, radius_m: 0.2 };
    const OVER_S: f64 = 0.05;

    fn drive(forward_m_per_s: f64, turn_rad_per_s: f64) -> Drive {
        Drive { seq: 0, stamp_s: 0.0, lease_s: 0.25, forward_m_per_s, sideways_m_per_s: 0.0, turn_rad_per_s }
    }

    /// The last finding of a vehicle with some delay that misreports its motion.
    fn found(commands: &[(f64, f64)], delay: usize, lie: impl Fn(Odometry) -> Odometry) -> Option<Finding> {
        let mut comparison = Comparison::default();
        let (mut v, mut last) = (0.0_f64, None);
        for n in 0..commands.len() {
            comparison.command(Some(&drive(commands[n].0, commands[n].1)));
            let (to, w) = n.checked_sub(delay).map_or((0.0, 0.0), |n| commands[n]);
            v += (to - v).clamp(-0.5 * OVER_S, 0.5 * OVER_S);
            let honest =
                Odometry { over_s: OVER_S, forward_m: v * OVER_S, sideways_m: 0.0, turn_rad: w * OVER_S };
            comparison.moved(&lie(honest), &LIMITS);
            last = comparison.finding().or(last);
        }
        last
    }

    #[test]
    fn each_lie_is_named() {
        let ahead = vec![(0.3, 0.0); 80];
        let round = vec![(0.0, 0.6); 80];
        let scaled =
            |factor: f64| move |honest: Odometry| Odometry { forward_m: factor * honest.forward_m, ..honest };
        let turned =
            |factor: f64| move |honest: Odometry| Odometry { turn_rad: factor * honest.turn_rad, ..honest };
        let told = |finding: Option<Finding>| finding.map_or(String::new(), |finding| finding.to_string());
        assert_eq!(found(&ahead, 4, scaled(0.0)), Some(Finding::Frozen(Axis::Forward)));
        assert_eq!(found(&ahead, 4, scaled(-1.0)), Some(Finding::Reversed(Axis::Forward)));
        assert_eq!(
            told(found(&ahead, 0, scaled(3.28))),
            "odometry is 3.28 times the commanded motion: feet instead of metres?"
        );
        assert_eq!(found(&round, 4, turned(0.0)), Some(Finding::Frozen(Axis::Turn)));
        assert_eq!(
            told(found(&round, 4, turned(-1.0))),
            "turns are mirrored: counter-clockwise must be positive"
        );
        assert!(told(found(&round, 0, turned(57.3))).ends_with("degrees instead of radians?"));
        let swapped = |honest: Odometry| Odometry { forward_m: 0.0, sideways_m: honest.forward_m, ..honest };
        assert_eq!(found(&ahead, 4, swapped), Some(Finding::Swapped));
    }

    #[test]
    fn odometry_that_freezes_during_a_drive_is_not_taken_for_a_mix_up_of_units() {
        for honest in [20, 60, 200] {
            let ahead = vec![(0.3, 0.0); honest + 200];
            let seen = std::cell::Cell::new(0);
            let fades = |to: f64| {
                seen.set(0);
                let lie = |odometry: Odometry| {
                    seen.set(seen.get() + 1);
                    let factor = if seen.get() > honest { to } else { 1.0 };
                    Odometry { forward_m: factor * odometry.forward_m, ..odometry }
                };
                found(&ahead, 2, lie).map_or(String::new(), |finding| finding.to_string())
            };
            assert_eq!(fades(0.0), Finding::Frozen(Axis::Forward).to_string(), "{honest}");
            assert!(fades(0.15).ends_with("times the commanded motion"), "{honest}: {}", fades(0.15));
        }
    }

    #[test]
    fn a_finding_that_lasts_stays_the_same() {
        let mut comparison = Comparison::default();
        let mut found = Vec::new();
        for n in 0..200 {
            comparison.command(Some(&drive(0.3, 0.0)));
            let forward_m = 0.3 * OVER_S * (2.0 + f64::from(n) / 100.0);
            comparison
                .moved(&Odometry { over_s: OVER_S, forward_m, sideways_m: 0.0, turn_rad: 0.0 }, &LIMITS);
            found.extend(comparison.finding().map(|finding| finding.to_string()));
        }
        found.dedup();
        assert_eq!(found.len(), 1, "{found:?}");
    }

    proptest! {
        /// Commands that change at random, a delay of up to 0.5 s, slip of up to 15 %.
        #[test]
        fn an_honest_vehicle_is_not_accused(
            legs in prop::collection::vec((-0.4..0.4_f64, -1.0..1.0_f64, 10..60_usize), 1..20),
            delay in 0..=10_usize,
            slip in 0.85..1.05_f64,
        ) {
            let commands: Vec<(f64, f64)> =
                legs.iter().flat_map(|(v, w, n)| std::iter::repeat_n((*v, *w), *n)).collect();
            let slipping = |honest: Odometry| Odometry {
                forward_m: slip * honest.forward_m,
                turn_rad: slip * honest.turn_rad,
                ..honest
            };
            prop_assert_eq!(found(&commands, delay, slipping), None);
        }
    }
}
