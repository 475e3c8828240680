//! Bends: the path goes a little aside to where it would miss floor, wherever that is cheaper than a lane of its own.

use super::{Places, Prices, Track};
use crate::{floor::Run, side_by_side::Stop, slit::Spot};
use planner_api::Result;
use world::{Point, Vector};

/// Bends are tried at path points within this distance of missed floor, metres.
const NEAR_M: f64 = 0.75;
/// So many of them.
const PLACES: usize = 5;
/// Sides of the path that a bend replaces on either side of its point.
const BASES: [usize; 3] = [1, 2, 4];
/// How far a bend goes aside, as a share of the swath.
const ASIDE: [f64; 4] = [0.1, 0.2, 0.35, 0.55];

/// A bend that may pay.
struct Offer {
    /// Metres of path and turning for a square metre of floor.
    rate: f64,
    at: Point,
    base: usize,
    to: Point,
}

/// A stretch of the path that a bend may replace.
struct Stretch {
    from: usize,
    past: usize,
    length_m: f64,
    turn_rad: f64,
    /// Its ends.
    a: Spot,
    b: Spot,
    /// What it sweeps, with a side before and behind.
    swept: Vec<Run>,
}

impl Track<'_> {
    /// Bends the path to missed floor until the coverage is reached, as long as a square metre costs no more than
    /// `most_m_per_m2`; groups of fewer cells than the least are left. Returns the number of bends.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn bend(
        &mut self,
        is_wanted: &dyn Fn(Point) -> bool,
        prices: &Prices,
        (enough, least): (f64, usize),
        most_m_per_m2: f64,
        stop: &Stop,
    ) -> Result<usize> {
        let mut offers: Vec<Offer> = Vec::new();
        let places = Places::new(&self.points);
        let missed = self.grid.missed();
        for (k, group) in missed.iter().enumerate() {
            if group.len() < least {
                break;
            }
            stop.check()?;
            stop.reached(k as f64 / missed.len() as f64);
            offers.extend(self.best_bend(group, &places, is_wanted, prices, most_m_per_m2));
        }
        offers.sort_by(|a, b| a.rate.total_cmp(&b.rate));
        let mut made = 0;
        for Offer { at, base, to, .. } in offers {
            if self.grid.coverage() >= enough {
                break;
            }
            let Some(k) = self.points.iter().position(|p| *p == at) else { continue };
            let Some(stretch) = self.stretch(k, base) else { continue };
            let Some(spot) = self.slit.spot(to) else { continue };
            let still = self.rate(&stretch, spot, prices, f64::INFINITY);
            if still.is_some_and(|rate| rate <= most_m_per_m2) {
                self.make(k, &stretch, to);
                made += 1;
            }
        }
        Ok(made)
    }

    fn best_bend(
        &mut self,
        group: &[usize],
        places: &Places,
        is_wanted: &dyn Fn(Point) -> bool,
        prices: &Prices,
        most_m_per_m2: f64,
    ) -> Option<Offer> {
        let cells: Vec<Vector> = group.iter().map(|cell| self.grid.center(*cell).coords).collect();
        let middle = Point::from(cells.iter().sum::<Vector>() / cells.len() as f64);
        let mut near: Vec<(f64, usize)> = places
            .near(middle, NEAR_M)
            .filter(|k| (1..self.points.len() - 1).contains(k))
            .map(|k| ((self.points[k] - middle).norm(), k))
            .filter(|(d, _)| *d < NEAR_M)
            .collect();
        near.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let bar_m = self.grid.bar_m();
        let mut best: Option<Offer> = None;
        for (_, k) in near.into_iter().take(PLACES) {
            let at = self.points[k];
            let Some(aside) = (middle - at).try_normalize(1e-6) else { continue };
            let stretches = BASES.map(|base| self.stretch(k, base));
            for share in ASIDE {
                let to = at + aside * (share * bar_m);
                if !is_wanted(to) {
                    continue;
                }
                let Some(spot) = self.slit.spot(to) else { continue };
                for (base, stretch) in BASES.into_iter().zip(&stretches) {
                    let Some(stretch) = stretch else { continue };
                    let most = best.as_ref().map_or(most_m_per_m2, |b| b.rate);
                    if let Some(rate) = self.rate(stretch, spot, prices, most)
                        && rate < most
                    {
                        best = Some(Offer { rate, at, base, to });
                    }
                }
            }
        }
        best
    }

    /// So many sides of the path on either side of a point.
    fn stretch(&self, k: usize, base: usize) -> Option<Stretch> {
        let (from, past) = (k.checked_sub(base)?, k + base);
        if past >= self.points.len() {
            return None;
        }
        let (a, b) = (self.slit.spot(self.points[from])?, self.slit.spot(self.points[past])?);
        let (length_m, turn_rad) = self.measure(from, past, &self.points[from..=past]);
        let swept = self.swept_by(self.around(from, past));
        Some(Stretch { from, past, length_m, turn_rad, a, b, swept })
    }

    /// What a square metre of floor would cost, metres; `None` where the way is barred, nothing is gained, or it surely
    /// costs more than so much.
    fn rate(&mut self, old: &Stretch, to: Spot, prices: &Prices, most_m_per_m2: f64) -> Option<f64> {
        if !(self.slit.sees_between(old.a, to) && self.slit.sees_between(to, old.b)) {
            return None;
        }
        let way = [old.a.0, to.0, old.b.0];
        let (new_m, new_rad) = self.measure(old.from, old.past, &way);
        let cost_m = new_m - old.length_m + prices.turn_m_per_rad * (new_rad - old.turn_rad);
        let cell_m2 = self.grid.cell_m * self.grid.cell_m;
        let swept = self.swept_with(old.from, old.past, &way);
        // A quick look at what the new way sweeps first.
        let most_gained = f64::from(self.grid.missed_under(&swept)) * cell_m2;
        if cost_m > most_m_per_m2 * most_gained {
            return None;
        }
        let gained = -self.grid.lost_by(&old.swept, &swept);
        (gained > 0).then(|| cost_m / (gained as f64 * cell_m2))
    }

    fn make(&mut self, k: usize, old: &Stretch, to: Point) {
        let way = vec![self.points[old.from], to, self.points[old.past]];
        let swept = self.swept_with(old.from, old.past, &way);
        self.grid.exchange(&old.swept, &swept);
        let on_lane = self.sides[k].on_lane;
        self.splice(old.from, old.past, &[(way, on_lane)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{floor::FloorGrid, ground::Ground, scan::Piece, side_by_side::Stop, slit::Slit};
    use trials::tanks::{Known, Tank};

    /// A straight lane through an empty tank with a notch of missed floor beside it.
    fn lane() -> (Ground, Slit) {
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
        let ground = Ground::new(&tank.site(&[]), tank.anchor).unwrap();
        let slit = Slit::new(&ground, &[], ground.home()).unwrap();
        (ground, slit)
    }

    #[test]
    fn a_lane_bends_to_a_strip_beside_it_and_only_as_far_as_it_pays() {
        let (ground, slit) = lane();
        let mut grid = FloorGrid::new(&ground, &slit, 0.05);
        let strip =
            [Point::new(-1.0, 0.3), Point::new(1.0, 0.3), Point::new(1.0, 0.36), Point::new(-1.0, 0.36)];
        grid.keep_within(&[&strip]);
        let points = vec![Point::new(-3.0, 0.0), Point::new(3.0, 0.0)];
        let prices = Prices { turn_m_per_rad: 0.1, floor_m_per_m2: 15.0 };
        let bent = |most_m_per_m2: f64| {
            let mut track =
                Track::new(&slit, &[Piece { points: points.clone(), is_lane: true }], grid.clone());
            let before = track.grid.coverage();
            let n = track.bend(&|_| true, &prices, (1.0, 1), most_m_per_m2, &Stop::default()).unwrap();
            (n, track.grid.coverage() - before, track.points)
        };
        let (n, gained, points) = bent(40.0);
        assert!(n > 0 && gained > 0.3, "{n} bends gained {gained}");
        assert!(points.iter().all(|p| p.y.abs() < 0.4) && points.windows(2).all(|w| w[1].x > w[0].x));
        assert_eq!(bent(0.001).0, 0, "nothing is that cheap");
    }
}
