//! Marks of indications on the coverage map.

use super::indications::Indication;
use crate::drawing::sheet::{Sheet, colour};
use world::{Point, Vector};

/// Fill and stroke of a mark.
pub(super) const STYLE: &str = r##"fill="#fff" stroke-width=".5""##;
/// Radius of a mark on paper, and the smaller radius used for more than [`MANY`] marks so that they do not hide the
/// map; millimetres.
const RADIUS_MM: f64 = 1.0;
const SMALL_MM: f64 = 0.4;
const MANY: usize = 200;
/// Half the height of a number, and half the width of one of its digits, millimetres.
const HALF_MM: (f64, f64) = (1.2, 0.75);

/// The marks that were drawn.
pub(super) struct Marks {
    /// South-west and north-east corners of marks and numbers, millimetres.
    pub(super) boxes: Vec<[Point; 2]>,
    /// Number of indications whose number did not fit.
    pub(super) unnumbered: u64,
}

/// Marks indications, each with its number where space allows. `names` are the boxes around names, which numbers must
/// not cover.
pub(super) fn draw(sheet: &mut Sheet, indications: &[Indication], names: &[[Point; 2]]) -> Marks {
    let radius_mm = if indications.len() > MANY { SMALL_MM } else { RADIUS_MM };
    // Draw all marks first, because a number must not cover a later mark either.
    let of_mark = |found: &Indication| {
        let (at, half) = (sheet.at(found.at), Vector::repeat(radius_mm + 0.2));
        [at - half, at + half]
    };
    let mut boxes: Vec<[Point; 2]> = indications.iter().map(of_mark).chain(names.iter().copied()).collect();
    let purple = colour::TETHER;
    for found in indications {
        sheet.circle(found.at, radius_mm, &format!("{STYLE} stroke=\"{purple}\""));
    }
    let mut unnumbered = 0;
    for found in indications {
        let name = format!("I{}", found.number);
        let half = Vector::new(HALF_MM.1 * name.len() as f64, HALF_MM.0);
        let Some(place) = beside(sheet.at(found.at), radius_mm, half, &boxes) else {
            unnumbered += 1;
            continue;
        };
        boxes.push([place - half, place + half]);
        sheet.draw(format_args!(
            r#"<text class="st" x="{:.2}" y="{:.2}" dy=".35em" text-anchor="middle" font-size="2.3" font-weight="700" fill="{purple}">{name}</text>"#,
            place.x, place.y
        ));
    }
    Marks { boxes, unnumbered }
}

/// The first free position beside a mark for a number of the given half size: right, left, above, below.
pub(super) fn beside(at: Point, radius_mm: f64, half: Vector, boxes: &[[Point; 2]]) -> Option<Point> {
    let off = half + Vector::repeat(radius_mm + 0.4);
    let places = [(1.0, 0.0), (-1.0, 0.0), (0.0, -1.0), (0.0, 1.0)]
        .map(|(x, y)| at + Vector::new(x * off.x, y * off.y));
    let is_free = |place: &Point| {
        let (west_south, east_north) = (place - half, place + half);
        let covers = |[low, high]: &[Point; 2]| {
            west_south.x < high.x && low.x < east_north.x && west_south.y < high.y && low.y < east_north.y
        };
        !boxes.iter().any(covers)
    };
    places.into_iter().find(is_free)
}
