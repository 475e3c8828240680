//! The motion between two frames under which every landmark has a counterpart.

use super::{Landmark, Residual, TOLERANCE_M, Tank};
use crate::Refusal;
use nalgebra::{Isometry2, Translation2, UnitComplex};
use world::{Boundary, Point, Vector};

/// Difference between two turns that both fit, radians, above which they are two ways.
const OTHER_TURN_RAD: f64 = 0.02;

/// A point of the drawing that fixes the turn.
pub(super) struct Spoke {
    at: Point,
    of: Landmark,
    name: String,
    size_m: f64,
}

/// The points that fix the turn: columns away from the middle, and the corners of the shell.
pub(super) fn spokes(tank: &Tank) -> Vec<Spoke> {
    let columns = tank.columns.iter().map(|column| Spoke {
        at: column.at,
        of: Landmark::Columns,
        name: column.name.clone(),
        size_m: column.size_m,
    });
    let corners = match &tank.boundary {
        Boundary::Circle { .. } => &[][..],
        Boundary::Polygon { vertices } => vertices,
    };
    let corner = |(number, at): (usize, &Point)| Spoke {
        at: *at,
        of: Landmark::Shell,
        name: format!("corner {number} of the shell"),
        size_m: 0.0,
    };
    let middle = middle(tank);
    columns
        .chain((1..).zip(corners).map(corner))
        .filter(|spoke| (spoke.at - middle).norm() > TOLERANCE_M || tank.columns.len() > 1)
        .collect()
}

/// The middle of the shell.
fn middle(tank: &Tank) -> Point {
    match &tank.boundary {
        Boundary::Circle { .. } => Point::origin(),
        Boundary::Polygon { vertices } => world::geometry::shape::mean_of(vertices),
    }
}

/// The motion from the second frame to the first one, and the residuals of columns and corners.
pub(super) fn fitted(first: &Tank, second: &Tank) -> Result<(Isometry2<f64>, Vec<Residual>), Refusal> {
    let (one, other) = (spokes(first), spokes(second));
    let why = match matched(&one, &other, &Isometry2::identity()) {
        Ok(pairs) => {
            let motion = refined(&one, &other, &pairs);
            return Ok((motion, residuals(&one, &other, &pairs, &motion)));
        }
        Err(why) => why,
    };
    let mut found: Vec<Isometry2<f64>> = Vec::new();
    for motion in candidates((first, &one), (second, &other)) {
        let Ok(pairs) = matched(&one, &other, &motion) else { continue };
        let motion = refined(&one, &other, &pairs);
        let is_other =
            |known: &Isometry2<f64>| known.rotation.angle_to(&motion.rotation).abs() > OTHER_TURN_RAD;
        if found.iter().all(is_other) {
            found.push(motion);
        }
    }
    match found[..] {
        [] => Err(why),
        [motion] => {
            let pairs = matched(&one, &other, &motion)?;
            Ok((motion, residuals(&one, &other, &pairs, &motion)))
        }
        [a, b, ..] => {
            let [first_deg, second_deg] = [a, b].map(|motion| motion.rotation.angle().to_degrees());
            Err(Refusal::Ambiguous { first_deg, second_deg })
        }
    }
}

/// The motions that bring the spoke farthest from the middle onto a spoke like it.
fn candidates((first, one): (&Tank, &[Spoke]), (second, other): (&Tank, &[Spoke])) -> Vec<Isometry2<f64>> {
    let (from, to) = (middle(second), middle(first));
    let off_m = |spoke: &Spoke| (spoke.at - to).norm();
    let Some(farthest) = one.iter().max_by(|a, b| off_m(a).total_cmp(&off_m(b))) else { return Vec::new() };
    let arm = farthest.at - to;
    let is_like = |spoke: &&Spoke| {
        is_same_kind(farthest, spoke) && ((spoke.at - from).norm() - arm.norm()).abs() <= TOLERANCE_M
    };
    let motion = |spoke: &Spoke| {
        let turn = UnitComplex::rotation_between(&(spoke.at - from), &arm);
        Isometry2::from_parts(Translation2::from(to - turn * from), turn)
    };
    other.iter().filter(is_like).map(motion).collect()
}

fn is_same_kind(one: &Spoke, other: &Spoke) -> bool {
    one.of == other.of && (one.size_m - other.size_m).abs() <= TOLERANCE_M
}

/// The counterpart of each spoke under a motion, as an index among the others.
fn matched(one: &[Spoke], other: &[Spoke], motion: &Isometry2<f64>) -> Result<Vec<usize>, Refusal> {
    let mut is_taken = vec![false; other.len()];
    let mut pairs = Vec::with_capacity(one.len());
    for spoke in one {
        let mut nearest = (f64::INFINITY, None);
        for (index, candidate) in other.iter().enumerate() {
            let off_m = (motion * candidate.at - spoke.at).norm();
            if !is_taken[index] && is_same_kind(spoke, candidate) && off_m < nearest.0 {
                nearest = (off_m, Some(index));
            }
        }
        let (nearest_m, Some(index)) = nearest else {
            let landmark = spoke.name.clone();
            return Err(Refusal::NoCounterpart { landmark, nearest_m: nearest.0, tolerance_m: TOLERANCE_M });
        };
        if nearest_m > TOLERANCE_M {
            let landmark = spoke.name.clone();
            return Err(Refusal::NoCounterpart { landmark, nearest_m, tolerance_m: TOLERANCE_M });
        }
        is_taken[index] = true;
        pairs.push(index);
    }
    Ok(pairs)
}

/// The motion with the least sum of squared distances between counterparts; the identity if all of them coincide.
fn refined(one: &[Spoke], other: &[Spoke], pairs: &[usize]) -> Isometry2<f64> {
    let both: Vec<(Point, Point)> =
        one.iter().zip(pairs).map(|(spoke, index)| (spoke.at, other[*index].at)).collect();
    if both.len() < 2 || both.iter().all(|(to, from)| to == from) {
        return Isometry2::identity();
    }
    let count = both.len() as f64;
    let mean = |of: fn(&(Point, Point)) -> Vector| both.iter().map(of).sum::<Vector>() / count;
    let (to, from) = (mean(|both| both.0.coords), mean(|both| both.1.coords));
    let (mut dot, mut perp) = (0.0, 0.0);
    for (a, b) in &both {
        let (a, b) = (a.coords - to, b.coords - from);
        (dot, perp) = (dot + b.dot(&a), perp + b.perp(&a));
    }
    let turn = UnitComplex::new(perp.atan2(dot));
    Isometry2::from_parts(Translation2::from(to - turn * from), turn)
}

fn residuals(one: &[Spoke], other: &[Spoke], pairs: &[usize], motion: &Isometry2<f64>) -> Vec<Residual> {
    let of = |kind: Landmark| {
        let those = one.iter().zip(pairs).filter(|(spoke, _)| spoke.of == kind);
        let off_m: Vec<f64> =
            those.map(|(spoke, index)| (motion * other[*index].at - spoke.at).norm()).collect();
        (!off_m.is_empty()).then(|| Residual::new(kind, &off_m))
    };
    [Landmark::Shell, Landmark::Columns].into_iter().filter_map(of).collect()
}
