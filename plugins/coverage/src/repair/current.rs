//! The current plan.

use planner_api::{LegTag, Plan};
use world::{Point, polyline};

/// A straight segment of a path.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub from: Point,
    pub to: Point,
    pub is_lane: bool,
}

impl Side {
    /// Divides the segment into segments no longer than this, metres.
    pub(super) fn divided(self, most_m: f64) -> impl Iterator<Item = Self> {
        let way = self.to - self.from;
        let n = (way.norm() / most_m).ceil().max(1.0);
        let at = move |k: f64| self.from + way * (k / n);
        (0..n as usize).map(move |k| Self { from: at(k as f64), to: at(k as f64 + 1.0), ..self })
    }
}

/// The current plan, from the point where the robot continues.
pub(crate) struct CurrentPlan {
    pub cuts: Vec<Vec<Point>>,
    /// Whether the plan met the preferences for the tether's length and wrap.
    pub is_preferred: bool,
    sides: Vec<Side>,
}

impl CurrentPlan {
    /// Takes the rest of a plan, without a return path along the tether.
    pub(crate) fn new(plan: &Plan, is_preferred: bool) -> Self {
        let tag = |k: usize| plan.legs.iter().find(|leg| leg.first <= k && k < leg.last).map(|leg| leg.tag);
        let tagged = plan.path.windows(2).enumerate().map(|(k, w)| (w, tag(k)));
        let ahead = tagged.filter(|(_, tag)| *tag != Some(LegTag::Retract));
        let side =
            |(w, tag): (&[Point], _)| Side { from: w[0], to: w[1], is_lane: tag == Some(LegTag::Swath) };
        Self { cuts: plan.cuts.clone(), is_preferred, sides: ahead.map(side).collect() }
    }

    /// The segments of the path.
    pub(super) fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// The points of the path.
    pub(crate) fn path(&self) -> Vec<Point> {
        super::points(&self.sides)
    }

    /// The length of the path, metres.
    pub(crate) fn length_m(&self) -> f64 {
        polyline::length_m(&self.path())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::Leg;

    #[test]
    fn lanes_are_told_from_ways_and_a_way_back_is_left_out() {
        let path = (0..5).map(|k| Point::new(f64::from(k), 0.0)).collect();
        let leg = |tag, first, last| Leg { tag, first, last };
        let legs = vec![leg(LegTag::Retract, 0, 1), leg(LegTag::Swath, 2, 3), leg(LegTag::Connector, 3, 4)];
        let current = CurrentPlan::new(&Plan { path, legs, ..Plan::default() }, true);
        let is_lane: Vec<bool> = current.sides().iter().map(|side| side.is_lane).collect();
        assert_eq!(is_lane, [false, true, false]);
        assert_eq!(current.path()[0], Point::new(1.0, 0.0));
        assert!((current.length_m() - 3.0).abs() < 1e-9);
    }
}
