//! Seams and names of plates on a map.

use super::sheet::Sheet;
use world::{
    Boundary, DrawnPlate, Floor, PlateKind, PlateLayout, PlateMap, Point,
    shape::{bounds_of, mean_of},
};

/// The seams of the plates of a floor, and the positions of their names.
pub(crate) struct PlateLines {
    seams: Vec<Vec<Point>>,
    names: Vec<PlateName>,
}

struct PlateName {
    name: String,
    at: Point,
    /// Rotation, degrees clockwise on the paper.
    turn_deg: f64,
    /// Extent of the plate, metres.
    room_m: [f64; 2],
}

/// Number of cells of a plate, sum of their centres, and corners of their bounding box; metres.
type Sum = (usize, Point, Option<(Point, Point)>);

impl PlateLines {
    /// Builds the outlines and names of drawn plates.
    pub(crate) fn of_outlines(plates: &[DrawnPlate]) -> Self {
        let name = |plate: &DrawnPlate| {
            let (low, high) = bounds_of(&plate.vertices_m);
            PlateName {
                name: plate.name.clone(),
                at: mean_of(&plate.vertices_m),
                turn_deg: 0.0,
                room_m: [high.x - low.x, high.y - low.y],
            }
        };
        Self {
            seams: plates.iter().map(DrawnPlate::outline).collect(),
            names: plates.iter().map(name).collect(),
        }
    }

    /// The names with their positions in the tank frame, each on its own plate.
    pub(crate) fn names(&self) -> impl Iterator<Item = (&str, Point)> {
        self.names.iter().map(|plate| (plate.name.as_str(), plate.at))
    }

    /// Builds the seams and names of a plate layout on a floor.
    pub(crate) fn new(layout: &PlateLayout, boundary: &Boundary, floor: &Floor, map: &PlateMap) -> Self {
        let mut sums: Vec<Sum> = vec![(0, Point::origin(), None); map.plates.len()];
        for cell in 0..floor.len() {
            let Some(plate) = map.plate_of(cell) else { continue };
            let (center, (count, sum, bounds)) = (floor.center(cell), &mut sums[plate]);
            *count += 1;
            *sum += center.coords;
            *bounds =
                Some(bounds.map_or((center, center), |(low, high)| (low.inf(&center), high.sup(&center))));
        }
        let name = |(number, (plate, (count, sum, bounds))): (usize, (&world::Plate, &Sum))| {
            let mean = on_plate(floor, map, number, Point::from(sum.coords / (*count).max(1) as f64));
            let extent = bounds.map_or([0.0, 0.0], |(low, high)| [high.x - low.x, high.y - low.y]);
            match (boundary, layout) {
                // The name runs along the ring.
                (Boundary::Circle { radius_m }, PlateLayout::Regular(sizes))
                    if plate.kind == PlateKind::Annular =>
                {
                    let angle = mean.y.atan2(mean.x);
                    let at = radius_m - sizes.annular_m / 2.0;
                    let turn = if angle.sin() >= 0.0 { 90.0 } else { 270.0 } - angle.to_degrees();
                    let arc_m = std::f64::consts::TAU * radius_m / f64::from(sizes.n_annular.max(1));
                    let at = Point::new(at * angle.cos(), at * angle.sin());
                    PlateName {
                        name: plate.name.clone(),
                        at,
                        turn_deg: turn,
                        room_m: [arc_m, sizes.annular_m],
                    }
                }
                _ => PlateName { name: plate.name.clone(), at: mean, turn_deg: 0.0, room_m: extent },
            }
        };
        Self {
            seams: layout.seams(boundary),
            names: map.plates.iter().zip(&sums).enumerate().map(name).collect(),
        }
    }
}

/// The point of the plate that is nearest to a given point, because the centroid of an L-shaped plate lies outside
/// the plate.
fn on_plate(floor: &Floor, map: &PlateMap, plate: usize, at: Point) -> Point {
    let is_on = |cell: &usize| map.plate_of(*cell) == Some(plate);
    if floor.cell_at(at).as_ref().is_some_and(is_on) {
        return at;
    }
    let off_m = |cell: &usize| (floor.center(*cell) - at).norm();
    let nearest = (0..floor.len()).filter(is_on).min_by(|a, b| off_m(a).total_cmp(&off_m(b)));
    nearest.map_or(at, |cell| floor.center(cell))
}

impl Sheet {
    /// The seams of the plates.
    pub(crate) fn plates(&mut self, plates: Option<&PlateLines>) {
        for seam in plates.iter().flat_map(|plates| &plates.seams) {
            self.line(seam, r##"stroke="#7D8A93" stroke-width=".13""##);
        }
    }

    /// Draws the names that fit on their plates, with letters of the given height in millimetres; returns their
    /// boxes.
    pub(crate) fn plate_names(&mut self, plates: Option<&PlateLines>, letters_mm: f64) -> Vec<[Point; 2]> {
        let mut boxes = Vec::new();
        self.draw(format_args!(r#"<g class="pn" text-anchor="middle" font-size="{letters_mm}">"#));
        for plate in plates.iter().flat_map(|plates| &plates.names) {
            let [width_mm, height_mm] = plate.room_m.map(|m| m * self.scale);
            let needed_mm = 0.62 * letters_mm * plate.name.chars().count() as f64;
            if width_mm < needed_mm || height_mm < 0.8 * letters_mm {
                continue;
            }
            let (at, letters) = (self.at(plate.at), letters_mm.min(0.8 * height_mm));
            self.draw(format_args!(
                r#"<text x="{x:.2}" y="{y:.2}" transform="rotate({:.1} {x:.2} {y:.2})" dy=".35em" font-size="{letters:.2}">{}</text>"#,
                plate.turn_deg,
                foreign::markup(&plate.name),
                x = at.x,
                y = at.y
            ));
            boxes.push([at - world::Vector::new(4.0, 1.3), at + world::Vector::new(4.0, 1.3)]);
        }
        self.draw("</g>");
        boxes
    }
}
