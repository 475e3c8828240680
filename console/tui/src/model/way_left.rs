//! The remaining length and time of a drive back to the anchor or the start.

use super::Run;
use world::{Point, polyline};

impl Run {
    /// Remaining length of the way back from the estimated position, metres; `None` unless the robot is driving back.
    pub fn way_left_m(&self) -> Option<f64> {
        let way = self.way_back.as_ref().filter(|_| self.standing.phase.is_return())?;
        let here = self.position.pose.map(|pose| pose.position);
        Some(here.map_or(way.length_m, |here| left_m(&way.path, here)))
    }

    /// Remaining mission time of the way back at its highest speed, seconds; `None` unless the robot is driving back.
    pub(super) fn way_left_s(&self) -> Option<f64> {
        let speed =
            self.way_back.as_ref()?.fastest_m_per_s(self.about.as_ref()?.mission.limits.v_max_m_per_s);
        self.way_left_m().filter(|_| speed > 0.0).map(|left_m| left_m / speed)
    }
}

/// The length of a path from the point nearest to `here` on, metres.
fn left_m(path: &[Point], here: Point) -> f64 {
    let nearest = |pair: &[Point]| polyline::nearest_on_segment(pair[0], pair[1], here);
    let off_m = |pair: &[Point]| (nearest(pair) - here).norm();
    let pairs = path.windows(2).enumerate();
    let closest = pairs.min_by(|(_, one), (_, other)| off_m(one).total_cmp(&off_m(other)));
    closest.map_or(0.0, |(index, pair)| {
        (pair[1] - nearest(pair)).norm() + polyline::length_m(&path[index + 1..])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_a_way_is_counted_from_the_place_next_to_the_robot() {
        let path = [Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)];
        for (here, left) in [((0.0, 0.2), 7.0), ((3.0, -0.1), 4.0), ((4.2, 2.0), 1.0), ((4.0, 3.0), 0.0)] {
            assert!((left_m(&path, Point::new(here.0, here.1)) - left).abs() < 1e-9, "{here:?}");
        }
        assert!(left_m(&[], Point::origin()).abs() < 1e-9);
    }
}
