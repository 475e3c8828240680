//! Reads floor drawings in DXF format.
//!
//! The layer determines what an entity is: SHELL, COLUMNS, PIPES, SUMP, NOGO or PLATES. A layer is used if a word in
//! its name is one of these, in the singular or the plural, or if the caller assigns it. Blocks are expanded; their
//! entities on layer 0 take the layer of the insertion.

mod areas;
mod curves;
mod entities;
mod faces;
mod groups;
mod hatch;
mod labels;
mod near;
mod plates;
mod rings;
mod roles;
mod sorted;

use crate::{
    error::ImportError,
    input::Input,
    is_wholly_outside,
    plan::{FloorPlan, MOST_CORNERS, Named},
};
use areas::Area;
use groups::Drawing;
use nalgebra::Isometry2;
pub use roles::{Layers, Role};
use sorted::Sorted;
use world::{Boundary, Point, Shape};

/// The default width in metres of pipes drawn as lines without a width.
pub const PIPE_WIDTH_M: f64 = 0.1;
/// The range of tank sizes in metres. A shell outside this range suggests that the unit is wrong.
const ACROSS_M: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// Values that a drawing does not state, or states wrongly.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// The size of the drawing's unit in metres; overrides the header.
    pub unit_m: Option<f64>,
    /// The width in metres of pipes drawn as lines without a width.
    pub pipe_width_m: f64,
    /// The roles assigned to layers.
    pub layers: Layers,
}

/// Reads a floor plan from a drawing.
///
/// # Errors
/// The drawing is not DXF; its unit is neither in the header nor given; it has no closed outline for the shell; or an
/// assigned layer is empty.
pub fn read(input: &Input, assumed: &Assumed) -> Result<FloorPlan, ImportError> {
    let of_file = |what: String| ImportError::of_input(input, what);
    let drawing = Drawing::read(input)?;
    let mut notes = Vec::new();
    let unit_m = unit(drawing.units, assumed.unit_m, &mut notes).map_err(of_file)?;
    let all = entities::all(&drawing, unit_m).ok_or_else(|| {
        of_file(format!(
            "more than {} entities, including those in inserted blocks; keep only the layers of the floor",
            entities::MOST
        ))
    })?;
    let listed = roles::list(&all);
    if let Some(missing) = assumed.layers.missing(&all) {
        return Err(of_file(format!("layer `{missing}` is empty or does not exist; layers: {listed}")));
    }
    let mut sorted = Sorted::new(all, unit_m, assumed, &drawing.hidden, &mut notes);
    let (boundary, moved, rest) =
        floor(&mut sorted, unit_m, assumed, &listed, &mut notes).map_err(of_file)?;
    let named = |name: &str, shapes: Vec<Shape>| -> Vec<Named> {
        let named = |(k, shape): (usize, Shape)| Named {
            name: format!("{name} {}", k + 1),
            shape: shape.transformed(&moved),
        };
        shapes.into_iter().enumerate().map(named).collect()
    };
    let mut obstacles = named("column", sorted.areas(Role::Columns, "column", rest, &mut notes));
    obstacles.extend(named("pipe", sorted.pipes(assumed.pipe_width_m, &mut notes)));
    let mut no_go = named("sump", sorted.areas(Role::Sump, "sump", Vec::new(), &mut notes));
    no_go.extend(named("no-go area", sorted.areas(Role::NoGo, "no-go area", Vec::new(), &mut notes)));
    let plates = sorted.plates(&boundary, &moved, &mut notes);
    for all in [&mut obstacles, &mut no_go] {
        keep_inside(&boundary, all, &mut notes);
    }
    if obstacles.is_empty() {
        notes.push(no_obstacles(assumed, &listed));
    }
    Ok(FloorPlan { boundary, obstacles, no_go, plates, notes })
}

