//! The entities of a drawing, in metres, with all blocks expanded.

use super::{
    curves::{along_arc, arc, chain, ellipse, spline, through},
    groups::{Block, Drawing, Entity},
    hatch, labels,
};
use nalgebra::{Affine2, Rotation2, Translation2};
use std::{collections::HashMap, f64::consts::TAU};
use world::{Point, Vector};

/// The deepest nesting of blocks that is expanded.
const DEEPEST: usize = 16;
/// The largest number of entities and insertions that are processed. Nested insertions can make even a small file
/// expand without end.
pub(super) const MOST: usize = 1_000_000;

/// An outline in metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Outline {
    Circle { center: Point, radius_m: f64 },
    Chain { points: Vec<Point>, is_closed: bool, width_m: f64 },
}

/// An entity with its outlines; `outlines` is empty if none can be used.
pub(super) struct Drawn {
    pub layer: String,
    /// The name of its type in DXF.
    pub kind: String,
    pub outlines: Vec<Outline>,
    /// The text, and its position in metres.
    pub label: Option<(Point, String)>,
}

/// Expands everything in the model space of a drawing; `None` if there are more than [`MOST`] entities. `unit_m` is the
/// size of the drawing's unit in metres.
pub(super) fn all(drawing: &Drawing, unit_m: f64) -> Option<Vec<Drawn>> {
    let blocks = drawing.blocks.iter();
    // Names in drawings are not case-sensitive.
    let blocks: Blocks<'_> =
        blocks.map(|block| (block.head.text(2).unwrap_or_default().to_uppercase(), block)).collect();
    let mut unfolded = Unfolded { found: Vec::new(), n_left: MOST };
    let place = Place { map: scaling(unit_m, unit_m), layer: None };
    // Code 67 is 1 for entities in paper space.
    for entity in drawing.entities.iter().filter(|entity| entity.number(67, 0.0) < 0.5) {
        collect(entity, &blocks, &place, 0, &mut unfolded)?;
    }
    Some(unfolded.found)
}

/// The entities found so far.
struct Unfolded {
    found: Vec<Drawn>,
    /// The number of entities and insertions that may still be processed.
    n_left: usize,
}

impl Unfolded {
    fn count(&mut self) -> Option<()> {
        self.n_left = self.n_left.checked_sub(1)?;
        Some(())
    }
}

type Blocks<'a> = HashMap<String, &'a Block>;

/// The placement of a block.
struct Place {
    map: Affine2<f64>,
    layer: Option<String>,
}

fn scaling(x: f64, y: f64) -> Affine2<f64> {
    Affine2::from_matrix_unchecked(nalgebra::Matrix3::new_nonuniform_scaling(&Vector::new(x, y)))
}

/// Adds an entity, or the contents of the block that it inserts; `None` if there are too many entities.
fn collect(
    entity: &Entity,
    blocks: &Blocks<'_>,
    place: &Place,
    depth: usize,
    unfolded: &mut Unfolded,
) -> Option<()> {
    unfolded.count()?;
    let own = entity.text(8).unwrap_or("0");
    let layer = place.layer.as_deref().filter(|_| own == "0").unwrap_or(own).to_owned();
    if entity.kind == "INSERT" {
        attributes(entity, &layer, &place.map, unfolded)?;
    }
    let block = entity.text(2).filter(|_| entity.kind == "INSERT");
    let block = block.and_then(|name| blocks.get(&name.to_uppercase()));
    let Some(block) = block.filter(|_| depth < DEEPEST) else {
        let outlines = outlines(entity, &place.map);
        let label = label(entity, &place.map);
        unfolded.found.push(Drawn { layer, kind: entity.kind.clone(), outlines, label });
        return Some(());
    };
    let at = Vector::new(entity.number(10, 0.0), entity.number(20, 0.0));
    let base = Vector::new(block.head.number(10, 0.0), block.head.number(20, 0.0));
    for shift in copies(entity) {
        unfolded.count()?;
        let inner = mirroring(entity.number(230, 1.0))
            * Translation2::from(at)
            * Rotation2::new(entity.number(50, 0.0).to_radians())
            * Translation2::from(shift)
            * scaling(entity.number(41, 1.0), entity.number(42, 1.0))
            * Translation2::from(-base);
        let place = Place { map: place.map * inner, layer: Some(layer.clone()) };
        for entity in &block.entities {
            collect(entity, blocks, &place, depth + 1, unfolded)?;
        }
    }
    Some(())
}

/// Adds the attributes of an insertion. One attribute serves as the name of the insertion: the first attribute with a
/// name tag or, if there is none, the first attribute.
fn attributes(insert: &Entity, layer: &str, map: &Affine2<f64>, unfolded: &mut Unfolded) -> Option<()> {
    let naming = insert.parts.iter().position(labels::is_name_tag).unwrap_or(0);
    for (index, attribute) in insert.parts.iter().enumerate() {
        unfolded.count()?;
        let own = attribute.text(8).filter(|own| *own != "0").unwrap_or(layer);
        unfolded.found.push(Drawn {
            layer: own.to_owned(),
            kind: attribute.kind.clone(),
            outlines: Vec::new(),
            label: label(attribute, map).filter(|_| index == naming),
        });
    }
    Some(())
}

/// The offsets of the rows and columns of an insertion.
fn copies(insert: &Entity) -> impl Iterator<Item = Vector> {
    let count = |code: i32| insert.number(code, 1.0).clamp(1.0, 1000.0) as usize;
    let (columns, rows) = (count(70), count(71));
    let (dx, dy) = (insert.number(44, 0.0), insert.number(45, 0.0));
    (0..columns * rows).map(move |k| Vector::new((k % columns) as f64 * dx, (k / columns) as f64 * dy))
}

