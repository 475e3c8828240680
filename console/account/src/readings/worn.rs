//! The true thickness of a floor with many losses.

use world::{FloorWear, MetalLoss, Point};

/// Edge of a square in which losses are looked up, metres.
const SQUARE_M: f64 = 0.5;

/// A floor whose losses are found by place.
#[derive(Debug, Clone)]
pub(super) struct Worn {
    wear: FloorWear,
    /// South-west corner of the first square.
    low: Point,
    /// Number of squares from west to east.
    width: usize,
    /// The losses that reach into each square, by their index, row by row.
    near: Vec<Vec<usize>>,
}

impl Worn {
    pub(super) fn new(wear: FloorWear) -> Self {
        let corner = |loss: &MetalLoss, sign: f64| {
            let reach_m = sign * loss.radius_m;
            Point::new(loss.at.x + reach_m, loss.at.y + reach_m)
        };
        let lows = wear.losses.iter().map(|loss| corner(loss, -1.0));
        let highs = wear.losses.iter().map(|loss| corner(loss, 1.0));
        let low = lows.reduce(|a, b| a.inf(&b)).unwrap_or_else(Point::origin);
        let high = highs.reduce(|a, b| a.sup(&b)).unwrap_or_else(Point::origin);
        let count = |span_m: f64| (span_m / SQUARE_M) as usize + 1;
        let (width, height) = (count(high.x - low.x), count(high.y - low.y));
        let mut worn = Self { low, width, near: vec![Vec::new(); width * height], wear };
        for index in 0..worn.wear.losses.len() {
            let ends = [-1.0, 1.0].map(|sign| worn.place(corner(&worn.wear.losses[index], sign)));
            let [Some((west, south)), Some((east, north))] = ends else { continue };
            for square in (south..=north).flat_map(|row| (west..=east).map(move |x| row * width + x)) {
                worn.near[square].push(index);
            }
        }
        worn
    }

    /// The column and the row of the square under a place; `None` where no loss can be.
    fn place(&self, place: Point) -> Option<(usize, usize)> {
        let off = (place - self.low) / SQUARE_M;
        let is_in = off.x >= 0.0 && off.y >= 0.0 && off.x < self.width as f64;
        is_in.then_some((off.x as usize, off.y as usize))
    }

    /// The thickness that is left at a place, millimetres.
    pub(super) fn left_mm(&self, place: Point) -> f64 {
        let square = self.place(place).map(|(column, row)| row * self.width + column);
        let near = square.and_then(|square| self.near.get(square)).into_iter().flatten();
        self.wear.left_mm_among(near.map(|index| &self.wear.losses[*index]), place)
    }

    pub(super) fn wear(&self) -> &FloorWear {
        &self.wear
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use world::{LossProfile, PlateSide};

    proptest! {
        #[test]
        fn looking_up_by_square_gives_the_thickness_among_all_losses(
            places in proptest::collection::vec((-4.0..4.0_f64, -4.0..4.0_f64, 0.01..1.5_f64, 0.1..4.0_f64), 0..12),
            asked in proptest::collection::vec((-6.0..6.0_f64, -6.0..6.0_f64), 1..60),
        ) {
            let loss = |(k, (x, y, radius_m, depth_mm)): (usize, &(f64, f64, f64, f64))| MetalLoss {
                at: Point::new(*x, *y),
                radius_m: *radius_m,
                depth_mm: *depth_mm,
                profile: if k % 2 == 0 { LossProfile::Pit } else { LossProfile::Thinning },
                side: if k % 3 == 0 { PlateSide::Top } else { PlateSide::Underside },
            };
            let losses: Vec<MetalLoss> = places.iter().enumerate().map(loss).collect();
            let wear = FloorWear { thickness_mm: 8.0, losses };
            let worn = Worn::new(wear.clone());
            let middles = places.iter().map(|(x, y, ..)| (*x, *y));
            for (x, y) in asked.into_iter().chain(middles) {
                let place = Point::new(x, y);
                prop_assert_eq!(worn.left_mm(place).to_bits(), wear.left_mm(place).to_bits());
            }
        }
    }
}
