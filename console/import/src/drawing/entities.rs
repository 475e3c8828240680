//! What a drawing holds, in metres and with its blocks taken apart.

use dxf::{
    Drawing,
    entities::{Entity, EntityType, Insert},
};
use nalgebra::Affine2;
use std::collections::HashMap;
use world::{Point, Vector};

/// Blocks within blocks are followed this far.
const DEEPEST: usize = 16;
/// Longest arc between two points of a curve, radians.
const STEP_RAD: f64 = 0.1;

/// An outline, metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Outline {
    Circle { center: Point, radius_m: f64 },
    Chain { points: Vec<Point>, is_closed: bool, width_m: f64 },
}

/// An entity, or why it is none that can be used.
pub(super) struct Drawn {
    pub layer: String,
    /// What programs call it.
    pub kind: String,
    pub outline: Result<Outline, ()>,
}

/// Everything in the model space of a drawing with some metres to the unit.
pub(super) fn all(drawing: &Drawing, unit_m: f64) -> Vec<Drawn> {
    let blocks: HashMap<&str, &dxf::Block> =
        drawing.blocks().map(|block| (block.name.as_str(), block)).collect();
    let mut found = Vec::new();
    let place = Place { map: scaling(unit_m, unit_m), layer: None };
    for entity in drawing.entities().filter(|entity| !entity.common.is_in_paper_space) {
        collect(entity, &blocks, &place, 0, &mut found);
    }
    found
}

/// Where a block is put.
struct Place {
    map: Affine2<f64>,
    layer: Option<String>,
}

fn scaling(x: f64, y: f64) -> Affine2<f64> {
    Affine2::from_matrix_unchecked(nalgebra::Matrix3::new_nonuniform_scaling(&Vector::new(x, y)))
}

fn collect(
    entity: &Entity,
    blocks: &HashMap<&str, &dxf::Block>,
    place: &Place,
    depth: usize,
    found: &mut Vec<Drawn>,
) {
    let own = &entity.common.layer;
    let layer = place.layer.as_ref().filter(|_| own == "0").unwrap_or(own).clone();
    if let EntityType::Insert(insert) = &entity.specific
        && let Some(block) = blocks.get(insert.name.as_str())
        && depth < DEEPEST
    {
        for shift in copies(insert) {
            let base = Vector::new(block.base_point.x, block.base_point.y);
            let at = Vector::new(insert.location.x, insert.location.y);
            let turn = nalgebra::Rotation2::new(insert.rotation.to_radians());
            let inner = nalgebra::Translation2::from(at)
                * turn
                * nalgebra::Translation2::from(shift)
                * scaling(insert.x_scale_factor, insert.y_scale_factor)
                * nalgebra::Translation2::from(-base);
            let place = Place { map: place.map * inner, layer: Some(layer.clone()) };
            for entity in &block.entities {
                collect(entity, blocks, &place, depth + 1, found);
            }
        }
        return;
    }
    let debug = format!("{:?}", entity.specific);
    let kind = debug.split(['(', ' ']).next().unwrap_or_default().to_owned();
    found.push(Drawn { layer, kind, outline: outline(&entity.specific, &place.map).ok_or(()) });
}

/// Where the rows and columns of an insertion lie.
fn copies(insert: &Insert) -> impl Iterator<Item = Vector> + '_ {
    let count = |n: i16| i32::from(n).clamp(1, 1000);
    let columns = move |row: i32| (0..count(insert.column_count)).map(move |column| (column, row));
    (0..count(insert.row_count)).flat_map(columns).map(|(column, row)| {
        Vector::new(f64::from(column) * insert.column_spacing, f64::from(row) * insert.row_spacing)
    })
}

