//! Chooses the side on which the robot passes whatever blocks the path: the side of the smaller detour. The chosen side
//! is then kept.
//!
//! In Wang et al. 2023, the robot turns counter-clockwise around single points. That pushes the robot back at half of
//! the points, and cancels out between two of them. Here, obstacles with no passage between them, or to the wall, are
//! bypassed as one.

use crate::{
    blockage::{Blockage, View},
    side::Side,
};
use geometry::Point;
use std::collections::BTreeSet;

/// Time for which a side is kept after the path has become free, seconds.
const KEPT_S: f64 = 2.0;

/// The obstacles to bypass, and the side.
#[derive(Debug, Clone, PartialEq)]
pub struct Detour {
    /// Ids of the obstacles to bypass as one.
    pub members: BTreeSet<u32>,
    /// Lines that close the narrow gaps between the obstacles.
    pub closed: Vec<(Point, Point)>,
    /// The side on which to pass the obstacles.
    pub side: Side,
}

/// Chooses a side once for each group of obstacles that blocks the path.
#[derive(Debug, Clone, Default)]
pub struct Detours {
    kept: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    members: BTreeSet<u32>,
    side: Side,
    seen_s: f64,
    /// Whether the wall has been considered. After that, the wall does not change the side again, because left and
    /// right of the path swap as the robot goes around.
    knows_wall: bool,
}

impl Detours {
    /// Returns what blocks the path to the target now, if anything, and the side on which to pass it.
    pub fn update(&mut self, view: &View<'_>) -> Option<Detour> {
        self.kept = self.kept.take().filter(|kept| view.tick.t_s - kept.seen_s < KEPT_S);
        let blockage = Blockage::of(view)?;
        let side = self.side(&blockage, view);
        let same = self.kept.as_ref().is_some_and(|kept| kept.knows_wall && kept.concerns(&blockage));
        let knows_wall = same || !blockage.dead_ends.is_empty();
        self.kept = Some(Kept { members: blockage.members.clone(), side, seen_s: view.tick.t_s, knows_wall });
        Some(Detour { members: blockage.members, closed: blockage.closed, side })
    }

    /// Switches to the other side because the current one led nowhere.
    pub fn flip(&mut self) {
        if let Some(kept) = &mut self.kept {
            kept.side = kept.side.other();
        }
    }

    fn side(&self, blockage: &Blockage, view: &View<'_>) -> Side {
        let kept = self.kept.as_ref().filter(|kept| kept.concerns(blockage));
        let Some(kept) = kept else { return blockage.shorter_side(view) };
        let is_dead_end = |side: Side| blockage.dead_ends.contains(&side);
        let leads_nowhere = is_dead_end(kept.side) && !is_dead_end(kept.side.other());
        if leads_nowhere && !kept.knows_wall { kept.side.other() } else { kept.side }
    }
}

impl Kept {
    fn concerns(&self, blockage: &Blockage) -> bool {
        !self.members.is_disjoint(&blockage.members)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{body::Body, tick::Tick};
    use geometry::{Boundary, Vector};
    use planner_api::{Outline, PoseEstimate};

    fn columns(places: &[(f64, f64)]) -> Vec<Body> {
        let column = |(id, (x, y)): (usize, &(f64, f64))| {
            let outline = Outline::Disc { center: Point::new(*x, *y), radius_m: 0.2 };
            Body::new(id as u32, &outline).expect("a disc has extent")
        };
        places.iter().enumerate().map(column).collect()
    }

    const WALL: Boundary = Boundary::Circle { radius_m: 10.0 };

    fn northward(bodies: &[Body], at: Point) -> Tick<'_> {
        let heading_rad = std::f64::consts::FRAC_PI_2;
        let pose = PoseEstimate { position: at, heading_rad, covariance: nalgebra::Matrix3::zeros() };
        Tick { t_s: 0.0, pose, target: at + Vector::new(0.0, 2.0), is_last: true, bodies }
    }

    fn update(detours: &mut Detours, tick: &Tick<'_>) -> Option<Detour> {
        detours.update(&View { tick, wall: &WALL, hull_m: 0.25, keep_m: 0.1 })
    }

    #[test]
    fn a_free_way_needs_no_detour() {
        let bodies = columns(&[(1.0, 1.0)]);
        assert_eq!(update(&mut Detours::default(), &northward(&bodies, Point::origin())), None);
    }

    #[test]
    fn it_passes_on_the_side_of_the_smaller_detour() {
        let bodies = columns(&[(0.1, 1.0)]);
        let detour = update(&mut Detours::default(), &northward(&bodies, Point::origin())).expect("blocked");
        // The column stands a little to the right, so it stays on the right hand.
        assert_eq!(detour.side, Side::Left);
    }

    #[test]
    fn columns_without_a_passage_are_gone_round_as_one() {
        let bodies = columns(&[(-0.4, 1.0), (0.4, 1.0), (1.3, 1.0), (4.0, 1.0)]);
        let detour = update(&mut Detours::default(), &northward(&bodies, Point::origin())).expect("blocked");
        assert_eq!(detour.members, BTreeSet::from([0, 1, 2]));
        assert_eq!((detour.closed.len(), detour.side), (2, Side::Left));
    }

    #[test]
    fn no_detour_leads_between_a_column_and_the_wall() {
        // The smaller detour would be on the right, where the wall is.
        let bodies = columns(&[(9.2, 1.0)]);
        let detour =
            update(&mut Detours::default(), &northward(&bodies, Point::new(9.3, 0.0))).expect("blocked");
        assert_eq!(detour.side, Side::Left);
    }

    #[test]
    fn a_side_is_kept_until_it_is_flipped() {
        let bodies = columns(&[(0.1, 1.0)]);
        let mut detours = Detours::default();
        update(&mut detours, &northward(&bodies, Point::origin()));
        let moved = northward(&bodies, Point::new(0.2, 0.0));
        assert_eq!(update(&mut detours, &moved).map(|d| d.side), Some(Side::Left));
        detours.flip();
        assert_eq!(update(&mut detours, &moved).map(|d| d.side), Some(Side::Right));
    }
}
