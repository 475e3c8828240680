//! Rounds the numbers in events to the precision with which quantities in a tank can be known.
//!
//! Lengths, angles and shares are rounded to a millionth of their unit, covariances to four significant digits. Numbers
//! are rounded once, where an event leaves the mission. As a result, the journal, the recording, the screen and the
//! report contain the same numbers, and the events of a tick take a third of the bytes that they would take otherwise.
//! Plans are not rounded, because the planners' answers are replayed from the journal. Commands are rounded before they
//! are sent ([`crate::Sending::as_sent`]).

use super::{Event, EventKind, MeasuredPull, PlanMade, TetherContact};
use crate::{ask::Said, way_back::WayBack};
use exploration::Column;
use nalgebra::SMatrix;
use planner_api::{Command, Drawing, Drive, PoseEstimate};
use positioning::{Estimated, Exclusion, Fix, PulseError, Ranging};
use world::{CableLies, Point, Pose, Shape};

/// Rounding steps per unit.
const STEPS: f64 = 1e6;
/// Numbers above this are not rounded; they do not occur in a tank.
const MOST: f64 = 1e9;

/// Rounds a number to the nearest millionth; never returns `-0.0`.
fn rounded(x: f64) -> f64 {
    // Adding zero turns -0.0 into 0.0.
    if x.abs() < MOST { (x * STEPS).round() / STEPS + 0.0 } else { x }
}

/// Rounds a number to four significant digits; never returns `-0.0`.
fn significant(x: f64) -> f64 {
    quickly_significant(x).unwrap_or_else(|| format!("{x:.3e}").parse().map_or(x, |x: f64| x + 0.0))
}

/// Rounds without a conversion to text; works only for numbers for which rounding errors cannot change the last digit. A
/// number of four digits and a power of ten up to the 22nd are both exact, so their quotient is the number nearest to the
/// decimal one.
fn quickly_significant(x: f64) -> Option<f64> {
    if x == 0.0 {
        return Some(0.0);
    }
    let places = 3 - x.abs().log10().floor() as i32;
    let power = *POWERS_OF_TEN.get(usize::try_from(places).ok()?)?;
    let digits = x * power;
    let is_clear = ((digits.abs().fract()) - 0.5).abs() > 1e-6;
    (is_clear && (1000.0..9999.5).contains(&digits.abs())).then(|| digits.round() / power)
}

/// The exact powers of ten.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

impl Event {
    /// Returns the event with rounded numbers; rounding it again changes nothing.
    #[must_use]
    pub fn rounded(mut self) -> Self {
        round(&mut self.t_s);
        self.kind.round();
        self
    }
}

impl Said {
    /// Rounds the numbers in drawings and figures in the same way as those in events.
    #[must_use]
    pub(crate) fn rounded(mut self) -> Self {
        self.drawings.iter_mut().for_each(round_drawing);
        self.scalars.iter_mut().for_each(|(_, value, _)| round(value));
        self
    }
}

/// Rounds a number to a millionth towards zero, so that a value within a limit stays within the limit.
fn toward_zero(x: f64) -> f64 {
    let nearest = rounded(x);
    if nearest.abs() > x.abs() { rounded(nearest - x.signum() / STEPS) } else { nearest }
}

/// Rounds a command that is sent to the robot.
pub(crate) fn rounded_command(Command { drive, status }: Command) -> Command {
    let drive = match drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => {
            Drive::Twist { v_m_per_s: toward_zero(v_m_per_s), w_rad_per_s: toward_zero(w_rad_per_s) }
        }
        Drive::Velocity(velocity) => Drive::Velocity(velocity.map(toward_zero)),
    };
    Command { drive, status }
}

