//! New cuts for obstacles found during a mission: one from every cluster that the current plan's cuts do not connect to
//! the wall.

use crate::cuts::cluster::Cluster;
use crate::cuts::forest::to_wall_m;
use crate::inflation::SLACK_M;
use crate::plane::{direction, meets};
use crate::tuning::repair::{COST_PER_M, RAYS};
use crate::workspace::Workspace;
use geometry::convex::{Part, crossing};
use world::{Point, Vector, polyline};

/// Distance by which a cut extends beyond the cut that it meets, so that no gap is left between them, metres.
const BEYOND_M: f64 = 1e-4;

/// The existing cuts, the tether and the path that new cuts must take into account.
pub(crate) struct Extension<'a> {
    pub workspace: &'a Workspace,
    /// The cuts of the current plan.
    pub cuts: &'a [Vec<Point>],
    /// The tether as it lies: no new cut may cross it.
    pub tether: &'a [Point],
    /// The rest of the path: a new cut crosses it as rarely as possible.
    pub path: &'a [(Point, Point)],
}

impl Extension<'_> {
    /// Makes new cuts, starting with the outermost cluster, each within the given angle of the ray from the anchor.
    /// Returns `None` if no cut is possible for one of the clusters.
    pub(crate) fn new_cuts(&self, angle_rad: f64) -> Option<Vec<Vec<Point>>> {
        let clusters = Cluster::all(self.workspace);
        let mut loose: Vec<&Cluster> = clusters.iter().filter(|cluster| !self.is_rooted(cluster)).collect();
        loose.sort_by(|a, b| b.rho_m.total_cmp(&a.rho_m));
        let mut made: Vec<Vec<Point>> = Vec::new();
        while let Some((cluster, rest)) = loose.split_first() {
            let line = self.new_cut(cluster, rest, &made, angle_rad)?;
            made.push(line);
            loose.remove(0);
        }
        Some(made)
    }

    /// Whether a cluster is already connected to the wall, directly or by existing cuts.
    fn is_rooted(&self, cluster: &Cluster) -> bool {
        let meets = |cut: &[Point], part: &Part| {
            cut.windows(2).any(|w| part.segment_distance_m(w[0], w[1]) < self.workspace.keep_m)
        };
        let parts = || cluster.parts.iter().map(|k| &self.workspace.parts[*k]);
        cluster.is_at_wall || self.cuts.iter().any(|cut| parts().any(|part| meets(cut, part)))
    }

    fn new_cut(
        &self,
        from: &Cluster,
        loose: &[&Cluster],
        made: &[Vec<Point>],
        most_rad: f64,
    ) -> Option<Vec<Point>> {
        let outward = (from.foot - self.workspace.anchor).try_normalize(1e-9).unwrap_or_else(Vector::x);
        let angle_rad = |k: i32| outward.y.atan2(outward.x) + most_rad * f64::from(k) / f64::from(RAYS);
        let lines = (-RAYS..=RAYS).filter_map(|k| self.along(from, direction(angle_rad(k)), loose, made));
        let is_clear = |line: &Vec<Point>| !line.windows(2).any(|side| meets(self.tether, side[0], side[1]));
        let priced = lines.filter(is_clear).map(|line| (self.cost(&line), line));
        priced.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, line)| line)
    }

    /// A cut in a given direction, up to the wall or another cut, or into a connected obstacle; `None` if an
    /// unconnected obstacle is in the way.
    fn along(
        &self,
        from: &Cluster,
        ahead: Vector,
        loose: &[&Cluster],
        made: &[Vec<Point>],
    ) -> Option<Vec<Point>> {
        let (foot, workspace) = (from.foot, self.workspace);
        let wall_m = to_wall_m(&workspace.wall, foot, ahead);
        let at_wall = foot + ahead * wall_m;
        let sides = self.cuts.iter().chain(made).flat_map(|cut| cut.windows(2));
        let hits = sides.filter_map(|side| crossing(foot, at_wall, side[0], side[1]));
        let cut_m = hits.map(|hit| (hit - foot).norm()).fold(f64::INFINITY, f64::min);
        let far_m = wall_m.min(cut_m + BEYOND_M);
        let others = (0..workspace.parts.len()).filter(|k| !from.parts.contains(k));
        let entered = others.filter_map(|k| Some((self.entered_m(k, foot, ahead, far_m)?, k)));
        let first = entered.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some((entered_m, k)) = first else { return Some(vec![foot, foot + ahead * far_m]) };
        let is_loose = loose.iter().any(|cluster| cluster.parts.contains(&k));
        (!is_loose).then(|| vec![foot, foot + ahead * entered_m, workspace.parts[k].middle()])
    }

    /// The distance along a ray to the point where it comes too close to a part for the hull; `None` if the ray stays
    /// clear.
    fn entered_m(&self, part: usize, foot: Point, ahead: Vector, far_m: f64) -> Option<f64> {
        let (part, room_m) = (&self.workspace.parts[part], self.workspace.keep_m + 2.0 * SLACK_M);
        if part.segment_distance_m(foot, foot + ahead * far_m) > room_m {
            return None;
        }
        // The ray can always advance by the spare distance: no point of the part is any closer.
        let mut along_m = 0.0;
        while along_m < far_m {
            let spare_m = part.distance(foot + ahead * along_m).0 - room_m;
            if spare_m <= SLACK_M {
                break;
            }
            along_m += spare_m;
        }
        Some(along_m.min(far_m))
    }

    /// The cost of a cut, in broken lanes.
    fn cost(&self, line: &[Point]) -> f64 {
        let is_crossed = |(a, b): &&(Point, Point)| meets(line, *a, *b);
        let broken = self.path.iter().filter(is_crossed).count();
        broken as f64 + COST_PER_M * polyline::length_m(line)
    }
}

/// Variants of the current plan's cuts. In each variant, one cut is shortened to end at an obstacle found in its way.
/// When the cuts were made, they avoided all known obstacles except those at their ends.
pub(crate) fn cuts_up_to_found(workspace: &Workspace, cuts: &[Vec<Point>]) -> Vec<Vec<Vec<Point>>> {
    let shortened = |k: usize| {
        let ends = workspace.parts.iter().filter_map(move |part| up_to(part, &cuts[k], workspace.keep_m));
        ends.map(move |cut| [&cuts[..k], &[cut], &cuts[k + 1..]].concat())
    };
    (0..cuts.len()).flat_map(shortened).collect()
}

/// The cut, shortened to end at the centre of a part in its way; `None` if the part is too close to an end of the cut,
/// or not close to the cut at all.
fn up_to(part: &Part, cut: &[Point], keep_m: f64) -> Option<Vec<Point>> {
    let is_in = |at: &Point| part.distance(*at).0 < keep_m;
    if cut.first().is_some_and(is_in) || cut.last().is_some_and(is_in) {
        return None;
    }
    let side = cut.windows(2).position(|w| part.segment_distance_m(w[0], w[1]) < keep_m)?;
    let beside = polyline::nearest_on_segment(cut[side], cut[side + 1], part.middle());
    Some([&cut[..=side], &[beside, part.middle()]].concat())
}
