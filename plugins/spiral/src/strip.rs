//! Finds the cheapest path through a strip of offsets beside a course, by dynamic programming. The result decides on
//! which side each obstacle is passed.

use steering::{Room, room::MOST_SPARE_M};
use world::{Point, Vector};

/// Weight of the squared change in offset, relative to that of the squared offset.
const SLOPE_WEIGHT: f64 = 0.5;
const NOWHERE: u8 = u8::MAX;

/// A point of the course from which offsets are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Station {
    /// The point of the course.
    pub at: Point,
    /// Unit vector to the left of the course.
    pub left: Vector,
    /// The number of preset points that it represents.
    pub weight: f64,
}

/// Offsets that may not be used at a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bar {
    /// Index of the station.
    pub station: usize,
    /// First offset, metres to the left.
    pub from_m: f64,
    /// Last offset, metres to the left.
    pub to_m: f64,
}

/// The grid in which a path is searched for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strip<'a> {
    /// The stations, at least two.
    pub stations: &'a [Station],
    /// Distance between neighbouring offsets, metres.
    pub cell_m: f64,
    /// The number of offsets on either side of the course.
    pub half: usize,
    /// The maximum change in offset from one station to the next, cells.
    pub most_change: usize,
    /// Whether the path must begin on the course, and whether it must end on it.
    pub on_course: [bool; 2],
    /// The offsets that are closed.
    pub bars: &'a [Bar],
}

/// A path through a strip.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    /// The offset at every station, metres to the left.
    pub offsets_m: Vec<f64>,
    /// Weighted sum of the squared offsets and of the squared changes in offset, square metres.
    pub cost: f64,
}

/// The offsets of one station, and the cost of reaching each.
struct Front {
    places: Vec<Point>,
    spare_m: Vec<f64>,
    cost: Vec<f64>,
}

impl Strip<'_> {
    /// Finds the cheapest of the paths that keep their distance from everything.
    ///
    /// # Errors
    /// The index of the first station that no path reaches.
    pub(crate) fn cheapest(&self, room: &Room) -> Result<Way, usize> {
        let mut front = self.front(room, 0);
        for offset in 0..self.width() {
            let begins = !self.on_course[0] || offset == self.half;
            if begins && front.spare_m[offset] >= 0.0 {
                front.cost[offset] = self.stations[0].weight * self.offset_m(offset).powi(2);
            }
        }
        let mut back: Vec<Vec<u8>> = Vec::with_capacity(self.stations.len());
        for station in 1..self.stations.len() {
            let mut next = self.front(room, station);
            let came_from = self.reach(room, station, &front, &mut next);
            if next.cost.iter().all(|cost| cost.is_infinite()) {
                return Err(station);
            }
            back.push(came_from);
            front = next;
        }
        let ends = |offset: &usize| !self.on_course[1] || *offset == self.half;
        let reached = (0..self.width()).filter(ends).filter(|offset| front.cost[*offset].is_finite());
        let end = reached.min_by(|a, b| front.cost[*a].total_cmp(&front.cost[*b]));
        let end = end.ok_or(self.stations.len() - 1)?;
        Ok(Way { offsets_m: self.traced(end, &back), cost: front.cost[end] })
    }

    fn width(&self) -> usize {
        2 * self.half + 1
    }

    fn offset_m(&self, offset: usize) -> f64 {
        (offset as f64 - self.half as f64) * self.cell_m
    }

    /// Returns the offsets of a station, none of them reached yet; barred offsets have no free space.
    fn front(&self, room: &Room, station: usize) -> Front {
        let Station { at, left, .. } = self.stations[station];
        let places: Vec<Point> = (0..self.width()).map(|offset| at + left * self.offset_m(offset)).collect();
        let mut spare_m: Vec<f64> = places.iter().map(|place| room.spare_m(*place)).collect();
        for bar in self.bars.iter().filter(|bar| bar.station == station) {
            for (offset, spare_m) in spare_m.iter_mut().enumerate() {
                if (bar.from_m..=bar.to_m).contains(&self.offset_m(offset)) {
                    *spare_m = -1.0;
                }
            }
        }
        Front { places, spare_m, cost: vec![f64::INFINITY; self.width()] }
    }

    /// Computes the cost of each of a station's offsets; returns the previous station's offset from which each is
    /// reached.
    fn reach(&self, room: &Room, station: usize, front: &Front, next: &mut Front) -> Vec<u8> {
        let weight = self.stations[station].weight;
        let mut came_from = vec![NOWHERE; self.width()];
        for offset in (0..self.width()).filter(|offset| front.cost[*offset].is_finite()) {
            let last = (offset + self.most_change).min(self.width() - 1);
            let first = offset.saturating_sub(self.most_change);
            for (reached, came) in came_from.iter_mut().enumerate().take(last + 1).skip(first) {
                let offset_m = self.offset_m(reached);
                let moved_m = (reached as f64 - offset as f64) * self.cell_m;
                let price = weight * (offset_m * offset_m + SLOPE_WEIGHT * moved_m * moved_m);
                let cost = front.cost[offset] + price;
                if cost < next.cost[reached] && leads(room, (front, offset), (next, reached)) {
                    (next.cost[reached], *came) = (cost, offset as u8);
                }
            }
        }
        came_from
    }

    fn traced(&self, end: usize, back: &[Vec<u8>]) -> Vec<f64> {
        let mut offset = end;
        let mut offsets_m = vec![self.offset_m(end)];
        for came_from in back.iter().rev() {
            offset = came_from[offset] as usize;
            offsets_m.push(self.offset_m(offset));
        }
        offsets_m.reverse();
        offsets_m
    }
}

/// Whether the straight line between two places is free.
fn leads(room: &Room, (from, a): (&Front, usize), (to, b): (&Front, usize)) -> bool {
    if from.spare_m[a] < 0.0 || to.spare_m[b] < 0.0 {
        return false;
    }
    let length_m = (to.places[b] - from.places[a]).norm();
    // True if the free space around both ends covers the line.
    let is_covered = from.spare_m[a] + to.spare_m[b] > length_m && length_m < 2.0 * MOST_SPARE_M;
    is_covered || room.is_free(from.places[a], to.places[b])
}
