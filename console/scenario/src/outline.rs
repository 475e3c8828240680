//! Reads outlines of obstacles and zones, and polygons.

use super::{problem::Complaint, section::Section};
use import::plan::MOST_CORNERS;
use world::{Point, Shape, shape::ring_area_m2};

/// Keys that only some kinds of outline use.
const KEYS: [&str; 7] =
    ["center_m", "radius_m", "size_m", "heading_deg", "vertices_m", "points_m", "width_m"];

/// Reads an outline; the key `word_key` states what kind it is.
pub(crate) fn outline(section: &Section<'_>, word_key: &str) -> Option<Shape> {
    let kind = section.word(word_key)?;
    let used: &[&str] = match kind {
        "circle" => &["center_m", "radius_m"],
        "box" => &["center_m", "size_m", "heading_deg"],
        "polygon" => &["vertices_m"],
        _ => &["points_m", "width_m"],
    };
    let unused: Vec<&str> = KEYS.into_iter().filter(|key| !used.contains(key)).collect();
    let beside = format!("{word_key} = \"{kind}\"");
    section.refuse(&unused, &beside);
    for key in used.iter().filter(|key| **key != "heading_deg") {
        section.require(key, &format!("{beside} needs {}", used.join(", ")));
    }
    match kind {
        "circle" => circle(section),
        "box" => rectangle(section),
        "polygon" => polygon(section),
        _ => polyline(section),
    }
}

fn circle(section: &Section<'_>) -> Option<Shape> {
    let (center, radius_m) = (section.point("center_m"), section.number("radius_m"));
    Some(Shape::Disc { center: center?, radius_m: radius_m? })
}

fn rectangle(section: &Section<'_>) -> Option<Shape> {
    let (center, size) = (section.point("center_m"), section.pair("size_m"));
    let heading_deg = section.number("heading_deg");
    let (center, [width, depth]) = (center?, size?);
    let tank_from_box = nalgebra::Isometry2::new(center.coords, heading_deg?.to_radians());
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(x, y)| tank_from_box * Point::new(x * width / 2.0, y * depth / 2.0);
    Some(Shape::Polygon { vertices: corners.map(corner).to_vec() })
}

fn polygon(section: &Section<'_>) -> Option<Shape> {
    let vertices = counter_clockwise(section, "vertices_m")?;
    if let Some(dent) = dent(&vertices) {
        section.complain("vertices_m", Complaint::NotConvex { at: (dent.x, dent.y) });
        return None;
    }
    Some(Shape::Polygon { vertices })
}

fn polyline(section: &Section<'_>) -> Option<Shape> {
    let (points, width_m) = (section.points("points_m"), section.number("width_m"));
    let mut points = points?;
    points.dedup();
    if points.len() < 2 {
        section.complain("points_m", Complaint::Flat);
        return None;
    }
    Some(Shape::Polyline { points, half_width_m: width_m? / 2.0 })
}

/// The corners of a simple polygon in counter-clockwise order.
pub(crate) fn counter_clockwise(section: &Section<'_>, name: &str) -> Option<Vec<Point>> {
    let mut vertices = section.points(name)?;
    vertices.dedup();
    if vertices.len() > 1 && vertices.first() == vertices.last() {
        vertices.pop();
    }
    if vertices.len() > MOST_CORNERS {
        let (points, limit) = (vertices.len() as u64, MOST_CORNERS as u64);
        section.complain(name, Complaint::TooManyPoints { points, limit });
        return None;
    }
    let area_m2 = ring_area_m2(&vertices);
    let complaint = match crossing(&vertices) {
        Some((first, second)) => Complaint::CrossingSides { first: first + 1, second: second + 1 },
        None if area_m2.abs() < 1e-6 => Complaint::Flat,
        None => {
            if area_m2 < 0.0 {
                vertices.reverse();
            }
            return Some(vertices);
        }
    };
    section.complain(name, complaint);
    None
}

/// The first two sides of a closed polygon that cross, if any.
fn crossing(vertices: &[Point]) -> Option<(usize, usize)> {
    let n = vertices.len();
    let side = |i: usize| (vertices[i], vertices[(i + 1) % n]);
    let apart = |i: usize, j: usize| j > i + 1 && !(i == 0 && j == n - 1);
    (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).find(|&(i, j)| apart(i, j) && cross(side(i), side(j)))
}

fn cross((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let turn = |p: Point, q: Point, r: Point| (q - p).perp(&(r - p));
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

/// The first inward corner of a counter-clockwise polygon, if any.
fn dent(vertices: &[Point]) -> Option<Point> {
    let n = vertices.len();
    (0..n).find_map(|i| {
        let (before, at, after) = (vertices[(i + n - 1) % n], vertices[i], vertices[(i + 1) % n]);
        let (arriving, leaving) = (at - before, after - at);
        (arriving.perp(&leaving) < -1e-9 * arriving.norm() * leaving.norm()).then_some(at)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn a_bow_tie_crosses_itself() {
        assert_eq!(crossing(&ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])), Some((0, 2)));
        assert_eq!(crossing(&ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])), None);
    }

    #[test]
    fn an_arrowhead_has_a_dent() {
        assert_eq!(
            dent(&ring(&[(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)])),
            Some(Point::new(0.5, 1.0))
        );
        assert_eq!(dent(&ring(&[(0.0, 0.0), (2.0, 1.0), (0.0, 2.0)])), None);
    }
}