impl EventKind {
    #[allow(clippy::too_many_lines, reason = "one arm for each kind of event")]
    fn round(&mut self) {
        match self {
            Self::TetherTruth { length_m, wrap_max_rad, wrap_total_rad, detour_m, lies } => {
                [length_m, wrap_max_rad, wrap_total_rad, detour_m].into_iter().for_each(round);
                if let Some(lies) = lies {
                    round_cable(lies);
                }
            }
            Self::Tethered {
                length_m,
                paid_out_m,
                free_m,
                contacts,
                wrap_max_rad,
                wrap_total_rad,
                pull_factor,
                pull_n,
                measured,
                return_length_m,
                bends,
            } => {
                [length_m, free_m, wrap_max_rad, wrap_total_rad, pull_factor].into_iter().for_each(round);
                [paid_out_m, return_length_m, pull_n].into_iter().flatten().for_each(round);
                if let Some(MeasuredPull { pull_n, slack_m }) = measured {
                    [pull_n, slack_m].into_iter().for_each(round);
                }
                bends.iter_mut().for_each(round_point);
                for TetherContact { wrap_rad, at, .. } in contacts {
                    round(wrap_rad);
                    round_point(at);
                }
            }
            Self::Truth { pose: Pose { position, heading_rad }, clearance_m, .. } => {
                round_point(position);
                [heading_rad, clearance_m].into_iter().for_each(round);
            }
            Self::Guarded { asked_m_per_s, sent_m_per_s, gap_m, direction_rad } => {
                [asked_m_per_s, sent_m_per_s, gap_m, direction_rad].into_iter().for_each(round);
            }
            Self::SpeedLimited { asked_m_per_s, sent_m_per_s, needs_m } => {
                [asked_m_per_s, sent_m_per_s, needs_m].into_iter().for_each(round);
            }
            Self::ReturnBegan { way: WayBack { path, length_m, clearance_m, .. } } => {
                path.iter_mut().for_each(round_point);
                [length_m, clearance_m].into_iter().for_each(round);
            }
            Self::SurveyWay(way) => {
                way.path.iter_mut().for_each(round_point);
                round(&mut way.length_m);
            }
            Self::Explored(explored) => {
                round(&mut explored.share);
                explored.frontiers.iter_mut().for_each(round_point);
                explored.columns.iter_mut().for_each(round_column);
            }
            Self::Mapped { map } => {
                round(&mut map.explored);
                round_point(&mut map.grid.low);
                map.columns.iter_mut().for_each(round_column);
                map.others.iter_mut().for_each(round_shape);
            }
            Self::ZoneBreached { depth_m, .. } => round(depth_m),
            Self::BetterPlanned(PlanMade { scans: Some(scans), .. }) => {
                for scan in [&mut scans.flown, &mut scans.better] {
                    [&mut scan.left_m2, &mut scan.covered_reachable].into_iter().for_each(round);
                }
            }
            Self::MediumKnown { pressure_pa, .. } => round(pressure_pa),
            Self::Ranged { ranges } => ranges.iter_mut().for_each(round_ranging),
            Self::Fixed { fix } => round_fix(fix),
            Self::Protected { level_m } => level_m.iter_mut().for_each(round),
            Self::ProtectionRegained { level_m } => round(level_m),
            Self::SessionCalibrated { scale, slip_correlation } => {
                round_estimated(scale);
                slip_correlation.iter_mut().for_each(round);
            }
            Self::StationBiased { bias_m, .. } => round_estimated(bias_m),
            Self::NotSeparable { correlation, .. } => round(correlation),
            Self::PulsesTested { test, .. } => {
                let offsets = test.offsets_m.iter_mut().map(|(_, offset)| offset);
                offsets.chain([&mut test.scale]).for_each(round_estimated);
                round(&mut test.worst.2);
            }
            Self::PulsesFailed { why: PulseError::Implausible { scale }, .. } => round(scale),
            Self::PulsesFailed { why: PulseError::Impossible { length_m, most_m, .. }, .. } => {
                round(length_m);
                round(most_m);
            }
            Self::ClocksEstimated { offsets } | Self::ClocksChanged { changes: offsets } => {
                for offset in offsets {
                    round_estimated(&mut offset.offset_m);
                }
            }
            Self::Estimated { pose: PoseEstimate { position, heading_rad, covariance } } => {
                round_point(position);
                round(heading_rad);
                round_covariance(covariance);
            }
            Self::Drawn { drawings } => drawings.iter_mut().for_each(round_drawing),
            Self::Scalars { scalars } => scalars.iter_mut().for_each(|(_, value, _)| round(value)),
            Self::Progressed {
                done,
                along_m,
                cross_track_m,
                target,
                covered_reachable,
                covered_whole,
                ..
            } => {
                [done, covered_reachable, covered_whole].into_iter().for_each(round);
                [along_m, cross_track_m].into_iter().flatten().for_each(round);
                round_point(target);
            }
            Self::Shadowed { of } => of.round(),
            _ => {}
        }
    }
}

