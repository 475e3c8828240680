//! Finds ranges that no place in the tank explains, such as an instrument's codes for "nothing heard", or readings in
//! a wrong unit.

use crate::{
    aggregate::is_usable,
    noise::{RangeNoise, Timing},
    session_calibration::Estimated,
};
use std::borrow::Cow;
use world::{Boundary, Point, RangeSet, Station, StationId};

/// Number of standard deviations by which the estimated offset of a clock may be wrong before its ranges are impossible.
const CLOCK_SIGMAS: f64 = 5.0;
/// Maximum distance of a station behind the wall, metres.
const BEHIND_WALL_M: f64 = 0.01;

/// An impossible range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impossible {
    /// The station.
    pub station: StationId,
    /// The range, metres.
    pub range_m: f64,
    /// The longest possible range, metres.
    pub most_m: f64,
}

/// The bounds of possible ranges in a tank: for each station, the distance to the farthest place in the tank, plus the
/// largest error of the noise.
#[derive(Debug, Clone)]
pub struct Possible {
    stations: Vec<Reach>,
    /// Largest error as a share of the distance.
    share: f64,
    /// Largest error that does not depend on the distance, metres.
    fixed_m: f64,
}

#[derive(Debug, Clone, Copy)]
struct Reach {
    id: StationId,
    at: Point,
    farthest_m: f64,
    /// The largest error of the estimated offset of the station's clock, metres.
    clock_m: f64,
}

impl Possible {
    /// Computes the bounds for a tank and its noise. `too_long_ratio` is the share by which all ranges may be too
    /// long because sound is slower than assumed.
    pub fn new(
        boundary: &Boundary,
        stations: &[Station],
        (noise, timing): (&RangeNoise, Timing),
        too_long_ratio: f64,
    ) -> Self {
        let reach = |station: &Station| Reach {
            id: station.id,
            at: station.position,
            farthest_m: farthest_m(boundary, station.position),
            clock_m: 0.0,
        };
        Self {
            stations: stations.iter().map(reach).collect(),
            share: (1.0 + noise.extreme_ratio()) * (1.0 + too_long_ratio) - 1.0,
            fixed_m: timing.extreme_m() + BEHIND_WALL_M,
        }
    }

    /// Separates possible from impossible ranges. Unknown stations are left to the solver.
    pub fn ranges<'a>(&self, sets: &'a [RangeSet]) -> (Cow<'a, [RangeSet]>, Vec<Impossible>) {
        let most_m = |set: &RangeSet| {
            let reach = self.stations.iter().find(|reach| reach.id == set.station);
            reach.map_or(f64::MAX, |reach| reach.farthest_m * (1.0 + self.share) + self.fixed_m)
        };
        sorted_out(sets, |set, range_m| {
            let most_m = most_m(set);
            let is_known = most_m < f64::MAX;
            (is_known && !(is_usable(range_m) && range_m <= most_m)).then_some(most_m)
        })
    }

    /// Separates possible from impossible ranges when only their differences count: two ranges may differ by no more
    /// than the distance between their stations. Ranges that agree with most others are kept.
    ///
    /// `clocks_m` are the estimated offsets of the stations' clocks, metres; empty if they share one clock. Five times
    /// their standard deviation allows for a wrong estimate.
    pub fn differences<'a>(
        &self,
        sets: &'a [RangeSet],
        clocks_m: &[(StationId, Estimated)],
    ) -> (Cow<'a, [RangeSet]>, Vec<Impossible>) {
        let late = |station| {
            let clock = clocks_m.iter().find(|(id, _)| *id == station);
            clock.map_or(Estimated { value: 0.0, sigma: 0.0 }, |(_, offset)| *offset)
        };
        let mut all: Vec<(Reach, f64)> = Vec::new();
        for set in sets {
            let reach = self.stations.iter().find(|reach| reach.id == set.station);
            let late = late(set.station);
            let late_by = |reach: &Reach| Reach { clock_m: CLOCK_SIGMAS * late.sigma, ..*reach };
            let ranges = |reach| set.ranges_m.iter().map(move |range_m| (reach, range_m - late.value));
            all.extend(reach.map(late_by).into_iter().flat_map(ranges));
        }
        let mut refused = Vec::new();
        loop {
            let partners = |one: &(Reach, f64)| all.iter().filter(|other| self.agree(one, other)).count();
            let counts: Vec<usize> = all.iter().map(partners).collect();
            let worst = counts.iter().enumerate().min_by_key(|(_, count)| **count);
            let Some((index, _)) = worst.filter(|(_, count)| **count < all.len()) else { break };
            refused.push(all.remove(index));
        }
        let first_m = all.iter().map(|(_, range_m)| *range_m).fold(f64::INFINITY, f64::min);
        sorted_out(sets, |set, range_m| {
            let late_m = late(set.station).value;
            let range_m = range_m - late_m;
            let is_refused = refused
                .iter()
                .any(|(reach, refused_m)| reach.id == set.station && refused_m.total_cmp(&range_m).is_eq());
            let first = all.iter().find(|(_, kept_m)| kept_m.total_cmp(&first_m).is_eq());
            let reach = self.stations.iter().find(|reach| reach.id == set.station);
            let most_m = first
                .zip(reach)
                .map_or(0.0, |((first, _), reach)| first_m + self.apart_m(first, reach) + late_m);
            is_refused.then_some(most_m)
        })
    }

    fn agree(&self, (one, one_m): &(Reach, f64), (other, other_m): &(Reach, f64)) -> bool {
        (one_m - other_m).abs() <= self.apart_m(one, other)
    }

    /// Returns the largest possible difference between the ranges of two stations, metres.
    fn apart_m(&self, one: &Reach, other: &Reach) -> f64 {
        let error_m = self.share * (one.farthest_m + other.farthest_m) + 2.0 * self.fixed_m;
        let error_m = error_m + one.clock_m + other.clock_m;
        (one.at - other.at).norm() + error_m
    }
}

