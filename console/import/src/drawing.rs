//! Floor drawings as DXF.
//!
//! Layers say what is what: SHELL, COLUMNS, PIPES, SUMP and NOGO; a layer counts if one word of its name is one of these, in
//! the singular or the plural. Blocks are taken apart, with the layer of their insertion for what lies on layer 0.

mod entities;
mod groups;
mod rings;

use crate::{
    error::ImportError,
    plan::{FloorPlan, Named, convex, round},
};
use entities::{Drawn, Outline};
use groups::Drawing;
use std::{collections::BTreeMap, path::Path};
use world::{Boundary, Point, Shape, Vector, shape::ring_area_m2};

/// Width of pipes that are drawn as lines, metres.
pub const PIPE_WIDTH_M: f64 = 0.1;

/// What a layer holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Role {
    Shell,
    Columns,
    Pipes,
    Sump,
    NoGo,
    Plates,
}

/// What to assume where a drawing says nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assumed {
    /// Metres to the unit of a drawing whose header names no unit.
    pub unit_m: Option<f64>,
    /// Width of pipes that are drawn as lines, metres.
    pub pipe_width_m: f64,
}

/// Reads a drawing.
///
/// # Errors
/// It is no DXF, names no unit and none is assumed, or has no closed outline on layer SHELL.
pub fn read(file: &Path, assumed: Assumed) -> Result<FloorPlan, ImportError> {
    let of_file = |what: String| ImportError::of_file(file, what);
    let drawing = Drawing::read(file)?;
    let units = drawing.units.and_then(metres);
    let unit_m = units.or(assumed.unit_m).ok_or_else(|| {
        of_file(
            "the header ($INSUNITS) names no unit of length; state it with --units, as in --units mm".into(),
        )
    })?;
    let mut notes = Vec::new();
    if units.is_none() {
        notes.push(format!("the drawing names no unit; one unit was taken as {unit_m} m"));
    }
    let mut by_role: BTreeMap<Role, Vec<Drawn>> = BTreeMap::new();
    let mut unused: BTreeMap<String, usize> = BTreeMap::new();
    let all = entities::all(&drawing, unit_m).ok_or_else(|| {
        of_file(format!(
            "more than {} entities, those of inserted blocks included; keep the layers of the floor only",
            entities::MOST
        ))
    })?;
    for drawn in all {
        match (role_of(&drawn.layer), &drawn.outline) {
            (Some(Role::Plates) | None, _) | (_, None) => {
                *unused.entry(format!("layer {}: {}", drawn.layer, drawn.kind)).or_default() += 1;
            }
            (Some(role), Some(_)) => by_role.entry(role).or_default().push(drawn),
        }
    }
    notes.extend(unused.into_iter().map(|(what, n)| format!("not used: {what}, {n} of them")));
    let mut take = |role| by_role.remove(&role).unwrap_or_default();
    let (boundary, center) = shell(take(Role::Shell), &mut notes).ok_or_else(|| {
        of_file(
            "no circle and no closed outline on a layer SHELL; draw the inner side of the shell there".into(),
        )
    })?;
    let moved = |shape: Shape| shape.transformed(&nalgebra::Isometry2::new(-center, 0.0));
    let areas = |role, name: &str, all: Vec<Drawn>, notes: &mut Vec<String>| -> Vec<Named> {
        let shapes = closed(role, name, all, notes).into_iter().enumerate();
        shapes.map(|(k, shape)| Named { name: format!("{name} {}", k + 1), shape: moved(shape) }).collect()
    };
    let mut obstacles = areas(Role::Columns, "column", take(Role::Columns), &mut notes);
    let pipes = pipes(take(Role::Pipes), assumed.pipe_width_m, &mut notes).into_iter().enumerate();
    obstacles.extend(pipes.map(|(k, shape)| Named { name: format!("pipe {}", k + 1), shape: moved(shape) }));
    let mut no_go = areas(Role::Sump, "sump", take(Role::Sump), &mut notes);
    no_go.extend(areas(Role::NoGo, "no-go area", take(Role::NoGo), &mut notes));
    obstacles.retain(|named| {
        let (low, high) = named.shape.bounds();
        let is_inside = boundary.meets_box(low, high);
        if !is_inside {
            notes.push(format!("{} lies outside the shell and is left out", named.name));
        }
        is_inside
    });
    Ok(FloorPlan { boundary, obstacles, no_go, notes })
}