/// The text of an entity and its position.
fn label(entity: &Entity, map: &Affine2<f64>) -> Option<(Point, String)> {
    let text = labels::text(entity)?;
    let is_aligned = [72, 73, 74].iter().any(|code| entity.number(*code, 0.0) > 0.5);
    if entity.kind == "MTEXT" || !is_aligned {
        let at = Point::new(entity.number(10, 0.0), entity.number(20, 0.0));
        let map = if entity.kind == "MTEXT" { *map } else { *map * mirroring(entity.number(230, 1.0)) };
        return Some((map * at, text));
    }
    // A text that is not left-aligned has a second point, which is its position.
    let [x, y] = [(11, 10), (21, 20)].map(|(own, first)| entity.number(own, entity.number(first, 0.0)));
    Some((*map * mirroring(entity.number(230, 1.0)) * Point::new(x, y), text))
}

fn outlines(entity: &Entity, map: &Affine2<f64>) -> Vec<Outline> {
    if entity.kind == "HATCH" {
        let in_plane = *map * mirroring(entity.number(230, 1.0));
        let placed = |ring: Vec<Point>| ring.into_iter().map(|point| in_plane * point).collect();
        let rings = hatch::rings(entity.groups()).into_iter();
        return rings
            .map(|ring| Outline::Chain { points: placed(ring), is_closed: true, width_m: 0.0 })
            .collect();
    }
    outline(entity, map).into_iter().collect()
}

fn outline(entity: &Entity, map: &Affine2<f64>) -> Option<Outline> {
    let at = |x: i32, y: i32| Some(Point::new(entity.numbers(x).next()?, entity.numbers(y).next()?));
    // LINE entities use the coordinates of the drawing; all other entities use those of their own plane.
    let in_plane = *map * mirroring(entity.number(230, 1.0));
    let scale = map.matrix().fixed_view::<2, 2>(0, 0).determinant().abs().sqrt();
    let chain_of = |points: Vec<Point>, map: &Affine2<f64>, is_closed: bool| {
        let points: Vec<Point> = points.into_iter().map(|point| map * point).collect();
        (points.len() > 1).then_some(Outline::Chain { points, is_closed, width_m: 0.0 })
    };
    match entity.kind.as_str() {
        "LINE" => chain_of(vec![at(10, 20)?, at(11, 21)?], map, false),
        "CIRCLE" => {
            let (center, radius) = (at(10, 20)?, entity.number(40, 0.0));
            if radius <= 0.0 {
                return None;
            }
            if is_even(map) {
                return Some(Outline::Circle { center: in_plane * center, radius_m: radius * scale });
            }
            chain_of(along_arc(center, radius, 0.0, TAU).split_off(1), &in_plane, true)
        }
        "ARC" => {
            let angles_deg = [entity.number(50, 0.0), entity.number(51, 360.0)];
            chain_of(arc(at(10, 20)?, entity.number(40, 0.0), angles_deg), &in_plane, false)
        }
        // In the coordinates of the drawing: the centre, the long semi-axis as a vector from there, and the ratio of
        // the semi-axes.
        "ELLIPSE" => {
            let ends = [entity.number(41, 0.0), entity.number(42, TAU)];
            let (points, is_closed) = ellipse(at(10, 20)?, at(11, 21)?.coords, entity.number(40, 1.0), ends);
            chain_of(points, map, is_closed)
        }
        "LWPOLYLINE" | "POLYLINE" => polyline(entity, &in_plane, scale),
        "SPLINE" => {
            let by_controls = entity.spline();
            let points = if by_controls.controls.is_empty() {
                through(&entity.points(11, 21))
            } else {
                spline(&by_controls)?
            };
            chain_of(points, map, entity.has_flag(1))
        }
        // Corners of a filled area; the last two are swapped.
        "SOLID" | "TRACE" => {
            let mut corners = vec![at(10, 20)?, at(11, 21)?];
            corners.extend([at(13, 23), at(12, 22)].into_iter().flatten());
            chain_of(corners, &in_plane, true)
        }
        _ => None,
    }
}

fn polyline(entity: &Entity, in_plane: &Affine2<f64>, scale: f64) -> Option<Outline> {
    let of_vertex = |v: &Entity| [v.number(10, 0.0), v.number(20, 0.0), v.number(42, 0.0)];
    let corners = match entity.kind.as_str() {
        "POLYLINE" => entity.parts.iter().map(of_vertex).collect(),
        _ => entity.corners(),
    };
    let corners: Vec<(Point, f64)> =
        corners.iter().map(|[x, y, bulge]| (Point::new(*x, *y), *bulge)).collect();
    let is_closed = entity.has_flag(1);
    // One width for all stretches, or a width at the start of each stretch.
    let width = entity.numbers(43).chain(entity.numbers(40)).fold(0.0, f64::max);
    let points: Vec<Point> = chain(&corners, is_closed).iter().map(|point| in_plane * point).collect();
    (points.len() > 1).then_some(Outline::Chain { points, is_closed, width_m: width * scale })
}

/// In a plane that is seen from below, x points in the opposite direction.
fn mirroring(normal_z: f64) -> Affine2<f64> {
    scaling(if normal_z < 0.0 { -1.0 } else { 1.0 }, 1.0)
}

/// Whether a transformation maps circles to circles.
fn is_even(map: &Affine2<f64>) -> bool {
    let linear = map.matrix().fixed_view::<2, 2>(0, 0).into_owned();
    let (x, y) = (linear.column(0).norm(), linear.column(1).norm());
    (x - y).abs() < 1e-9 * x.max(y) && linear.column(0).dot(&linear.column(1)).abs() < 1e-9 * x * y
}