/// Removes the ranges for which `bound_m` returns a bound, and returns them separately.
fn sorted_out(
    sets: &[RangeSet],
    bound_m: impl Fn(&RangeSet, f64) -> Option<f64>,
) -> (Cow<'_, [RangeSet]>, Vec<Impossible>) {
    let mut refused = Vec::new();
    for set in sets {
        let of = |range_m: &f64| {
            let (station, range_m) = (set.station, *range_m);
            bound_m(set, range_m).map(|most_m| Impossible { station, range_m, most_m })
        };
        refused.extend(set.ranges_m.iter().filter_map(of));
    }
    if refused.is_empty() {
        return (Cow::Borrowed(sets), refused);
    }
    let mut kept = sets.to_vec();
    for set in &mut kept {
        let whole = set.clone();
        set.ranges_m.retain(|range_m| bound_m(&whole, *range_m).is_none());
    }
    kept.retain(|set| !set.ranges_m.is_empty());
    (Cow::Owned(kept), refused)
}

/// Returns the distance to the farthest place in a tank, metres.
fn farthest_m(boundary: &Boundary, from: Point) -> f64 {
    match boundary {
        Boundary::Circle { radius_m } => from.coords.norm() + radius_m,
        Boundary::Polygon { vertices } => {
            vertices.iter().map(|corner| (corner - from).norm()).fold(0.0, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::ring;

    fn possible() -> (Possible, Vec<Station>) {
        let stations = ring(6, 6.0);
        let boundary = Boundary::Circle { radius_m: 6.0 };
        let noise = RangeNoise::Gaussian { sigma_ratio: 0.02 };
        (Possible::new(&boundary, &stations, (&noise, Timing::default()), 0.0), stations)
    }

    fn heard(at: Point, stations: &[Station]) -> Vec<RangeSet> {
        let set = |station: &Station| RangeSet {
            station: station.id,
            ranges_m: vec![(at - station.position).norm()],
        };
        stations.iter().map(set).collect()
    }

    #[test]
    fn words_for_nothing_heard_are_no_ranges() {
        let (possible, stations) = possible();
        let sound = heard(Point::new(1.0, 2.0), &stations);
        for sentinel in [0.0, -1.0, 9_999.0, 65_535.0, 7_132.146, f64::NAN, f64::INFINITY] {
            let mut sets = sound.clone();
            sets[2].ranges_m[0] = sentinel;
            let (kept, refused) = possible.ranges(&sets);
            assert_eq!((kept.len(), refused.len(), refused[0].station), (5, 1, stations[2].id), "{sentinel}");
            assert!((13.0..14.0).contains(&refused[0].most_m));
        }
        assert!(possible.ranges(&sound).1.is_empty());
    }

    #[test]
    fn one_bad_repetition_does_not_cost_the_station() {
        let (possible, stations) = possible();
        let mut sets = heard(Point::new(1.0, 2.0), &stations);
        sets[2].ranges_m.push(65_535.0);
        let (kept, refused) = possible.ranges(&sets);
        assert_eq!((kept.len(), refused.len()), (6, 1));
    }

    #[test]
    fn arrivals_that_differ_more_than_the_stations_are_apart_are_left_out() {
        let (possible, stations) = possible();
        let mut sets = heard(Point::new(1.0, 2.0), &stations);
        assert!(possible.differences(&sets, &[]).1.is_empty());
        for sentinel in [0.0, 9_999.0, -65_535.0] {
            for set in &mut sets {
                set.ranges_m[0] += 1_000.0;
            }
            sets[0].ranges_m[0] = sentinel;
            let (kept, refused) = possible.differences(&sets, &[]);
            assert_eq!((kept.len(), refused.len(), refused[0].station), (5, 1, stations[0].id), "{sentinel}");
        }
    }

    #[test]
    fn clocks_that_are_far_apart_cost_no_station_if_their_offsets_may_be_large() {
        let (possible, stations) = possible();
        let mut sets = heard(Point::new(1.0, 2.0), &stations);
        let late_m = [30.0, -25.0, 0.0, 18.0, -40.0, 5.0];
        sets.iter_mut().zip(late_m).for_each(|(set, late_m)| set.ranges_m[0] += 200.0 + late_m);
        assert!(!possible.differences(&sets, &[]).1.is_empty());
        let clocks = |late_m: &[f64], sigma| -> Vec<(StationId, Estimated)> {
            stations.iter().zip(late_m).map(|(s, m)| (s.id, Estimated { value: *m, sigma })).collect()
        };
        assert!(possible.differences(&sets, &clocks(&[0.0; 6], 20.0)).1.is_empty());
        // Once the offsets are known, an impossible range shows again.
        let known = clocks(&late_m, 0.05);
        assert!(possible.differences(&sets, &known).1.is_empty());
        sets[2].ranges_m[0] += 20.0;
        let (kept, refused) = possible.differences(&sets, &known);
        assert_eq!((kept.len(), refused.len(), refused[0].station), (5, 1, stations[2].id));
    }
}