/// The role of a layer, by one word of its name.
fn role_of(layer: &str) -> Option<Role> {
    let upper = layer.to_uppercase();
    let whole = upper.replace(['-', '_', ' '], "");
    let words = upper.split(|c: char| !c.is_alphanumeric()).chain([whole.as_str()]);
    words.map(|word| word.strip_suffix('S').unwrap_or(word)).find_map(|word| match word {
        "SHELL" => Some(Role::Shell),
        "COLUMN" => Some(Role::Columns),
        "PIPE" => Some(Role::Pipes),
        "SUMP" => Some(Role::Sump),
        "NOGO" => Some(Role::NoGo),
        "PLATE" => Some(Role::Plates),
        _ => None,
    })
}

/// Metres to a unit by its number in `$INSUNITS`, if it is one of length that drawings have.
fn metres(units: i32) -> Option<f64> {
    match units {
        1 => Some(0.0254),
        2 => Some(0.3048),
        4 => Some(1e-3),
        5 => Some(1e-2),
        6 => Some(1.0),
        10 => Some(0.9144),
        14 => Some(0.1),
        _ => None,
    }
}

/// The largest closed outline, and what is its centre if it is round.
fn shell(drawn: Vec<Drawn>, notes: &mut Vec<String>) -> Option<(Boundary, Vector)> {
    let (circles, chains) = parted(drawn);
    let (mut rings, open) = rings::closed(chains);
    if !open.is_empty() {
        notes.push(format!("SHELL: {} lines that close no outline are left out", open.len()));
    }
    let mut round_ones: Vec<(Point, f64)> = circles;
    rings.retain(|ring| match round(ring) {
        Some((center, least_m, _)) => {
            round_ones.push((center, least_m));
            false
        }
        None => true,
    });
    let n = rings.len() + round_ones.len();
    if n > 1 {
        notes.push(format!("SHELL: {n} closed outlines; the largest is the shell"));
    }
    let circle = round_ones.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let ring = rings.into_iter().max_by(|a, b| ring_area_m2(a).abs().total_cmp(&ring_area_m2(b).abs()));
    let circle_m2 = circle.map_or(0.0, |(_, radius_m)| std::f64::consts::PI * radius_m * radius_m);
    match (circle, ring) {
        (Some((center, radius_m)), ring)
            if ring.as_ref().is_none_or(|ring| ring_area_m2(ring).abs() < circle_m2) =>
        {
            Some((Boundary::Circle { radius_m }, center.coords))
        }
        (_, Some(mut vertices)) => {
            if ring_area_m2(&vertices) < 0.0 {
                vertices.reverse();
            }
            Some((Boundary::Polygon { vertices }, Vector::zeros()))
        }
        (_, None) => None,
    }
}

/// Circles and closed outlines as convex shapes.
fn closed(role: Role, name: &str, drawn: Vec<Drawn>, notes: &mut Vec<String>) -> Vec<Shape> {
    let (circles, chains) = parted(drawn);
    let (rings, open) = rings::closed(chains);
    if !open.is_empty() {
        notes.push(format!("{role:?}: {} lines that close no outline are left out", open.len()));
    }
    let mut shapes: Vec<Shape> =
        circles.into_iter().map(|(center, radius_m)| Shape::Disc { center, radius_m }).collect();
    for ring in rings {
        let (shape, grew) = convex(&ring);
        shapes.push(shape);
        if grew {
            notes.push(format!("{name} {} is not convex; its convex hull was taken", shapes.len()));
        }
    }
    shapes
}

fn pipes(drawn: Vec<Drawn>, assumed_m: f64, notes: &mut Vec<String>) -> Vec<Shape> {
    let mut n_thin = 0;
    let mut shape = |drawn: Drawn| match drawn.outline? {
        Outline::Circle { center, radius_m } => Some(Shape::Disc { center, radius_m }),
        Outline::Chain { mut points, is_closed, width_m } => {
            if is_closed {
                points.extend(points.first().copied());
            }
            n_thin += usize::from(width_m <= 0.0);
            let width_m = if width_m > 0.0 { width_m } else { assumed_m };
            (points.len() > 1).then_some(Shape::Polyline { points, half_width_m: width_m / 2.0 })
        }
    };
    let shapes: Vec<Shape> = drawn.into_iter().filter_map(&mut shape).collect();
    if n_thin > 0 {
        notes.push(format!("PIPES: {n_thin} lines without a width were taken as {assumed_m} m wide"));
    }
    shapes
}

/// Circles, and chains of points with whether they are closed.
fn parted(drawn: Vec<Drawn>) -> (Vec<(Point, f64)>, Vec<rings::Chain>) {
    let (mut circles, mut chains) = (Vec::new(), Vec::new());
    for outline in drawn.into_iter().filter_map(|drawn| drawn.outline) {
        match outline {
            Outline::Circle { center, radius_m } => circles.push((center, radius_m)),
            Outline::Chain { points, is_closed, .. } => chains.push((points, is_closed)),
        }
    }
    (circles, chains)
}

#[cfg(test)]
mod tests;
