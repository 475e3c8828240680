//! Bends: the path is shifted slightly sideways to floor that it would miss, where this is cheaper than a separate
//! lane.

use crate::buckets::Buckets;
use crate::floor::Run;
use crate::plane::Course;
use crate::polish::track::{Terms, Track};
use crate::scan::Piece;
use crate::slit_domain::Spot;
use crate::tuning::bends::{AND_BESIDE, ASIDE, BASES, NEAR_M, PLACES};
use crate::tuning::polish::BENT_CELLS;
use planner_api::Result;
use std::collections::BTreeSet;
use world::{Point, Vector};

/// A bend that may be worthwhile.
struct Offer {
    /// The cost, in metres of path and turning per square metre of floor.
    rate: f64,
    at: Point,
    base: usize,
    to: Point,
}

/// A stretch of the path that a bend may replace.
struct Stretch {
    from: usize,
    past: usize,
    course: Course,
    /// The ends of the stretch.
    a: Spot,
    b: Spot,
    /// The cells that it sweeps, together with one side before it and one after it.
    swept: Vec<Run>,
}

impl Track<'_> {
    /// Bends the path to missed floor where a square metre is cheap enough, until the required coverage is reached.
    /// Returns the number of bends. Groups of missed cells that are not worth a bend are remembered in `vain`, by first
    /// cell and size.
    pub(super) fn bend(&mut self, terms: &Terms<'_>, vain: &mut BTreeSet<(usize, usize)>) -> Result<usize> {
        if self.coverage() >= terms.enough {
            return Ok(0);
        }
        let mut offers: Vec<Offer> = Vec::new();
        let places = self.places();
        let missed = self.swept.missed();
        for (k, group) in missed.iter().take_while(|group| group.len() >= BENT_CELLS).enumerate() {
            terms.job.check()?;
            terms.job.reached(k as f64 / missed.len() as f64);
            let id = (group[0], group.len());
            if vain.contains(&id) {
                continue;
            }
            match self.best_bend(group, &places, terms) {
                Some(offer) => offers.push(offer),
                None => drop(vain.insert(id)),
            }
        }
        offers.sort_by(|a, b| a.rate.total_cmp(&b.rate));
        let mut n_made = 0;
        for Offer { at, base, to, .. } in offers {
            if self.coverage() >= terms.enough {
                break;
            }
            // The path may have changed in the meantime, so the bend is made only if it is still cheap.
            let Some(k) = (0..=self.sides.len()).find(|k| self.point(*k) == at) else { continue };
            let Some((stretch, spot)) = self.stretch(k, base).zip(self.domain.spot(to)) else { continue };
            if self
                .rate(&stretch, spot, terms, (f64::INFINITY, f64::INFINITY))
                .is_some_and(|rate| rate <= terms.bend_m_per_m2)
            {
                self.make_bend(k, &stretch, to);
                n_made += 1;
            }
        }
        Ok(n_made)
    }

    /// The cheapest bend to a group of missed cells, if one is cheap enough.
    fn best_bend(&mut self, group: &[usize], places: &Buckets, terms: &Terms<'_>) -> Option<Offer> {
        let cells: Vec<Vector> = group.iter().map(|cell| self.swept.raster().center(*cell).coords).collect();
        let middle = Point::from(cells.iter().sum::<Vector>() / cells.len() as f64);
        let mut near: Vec<(f64, usize)> = places
            .near(middle, NEAR_M)
            .filter(|k| (1..self.sides.len()).contains(k))
            .map(|k| ((self.point(k) - middle).norm(), k))
            .filter(|(d, _)| *d < NEAR_M)
            .collect();
        near.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let bar_m = self.swept.raster().bar_m;
        let most_m2 = AND_BESIDE * group.len() as f64 * self.swept.raster().cell_m2();
        let mut best: Option<Offer> = None;
        for (_, k) in near.into_iter().take(PLACES) {
            let at = self.point(k);
            let Some(aside) = (middle - at).try_normalize(1e-6) else { continue };
            let stretches = BASES.map(|base| self.stretch(k, base));
            for to in ASIDE.map(|share| at + aside * (share * bar_m)) {
                if !(terms.is_wanted)(to) {
                    continue;
                }
                let Some(spot) = self.domain.spot(to) else { continue };
                for (base, stretch) in BASES.into_iter().zip(&stretches) {
                    let Some(stretch) = stretch else { continue };
                    let most = best.as_ref().map_or(terms.bend_m_per_m2, |best| best.rate);
                    let rate = self.rate(stretch, spot, terms, (most, most_m2)).filter(|rate| *rate < most);
                    best = rate.map(|rate| Offer { rate, at, base, to }).or(best);
                }
            }
        }
        best
    }

    /// The stretch that extends `base` sides of the path both ways from a point.
    fn stretch(&self, k: usize, base: usize) -> Option<Stretch> {
        let (from, past) = (k.checked_sub(base)?, k + base);
        if past > self.sides.len() {
            return None;
        }
        let (a, b) = (self.domain.spot(self.point(from))?, self.domain.spot(self.point(past))?);
        let course = self.course(from, past, &self.points(from..past));
        let swept = self.swept_by(self.around(from, past));
        Some(Stretch { from, past, course, a, b, swept })
    }

    /// The cost of a bend, in metres of path per square metre of floor gained. `None` if the bend is blocked, gains
    /// nothing, or would be too expensive even with the largest gain considered.
    fn rate(
        &mut self,
        old: &Stretch,
        to: Spot,
        terms: &Terms<'_>,
        (most_m_per_m2, most_m2): (f64, f64),
    ) -> Option<f64> {
        let way = [old.a.at, to.at, old.b.at];
        let new = self.course(old.from, old.past, &way);
        let cost_m = new.excess_m(old.course, terms.turn_m_per_rad);
        if cost_m > most_m_per_m2 * most_m2
            || !(self.domain.sees_between(old.a, to) && self.domain.sees_between(to, old.b))
        {
            return None;
        }
        let cell_m2 = self.swept.raster().cell_m2();
        let swept = self.swept_with(old.from, old.past, &way);
        // First a quick check of what the new path sweeps.
        let most_gained_m2 = f64::from(self.swept.count(0, &swept)) * cell_m2;
        if cost_m > most_m_per_m2 * most_gained_m2 {
            return None;
        }
        let gained = -self.swept.lost_by(&old.swept, &swept);
        (gained > 0).then(|| cost_m / (gained as f64 * cell_m2))
    }

    fn make_bend(&mut self, k: usize, old: &Stretch, to: Point) {
        let points = vec![self.point(old.from), to, self.point(old.past)];
        let swept = self.swept_with(old.from, old.past, &points);
        self.swept.exchange(&old.swept, &swept);
        let is_lane = self.sides[k].on_lane;
        self.splice(old.from, old.past, &[Piece { points, is_lane }]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::ReachableFloor;
    use crate::jobs::Job;
    use crate::slit_domain::SlitDomain;
    use crate::workspace::Workspace;
    use trials::tanks::{Known, Tank};

    #[test]
    fn a_lane_bends_to_a_strip_beside_it_and_only_as_far_as_it_pays() {
        // A straight lane through an empty tank with a notch of missed floor beside it.
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
        let workspace = Workspace::new(&tank.site(&[]), tank.anchor).unwrap();
        let domain = SlitDomain::new(&workspace, Vec::new()).unwrap();
        let strip =
            [Point::new(-1.0, 0.3), Point::new(1.0, 0.3), Point::new(1.0, 0.36), Point::new(-1.0, 0.36)];
        let floor = ReachableFloor::new(&domain, 0.05).within(&[&strip]);
        let points = vec![Point::new(-3.0, 0.0), Point::new(3.0, 0.0)];
        let bent = |bend_m_per_m2: f64| {
            let terms = Terms {
                turn_m_per_rad: 0.1,
                floor_m_per_m2: 15.0,
                bend_m_per_m2,
                enough: 1.0,
                keep: 0.0,
                is_wanted: &|_| true,
                job: &Job::default(),
            };
            let piece = Piece { points: points.clone(), is_lane: true };
            let mut track = Track::new(&domain, &[piece], |_| true, floor.clone());
            let before = track.coverage();
            let n = track.bend(&terms, &mut BTreeSet::new()).unwrap();
            (n, track.coverage() - before, track.points(0..track.sides.len()))
        };
        let (n, gained, points) = bent(40.0);
        assert!(n > 0 && gained > 0.3, "{n} bends gained {gained}");
        assert!(points.iter().all(|p| p.y.abs() < 0.4) && points.windows(2).all(|w| w[1].x > w[0].x));
        assert_eq!(bent(0.001).0, 0, "nothing is that cheap");
    }
}
