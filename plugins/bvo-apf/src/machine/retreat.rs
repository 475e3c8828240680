//! Retreats from a trap along the robot's own track, and seals the mouth of the trap.

use super::{Machine, News, Next, Phase};
use crate::{mouth::Mouth, view::View};
use std::{collections::BTreeSet, f64::consts::PI};
use world::Point;

/// Distance after which the trap is examined again during a retreat, metres.
const LOOK_BACK_M: f64 = 0.05;

/// A retreat in progress.
#[derive(Debug, Clone)]
pub struct Retreat {
    pub(super) ids: BTreeSet<u32>,
    pub(super) members: Vec<usize>,
    pub(super) mouth: Option<Mouth>,
    pub(super) looked: Option<Point>,
}

impl Machine {
    pub(super) fn retreat(&mut self, at: Point, goal: Point) -> Next {
        let hull_m = self.map.hull_m;
        let Phase::Retreat(retreat) = &mut self.phase else { return Next::Nowhere };
        let is_at_start = self.trail.is_empty();
        if let Some(back) = self.trail.last()
            && retreat.looked.is_some_and(|from| (from - at).norm() < LOOK_BACK_M)
        {
            let back = *back;
            self.trail.pop();
            return Next::Back(back);
        }
        retreat.looked = Some(at);
        let view = View::of(at, &self.map, &retreat.members, hull_m);
        let out = view.and_then(|view| match retreat.mouth {
            Some(mouth) if mouth.is_withdrawn(at, hull_m, view.gap_rad) => Some(mouth),
            _ if is_at_start && view.gap_rad >= PI => Some(Mouth::from_outside(at, &view)),
            // Deep inside a spiral, an apparent mouth may not be the real one.
            seen => Mouth::left_behind(at, &view, seen.is_some()),
        });
        if let Some(mouth) = out {
            let ids = retreat.ids.clone();
            self.seal(at, goal, &mouth);
            let members = self.clusters.closure(&self.map, &ids);
            self.go_round(at, goal, members, false);
            return self.next(at, goal);
        }
        if let Some(back) = self.trail.pop() {
            return Next::Back(back);
        }
        // The robot started inside the trap: it has no track to follow, and a seal would shut it in.
        let members = retreat.members.clone();
        self.go_round(at, goal, members, true);
        self.next(at, goal)
    }

    fn seal(&mut self, at: Point, goal: Point, mouth: &Mouth) {
        let circles = mouth.circles(&self.map, at, goal, self.next_id);
        self.news.push(News::Sealed { circles: circles.len() });
        self.next_id += circles.len() as u32;
        self.map.solids.extend(circles);
        self.clusters.take_in(&self.map, self.settings.margin_m);
        self.clusters_changed();
    }
}