fn outline(entity: &EntityType, map: &Affine2<f64>) -> Option<Outline> {
    let at = |p: &dxf::Point| map * Point::new(p.x, p.y);
    let scale = map.matrix().fixed_view::<2, 2>(0, 0).determinant().abs().sqrt();
    let open = |points| Some(Outline::Chain { points, is_closed: false, width_m: 0.0 });
    match entity {
        EntityType::Circle(circle) if is_even(map) => {
            let center = Point::new(mirrored(circle.normal.z) * circle.center.x, circle.center.y);
            Some(Outline::Circle { center: map * center, radius_m: circle.radius * scale })
        }
        EntityType::Circle(circle) => {
            let center = Point::new(mirrored(circle.normal.z) * circle.center.x, circle.center.y);
            let points =
                arc(center, circle.radius, 0.0, 360.0).into_iter().skip(1).map(|p| map * p).collect();
            Some(Outline::Chain { points, is_closed: true, width_m: 0.0 })
        }
        EntityType::Arc(drawn) => {
            let side = mirrored(drawn.normal.z);
            let center = Point::new(drawn.center.x, drawn.center.y);
            let points = arc(center, drawn.radius, drawn.start_angle, drawn.end_angle);
            open(points.into_iter().map(|p| map * Point::new(side * p.x, p.y)).collect())
        }
        EntityType::Line(line) => open(vec![at(&line.p1), at(&line.p2)]),
        EntityType::LwPolyline(line) => {
            let side = mirrored(line.extrusion_direction.z);
            let bent: Vec<(Point, f64)> =
                line.vertices.iter().map(|v| (Point::new(v.x, v.y), v.bulge)).collect();
            let own_width = line.vertices.iter().map(|v| v.starting_width).fold(0.0, f64::max);
            let points = chain(&bent, line.is_closed()).into_iter();
            let points = points.map(|p| map * Point::new(side * p.x, p.y)).collect();
            let width_m = line.constant_width.max(own_width) * scale;
            Some(Outline::Chain { points, is_closed: line.is_closed(), width_m })
        }
        EntityType::Polyline(line) => {
            let side = mirrored(line.normal.z);
            let bent: Vec<(Point, f64)> =
                line.vertices().map(|v| (Point::new(v.location.x, v.location.y), v.bulge)).collect();
            let points = chain(&bent, line.is_closed()).into_iter();
            let points = points.map(|p| map * Point::new(side * p.x, p.y)).collect();
            let width_m = line.default_starting_width * scale;
            Some(Outline::Chain { points, is_closed: line.is_closed(), width_m })
        }
        _ => None,
    }
}

/// Entities drawn from below have x to the other side.
fn mirrored(normal_z: f64) -> f64 {
    if normal_z < 0.0 { -1.0 } else { 1.0 }
}

/// Whether a map keeps circles round.
fn is_even(map: &Affine2<f64>) -> bool {
    let linear = map.matrix().fixed_view::<2, 2>(0, 0).into_owned();
    let (x, y) = (linear.column(0).norm(), linear.column(1).norm());
    (x - y).abs() < 1e-9 * x.max(y) && linear.column(0).dot(&linear.column(1)).abs() < 1e-9 * x * y
}

/// Points of an arc counter-clockwise, angles in degrees.
fn arc(center: Point, radius: f64, from_deg: f64, to_deg: f64) -> Vec<Point> {
    let from = from_deg.to_radians();
    let sweep = (to_deg - from_deg).rem_euclid(360.0).to_radians();
    let sweep = if sweep < 1e-9 { std::f64::consts::TAU } else { sweep };
    along_arc(center, radius, from, sweep)
}

fn along_arc(center: Point, radius: f64, from: f64, sweep: f64) -> Vec<Point> {
    let n = (sweep.abs() / STEP_RAD).ceil().max(1.0) as usize;
    let point = |k: usize| {
        let angle = from + sweep * k as f64 / n as f64;
        center + Vector::new(angle.cos(), angle.sin()) * radius
    };
    (0..=n).map(point).collect()
}

/// Points of a polyline; a bulge is the tangent of a quarter of the arc to the next vertex.
fn chain(vertices: &[(Point, f64)], is_closed: bool) -> Vec<Point> {
    let n = vertices.len();
    let mut points = Vec::new();
    for (k, (here, bulge)) in vertices.iter().enumerate() {
        points.push(*here);
        let is_last = k + 1 == n;
        if bulge.abs() < 1e-9 || (is_last && !is_closed) {
            continue;
        }
        let next = vertices[(k + 1) % n].0;
        let (chord, sweep) = (next - here, 4.0 * bulge.atan());
        let apothem = chord.norm() / 2.0 / (sweep / 2.0).tan();
        let across = Vector::new(-chord.y, chord.x).try_normalize(1e-12).unwrap_or_else(Vector::zeros);
        let center = nalgebra::center(here, &next) + across * apothem;
        let off = here - center;
        let arc = along_arc(center, off.norm(), off.y.atan2(off.x), sweep);
        points.extend(&arc[1..arc.len() - 1]);
    }
    points
}