fn round(x: &mut f64) {
    *x = rounded(*x);
}

fn round_estimated(Estimated { value, sigma }: &mut Estimated) {
    [value, sigma].into_iter().for_each(round);
}

fn round_cable(lies: &mut CableLies) {
    lies.line.iter_mut().for_each(round_point);
    round(&mut lies.reel_pull_n);
}

fn round_point(point: &mut Point) {
    point.iter_mut().for_each(round);
}

fn round_column(Column { center, radius_m, center_sigma_m, radius_sigma_m }: &mut Column) {
    round_point(center);
    [radius_m, center_sigma_m, radius_sigma_m].into_iter().for_each(round);
}

fn round_shape(shape: &mut Shape) {
    match shape {
        Shape::Disc { center, radius_m } => {
            round_point(center);
            round(radius_m);
        }
        Shape::Polygon { vertices: points } => points.iter_mut().for_each(round_point),
        Shape::Polyline { points, half_width_m } => {
            points.iter_mut().for_each(round_point);
            round(half_width_m);
        }
    }
}

fn round_covariance<const N: usize>(covariance: &mut SMatrix<f64, N, N>) {
    covariance.iter_mut().for_each(|x| *x = significant(*x));
}

fn round_ranging(Ranging { range_m, sigma_m, least_m, most_m, timing_sigma_m, .. }: &mut Ranging) {
    [range_m, sigma_m, least_m, most_m, timing_sigma_m].into_iter().for_each(round);
}

fn round_fix(fix: &mut Fix) {
    round_point(&mut fix.position);
    round_covariance(&mut fix.covariance);
    for residual in &mut fix.residuals {
        [&mut residual.residual_m, &mut residual.sigma_m].into_iter().for_each(round);
    }
    for (_, why) in &mut fix.excluded {
        match why {
            Exclusion::Residual { residual_m: one, gate_m: other }
            | Exclusion::Impossible { range_m: one, most_m: other } => {
                [one, other].into_iter().for_each(round);
            }
            Exclusion::Biased { bias_m } => round(bias_m),
            Exclusion::Silent | Exclusion::ByOrder => {}
        }
    }
    [&mut fix.chi2, &mut fix.gdop, &mut fix.conditioning].into_iter().for_each(round);
    fix.mirror.iter_mut().for_each(round_point);
    fix.protection_level_m.iter_mut().for_each(round);
}

fn round_drawing(drawing: &mut Drawing) {
    match drawing {
        Drawing::Arrow { at, vector, .. } => {
            round_point(at);
            vector.iter_mut().for_each(round);
        }
        Drawing::Circle { center, radius_m, .. } => {
            round_point(center);
            round(radius_m);
        }
        Drawing::Line { from, to, .. } => [from, to].into_iter().for_each(round_point),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn no_number_is_finer_than_a_millionth_and_no_zero_is_negative() {
        let round = |x| rounded(x).to_string();
        assert_eq!([round(419.700_000_000_000_05), round(-1.234_567_89)], ["419.7", "-1.234568"]);
        assert_eq!([round(-0.0), round(-1e-9), round(f64::INFINITY)], ["0", "0", "inf"]);
        let significant = |x| significant(x).to_string();
        assert_eq!([significant(0.000_203_190_695), significant(-12_345.6)], ["0.0002032", "-12350"]);
        assert_eq!([significant(-0.0), significant(f64::NAN)], ["0", "NaN"]);
    }

    proptest! {
        #[test]
        fn what_is_rounded_stays_as_it_is(x in -1e10..1e10_f64, exponent in -30..3_i32) {
            let x = x * 10_f64.powi(exponent);
            prop_assert_eq!(rounded(rounded(x)).to_bits(), rounded(x).to_bits());
            // Half a rounding step, plus the rounding error of a double of this size.
            prop_assert!((rounded(x) - x).abs() <= 0.500_001e-6 + 2.0 * f64::EPSILON * x.abs());
            let towards = toward_zero(x);
            prop_assert_eq!(toward_zero(towards).to_bits(), towards.to_bits());
            prop_assert!(towards.abs() <= x.abs());
            prop_assert_eq!(significant(significant(x)).to_bits(), significant(x).to_bits());
            let by_text: f64 = format!("{x:.3e}").parse().unwrap();
            prop_assert_eq!(significant(x).to_bits(), (by_text + 0.0).to_bits());
        }
    }
}
