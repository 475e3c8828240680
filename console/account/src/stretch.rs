//! The part of a way that was certainly driven, although the position along it is not exactly known.

use std::collections::VecDeque;
use world::{Pose, geometry::wrap_angle_rad};

/// A way without a gap. The positions along it may be off by a margin, so the robot may be short of the last pose, or may
/// have begun after the first one, by as much.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stretch {
    /// The last poses, with their distances from the beginning along the way, metres.
    poses: VecDeque<(f64, Pose)>,
    /// Up to here, the way was certainly driven, metres.
    sure_m: f64,
}

impl Stretch {
    /// Adds a step from one pose to the next. Returns the steps that were certainly driven now, and were not before, if the
    /// positions are off by at most `margin_m` metres. Cost: proportional to the number of steps within the margin.
    pub(crate) fn sure(&mut self, (from, to): (Pose, Pose), margin_m: f64) -> Vec<(Pose, Pose)> {
        let (begin_m, _) = *self.poses.back().unwrap_or(&(0.0, from));
        let end_m = begin_m + (to.position - from.position).norm();
        if !end_m.is_finite() || !margin_m.is_finite() {
            *self = Self::default();
            return Vec::new();
        }
        if self.poses.is_empty() {
            self.poses.push_back((0.0, from));
        }
        self.poses.push_back((end_m, to));
        let (first_m, last_m) = (self.sure_m.max(margin_m), end_m - margin_m);
        // A margin of 0 also counts a turn in place.
        if last_m < first_m || (last_m <= first_m && margin_m > 0.0) {
            return Vec::new();
        }
        let steps = self.poses.iter().zip(self.poses.iter().skip(1));
        let within =
            steps.filter(|((_, _), (to_m, _))| *to_m >= first_m).filter(|((from_m, _), _)| *from_m <= last_m);
        let sure =
            within.map(|(a, b)| (between((a, b), first_m, 0.0), between((a, b), last_m, 1.0))).collect();
        self.sure_m = last_m;
        while self.poses.get(1).is_some_and(|(at_m, _)| *at_m < last_m) {
            self.poses.pop_front();
        }
        sure
    }
}

/// The pose at a distance along the way, which is taken to the nearer end if it lies outside the step. `turning` is the share
/// of a step that is only a turn.
fn between(((from_m, from), (to_m, to)): (&(f64, Pose), &(f64, Pose)), at_m: f64, turning: f64) -> Pose {
    let long_m = to_m - from_m;
    let share = if long_m > 0.0 { ((at_m - from_m) / long_m).clamp(0.0, 1.0) } else { turning };
    let turn_rad = wrap_angle_rad(to.heading_rad - from.heading_rad);
    Pose {
        position: from.position + (to.position - from.position) * share,
        heading_rad: from.heading_rad + turn_rad * share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Drives steps of these lengths along the x axis; returns the sure part, metres from the beginning.
    fn driven(steps_m: &[f64], margins_m: &[f64]) -> Vec<(f64, f64)> {
        let mut stretch = Stretch::default();
        let (mut at_m, mut sure) = (0.0, Vec::new());
        for (step_m, margin_m) in steps_m.iter().zip(margins_m) {
            let poses = (Pose::new(at_m, 0.0, 0.0), Pose::new(at_m + step_m, 0.0, 0.0));
            at_m += step_m;
            sure.extend(stretch.sure(poses, *margin_m).iter().map(|(a, b)| (a.position.x, b.position.x)));
        }
        sure
    }

    #[test]
    fn both_ends_of_a_way_are_uncertain() {
        let sure = driven(&[0.5, 0.5, 1.0], &[0.2; 3]);
        assert!((sure[0].0 - 0.2).abs() < 1e-12 && (sure.last().unwrap().1 - 1.8).abs() < 1e-12, "{sure:?}");
        // Nothing is left of a way that is shorter than twice the margin.
        assert!(driven(&[0.1, 0.2], &[0.2; 2]).is_empty());
    }

    #[test]
    fn a_turn_on_the_spot_is_part_of_the_way() {
        let mut stretch = Stretch::default();
        let [a, b, c] = [Pose::new(0.0, 0.0, 0.0), Pose::new(1.0, 0.0, 0.0), Pose::new(1.0, 0.0, 1.5)];
        let d = Pose::new(1.0, 1.0, 1.5);
        let sure: Vec<_> = [(a, b), (b, c), (c, d)].map(|poses| stretch.sure(poses, 0.1)).concat();
        assert!(sure.contains(&(b, c)), "{sure:?}");
    }

    proptest! {
        /// The parts join without gap, and stay away from both ends by the margins.
        #[test]
        fn the_sure_part_is_the_way_without_its_ends(
            steps in proptest::collection::vec((0.0..0.3f64, 0.0..0.4f64), 1..60),
        ) {
            let (steps_m, margins_m): (Vec<f64>, Vec<f64>) = steps.into_iter().unzip();
            let sure = driven(&steps_m, &margins_m);
            let long_m: f64 = steps_m.iter().sum();
            for (from_m, to_m) in &sure {
                prop_assert!(from_m <= &(to_m + 1e-9) && *to_m <= long_m + 1e-9);
            }
            for pair in sure.windows(2) {
                prop_assert!((pair[1].0 - pair[0].1).abs() < 0.5, "{pair:?}");
            }
            let last_margin_m = margins_m.last().unwrap();
            if let Some((_, end_m)) = sure.last() {
                let least_m = margins_m.iter().copied().fold(f64::INFINITY, f64::min);
                prop_assert!(*end_m <= long_m - least_m + 1e-9, "{end_m} of {long_m}, {last_margin_m}");
            }
        }
    }
}
