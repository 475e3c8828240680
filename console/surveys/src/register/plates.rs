//! Compares the plates of two tanks.

use super::{Landmark, Residual, TOLERANCE_M};
use crate::Refusal;
use nalgebra::Isometry2;
use world::{Boundary, DrawnPlate, PlateLayout, Point, RegularPlates};

/// The residual of the plates.
pub(super) fn residual(
    both: (&PlateLayout, &PlateLayout),
    motion: &Isometry2<f64>,
    boundary: &Boundary,
) -> Result<Residual, Refusal> {
    match both {
        (PlateLayout::Regular(first), PlateLayout::Regular(second)) => {
            regular([first, second], motion, boundary)
        }
        (PlateLayout::Drawn { plates: first }, PlateLayout::Drawn { plates: second }) => {
            drawn(first, second, motion)
        }
        _ => Err(Refusal::Plates(
            "the plates of one survey are drawn, and those of the other are given by sizes".into(),
        )),
    }
}

/// A regular layout follows the axes of its frame, so the frames must be the same.
fn regular(
    [first, second]: [&RegularPlates; 2],
    motion: &Isometry2<f64>,
    boundary: &Boundary,
) -> Result<Residual, Refusal> {
    let sizes = |layout: &RegularPlates| [layout.annular_m, layout.length_m, layout.width_m];
    let names = ["annular ring", "plate length", "plate width"];
    for ((name, one), other) in names.into_iter().zip(sizes(first)).zip(sizes(second)) {
        if (one - other).abs() > TOLERANCE_M {
            return Err(Refusal::Plates(format!(
                "{name} is {one} m in the first survey and {other} m in the second one"
            )));
        }
    }
    if first.n_annular != second.n_annular {
        return Err(Refusal::Plates(format!(
            "the annular ring has {} plates in the first survey and {} in the second one",
            first.n_annular, second.n_annular
        )));
    }
    let (low, high) = boundary.bounds();
    let off_m = |corner: Point| (motion * corner - corner).norm();
    let moved_m = off_m(low).max(off_m(high));
    if moved_m > TOLERANCE_M {
        return Err(Refusal::Plates(format!(
            "the plates follow the axes of both frames, but the columns show that the second frame is turned by {:.1}°",
            motion.rotation.angle().to_degrees()
        )));
    }
    let off_m: Vec<f64> = sizes(first).into_iter().zip(sizes(second)).map(|(a, b)| (a - b).abs()).collect();
    Ok(Residual::new(Landmark::Plates, &off_m))
}

fn drawn(first: &[DrawnPlate], second: &[DrawnPlate], motion: &Isometry2<f64>) -> Result<Residual, Refusal> {
    if first.len() != second.len() {
        return Err(Refusal::Plates(format!(
            "the drawing has {} plates in the first survey and {} in the second one",
            first.len(),
            second.len()
        )));
    }
    let mut off_m = Vec::new();
    for plate in first {
        let name = &plate.name;
        let Some(other) = second.iter().find(|other| other.name == *name) else {
            return Err(Refusal::Plates(format!(
                "plate {name} of the first survey is missing in the second one"
            )));
        };
        let nearest_m = |corner: &Point| {
            let each = other.vertices_m.iter().map(|vertex| (motion * vertex - corner).norm());
            each.fold(f64::INFINITY, f64::min)
        };
        let worst_m = plate.vertices_m.iter().map(nearest_m).fold(0.0, f64::max);
        if worst_m > TOLERANCE_M || plate.vertices_m.len() != other.vertices_m.len() {
            return Err(Refusal::Plates(format!(
                "a corner of plate {name} is {worst_m:.2} m away from the nearest one in the second survey"
            )));
        }
        off_m.extend(plate.vertices_m.iter().map(nearest_m));
    }
    Ok(Residual::new(Landmark::Plates, &off_m))
}