/// The shell in the tank frame, the transformation from the drawing to this frame, and the other areas on the shell's
/// layer, which are columns.
fn floor(
    sorted: &mut Sorted,
    unit_m: f64,
    assumed: &Assumed,
    listed: &str,
    notes: &mut Vec<String>,
) -> Result<(Boundary, Isometry2<f64>, Vec<Area>), String> {
    let (shell, rest) = sorted.shell(notes).map_err(|why| no_shell(&why, assumed, listed))?;
    let (boundary, center) = areas::boundary(&shell, notes);
    if let Boundary::Polygon { vertices } = &boundary
        && vertices.len() > MOST_CORNERS
    {
        return Err(format!(
            "the shell still has {} corners after simplification; draw it with at most {MOST_CORNERS}, or as a \
             circle",
            vertices.len()
        ));
    }
    let (low, high) = boundary.bounds();
    let across_m = (high - low).max();
    if !ACROSS_M.contains(&across_m) {
        return Err(format!(
            "the shell is {across_m:.6} m across if the drawing's unit is {unit_m} m; tanks must be {} to {} m \
             across: state the unit, for example --units mm",
            ACROSS_M.start(),
            ACROSS_M.end()
        ));
    }
    let center = center
        .unwrap_or_else(|| if is_near(low, high) { Point::origin() } else { nalgebra::center(&low, &high) });
    if center != Point::origin() {
        notes.push(format!("({:.3}, {:.3}) m in the drawing is [0, 0] in the scenario", center.x, center.y));
    }
    let moved = Isometry2::new(-center.coords, 0.0);
    let boundary = match boundary {
        Boundary::Circle { .. } => boundary,
        Boundary::Polygon { vertices } => {
            Boundary::Polygon { vertices: vertices.iter().map(|at| moved * at).collect() }
        }
    };
    Ok((boundary, moved, rest))
}

/// A note that no obstacles were found, and what to do if there should be some.
fn no_obstacles(assumed: &Assumed, listed: &str) -> String {
    let stated = [Role::Columns, Role::Pipes].map(|role| assumed.layers.stated(role)).concat();
    let remedy = match stated[..] {
        [] => "if there are any, name their layer, for example --layer COLUMNS=NAME".to_owned(),
        _ => format!("the layers assigned to them contain none: {}", stated.join(", ")),
    };
    format!("no columns or pipes were found; {remedy}; layers: {listed}")
}

/// A message that explains why a drawing has no shell. It does not suggest options that the user has already given.
fn no_shell(why: &str, assumed: &Assumed, listed: &str) -> String {
    let stated = assumed.layers.stated(Role::Shell);
    let layer = match stated[..] {
        [] => "the layer SHELL".to_owned(),
        _ => format!("the layer {} assigned to SHELL", stated.join(", ")),
    };
    if !why.is_empty() {
        return format!("no shell on {layer}: {why}; layers: {listed}");
    }
    let remedy = if stated.is_empty() {
        "draw the inner side of the shell there, or name its layer, for example --layer SHELL=0"
    } else {
        "draw the inner side of the shell there, or name a different layer"
    };
    format!("no circle or closed outline on {layer}; {remedy}; layers: {listed}")
}

/// Removes shapes that are wholly outside the shell.
fn keep_inside(boundary: &Boundary, all: &mut Vec<Named>, notes: &mut Vec<String>) {
    all.retain(|named| {
        let is_inside = !is_wholly_outside(boundary, &named.shape);
        if !is_inside {
            notes.push(format!("{} is outside the shell and was left out", named.name));
        }
        is_inside
    });
}

/// The size of the drawing's unit in metres: the given size or, if none is given, the size in the header.
fn unit(header: Option<i32>, stated_m: Option<f64>, notes: &mut Vec<String>) -> Result<f64, String> {
    let header_m = header.and_then(metres);
    let unit_m = stated_m.or(header_m).ok_or(
        "the header ($INSUNITS) states no unit of length; give it with --units, for example --units mm",
    )?;
    match header_m {
        None => notes.push(format!("the drawing states no unit; one unit was taken as {unit_m} m")),
        Some(header_m) if (header_m / unit_m - 1.0).abs() > 1e-9 => {
            notes.push(format!("one unit was taken as {unit_m} m, as given; the header states {header_m} m"));
        }
        Some(_) => {}
    }
    Ok(unit_m)
}

/// Whether a box is near the origin, as in a scenario. A drawing in survey coordinates is not.
fn is_near(low: Point, high: Point) -> bool {
    let most = *ACROSS_M.end();
    [low, high].iter().all(|at| at.coords.amax() <= most)
}

/// The size in metres of a unit, given its number in `$INSUNITS`, if this is a plausible unit of length.
fn metres(units: i32) -> Option<f64> {
    match units {
        1 => Some(0.0254),
        2 => Some(0.3048),
        4 => Some(1e-3),
        5 => Some(1e-2),
        6 => Some(1.0),
        10 => Some(0.9144),
        14 => Some(0.1),
        21 => Some(1200.0 / 3937.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
