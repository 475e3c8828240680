//! Ties: short separate lanes over missed floor that is not worth a bend.

use crate::buckets::Buckets;
use crate::lanes::Lane;
use crate::polish::track::{Terms, Track};
use crate::scan::Piece;
use crate::touch_up::touch_up;
use crate::tuning::touch_ups::{LEAST_GAIN_M2, MOST_EXTRA_M, SIDES, TIE_M};
use planner_api::Result;
use world::{Point, Vector, polyline};

/// A lane that may be tied in.
struct Offer {
    /// The cost, in metres of path and turning per square metre of floor.
    rate: f64,
    lane: Lane,
}

/// The place where a lane is tied in.
pub(super) struct Tie {
    cost_m: f64,
    side: usize,
    tied: Tied,
}

/// A lane with the connectors to it and back to the path.
struct Tied {
    into: Vec<Point>,
    lane: Lane,
    out: Vec<Point>,
}

impl Tied {
    fn way(&self) -> Vec<Point> {
        [&self.into[..self.into.len() - 1], &self.lane, &self.out[1..]].concat()
    }
}

impl Track<'_> {
    /// Ties lanes over missed floor into the path, the most worthwhile first, until the required coverage is reached.
    /// Groups smaller than the minimum number of cells are skipped. Returns the number of lanes added.
    pub(super) fn tie_in_lanes(&mut self, terms: &Terms<'_>, least: usize) -> Result<usize> {
        if self.coverage() >= terms.enough {
            return Ok(0);
        }
        let mut offers: Vec<Offer> = Vec::new();
        let places = self.places();
        let missed = self.swept.missed();
        for (k, group) in missed.iter().take_while(|group| group.len() >= least).enumerate() {
            terms.job.check()?;
            terms.job.reached(k as f64 / missed.len() as f64);
            for lane in touch_up(self.domain, &self.swept, group) {
                if !lane.iter().all(|p| (terms.is_wanted)(*p)) {
                    continue;
                }
                if let Some(tie) = self.best_tie(&lane, terms, self.sides_near(&places, &lane)) {
                    let gained_m2 = self.swept.would_gain(&lane) as f64 * self.swept.raster().cell_m2();
                    offers.push(Offer { rate: tie.cost_m / gained_m2.max(1e-9), lane });
                }
            }
        }
        // Rounding must not turn four cells of 0.05 m into three.
        let least_gain = ((LEAST_GAIN_M2 / self.swept.raster().cell_m2() + 1e-6) as usize).max(1);
        offers.sort_by(|a, b| a.rate.total_cmp(&b.rate));
        let mut n_made = 0;
        for Offer { lane, .. } in offers {
            if self.coverage() >= terms.enough {
                break;
            }
            // Lanes tied in since then may have left little to scan.
            let Some(tie) = self.best_tie(&lane, terms, 0..self.sides.len()) else { continue };
            if self.swept.would_gain(&lane) >= least_gain {
                self.tie(tie);
                n_made += 1;
            }
        }
        Ok(n_made)
    }

    /// Sides that begin or end near an end of a lane, and some others.
    fn sides_near(&self, places: &Buckets, lane: &Lane) -> Vec<usize> {
        let ends = [lane[0], lane[lane.len() - 1]];
        let points = ends.iter().flat_map(|end| places.near(*end, TIE_M));
        let mut sides: Vec<usize> = points.flat_map(|k| k.saturating_sub(1)..=k).collect();
        sides.retain(|side| *side < self.sides.len());
        sides.sort_unstable();
        sides.dedup();
        sides
    }

    /// The best place among some sides to tie in a lane, in either direction.
    pub(super) fn best_tie(
        &self,
        lane: &Lane,
        terms: &Terms<'_>,
        among: impl IntoIterator<Item = usize>,
    ) -> Option<Tie> {
        let (a, b) = (lane[0], lane[lane.len() - 1]);
        // Checking the box around both ends leaves few points to measure.
        let reach = Vector::new(TIE_M, TIE_M) * 1.001;
        let (low, high) = (a.inf(&b) - reach, a.sup(&b) + reach);
        let near = |p: Point| {
            let is_near = low.x < p.x && p.x < high.x && low.y < p.y && p.y < high.y;
            if is_near { (p - a).norm().min((p - b).norm()) } else { f64::INFINITY }
        };
        let mut sides: Vec<(f64, usize)> = among
            .into_iter()
            .map(|side| (near(self.point(side)).min(near(self.point(side + 1))), side))
            .filter(|(d, _)| *d < TIE_M)
            .collect();
        sides.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let reversed: Lane = lane.iter().rev().copied().collect();
        let mut best: Option<Tie> = None;
        for (_, side) in sides.into_iter().take(SIDES) {
            let old = self.course(side, side + 1, &self.points(side..side + 1));
            for lane in [lane, &reversed] {
                let tied = self.tied(side, lane)?;
                let cost_m = self.course(side, side + 1, &tied.way()).excess_m(old, terms.turn_m_per_rad);
                if best.as_ref().is_none_or(|best| cost_m < best.cost_m) {
                    best = Some(Tie { cost_m, side, tied });
                }
            }
        }
        best.filter(|best| best.cost_m < MOST_EXTRA_M + polyline::length_m(lane))
    }

    fn tied(&self, side: usize, lane: &Lane) -> Option<Tied> {
        let into = self.domain.path(self.point(side), lane[0])?;
        let out = self.domain.path(lane[lane.len() - 1], self.point(side + 1))?;
        Some(Tied { into, lane: lane.clone(), out })
    }

    pub(super) fn tie(&mut self, Tie { side, tied, .. }: Tie) {
        let way = tied.way();
        let (old, new) = (self.swept_by(self.around(side, side + 1)), self.swept_with(side, side + 1, &way));
        self.swept.exchange(&old, &new);
        let Tied { into, lane, out } = tied;
        let pieces =
            [(into, false), (lane, true), (out, false)].map(|(points, is_lane)| Piece { points, is_lane });
        self.splice(side, side + 1, &pieces);
    }
}
