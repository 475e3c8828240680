//! The plates of a floor: closed outlines, or the areas between seams and the shell.

use super::{entities::Outline, faces, near};
use crate::{
    is_wholly_outside,
    plan::{MOST_CORNERS, MOST_PLATES},
};
use nalgebra::Isometry2;
use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::TAU,
};
use world::{
    Boundary, DrawnPlate, NO_PLATE, Point, Shape,
    shape::{mean_of, ring_area_m2, ring_contains},
};

/// The number of corners with which a round plate, or a round shell divided by seams, is approximated.
const N_ROUND: [usize; 2] = [120, 720];
/// Width, in metres, below which a strip is not a plate: it lies between the two edges of an overlap.
const NARROWEST_M: f64 = 0.1;
/// Distance, in metres, from the line between its neighbours below which a point is not a corner.
const STRAIGHT_M: f64 = 2e-4;
/// The largest distance in metres by which an outline with too many corners may shrink.
const COARSEST_M: f64 = 0.05;
/// Distance from south to north, in metres, below which the centres of plates form a row.
const ROW_M: f64 = 0.25;

/// A piece of text in the drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    pub at: Point,
    pub text: String,
    /// Whether the text is on a layer of plates.
    pub is_of_plates: bool,
    /// The layer and the type of entity, for a note on unused entities.
    pub what: String,
}

/// Finds the plates in the tank frame. `moved` maps the drawing to this frame, and `unit_m` is the size of the
/// drawing's unit in metres. Afterwards, `labels` holds only the labels that name no plate.
pub(super) fn plates(
    outlines: Vec<Outline>,
    labels: &mut Vec<Label>,
    boundary: &Boundary,
    (moved, unit_m): (&Isometry2<f64>, f64),
    notes: &mut Vec<String>,
) -> Vec<DrawnPlate> {
    for label in labels.iter_mut() {
        label.at = moved * label.at;
    }
    let lines: Vec<(Vec<Point>, bool)> = outlines.into_iter().map(|outline| line(outline, moved)).collect();
    let drawn_at = |at: Point| near::place(moved.inverse_transform_point(&at), unit_m);
    let mut rings = rings(lines, boundary, &drawn_at, notes);
    rings.iter_mut().for_each(straighten);
    let n = rings.len();
    rings.retain(|ring| !is_wholly_outside(boundary, &Shape::Polygon { vertices: ring.clone() }));
    let n_outside = n - rings.len();
    if n_outside > 0 {
        notes.push(format!("PLATES: outlines outside the shell were left out ({n_outside})"));
    }
    if rings.len() > MOST_PLATES {
        let n = rings.len();
        notes.push(format!(
            "PLATES: {n} plates were not read because the limit is {MOST_PLATES}; keep only the seams of the \
             floor on the layer"
        ));
        return Vec::new();
    }
    for ring in &mut rings {
        coarsen(ring, notes);
    }
    named(rings, labels, notes)
}

/// The points of an outline, with the first repeated at the end of a closed one, and whether it is closed.
fn line(outline: Outline, moved: &Isometry2<f64>) -> (Vec<Point>, bool) {
    let (mut points, is_closed) = match outline {
        Outline::Circle { center, radius_m } => (around(center, radius_m, N_ROUND[0]), true),
        Outline::Chain { points, is_closed, .. } => {
            // A polyline that ends where it begins is closed, even if its flag states otherwise.
            let ends = points.first().zip(points.last());
            let meets = points.len() > 3 && ends.is_some_and(|(a, b)| (a - b).norm() < 1e-6);
            (points, is_closed || meets)
        }
    };
    if is_closed && points.first() != points.last() {
        points.extend(points.first().copied());
    }
    (points.iter().map(|at| moved * at).collect(), is_closed)
}

fn around(center: Point, radius_m: f64, n: usize) -> Vec<Point> {
    let at = |k: usize| TAU * k as f64 / n as f64;
    (0..n).map(|k| center + world::Vector::new(at(k).cos(), at(k).sin()) * radius_m).collect()
}

/// Counter-clockwise outlines: the outlines themselves if all are closed; otherwise the faces that all outlines and the
/// shell enclose.
fn rings(
    lines: Vec<(Vec<Point>, bool)>,
    boundary: &Boundary,
    drawn_at: &dyn Fn(Point) -> String,
    notes: &mut Vec<String>,
) -> Vec<Vec<Point>> {
    if lines.iter().all(|(_, is_closed)| *is_closed) {
        let mut rings: Vec<Vec<Point>> = lines.into_iter().map(|(ring, _)| ring).collect();
        rings.retain_mut(|ring| {
            ring.pop();
            let crossing = near::crossing(ring);
            if let Some(at) = crossing {
                let at = drawn_at(at);
                notes.push(format!(
                    "PLATES: an outline that crosses itself at {at} in the drawing was left out"
                ));
            }
            crossing.is_none()
        });
        for ring in &mut rings {
            if ring_area_m2(ring) < 0.0 {
                ring.reverse();
            }
        }
        return rings;
    }
    let mut shell = match boundary {
        Boundary::Circle { radius_m } => around(Point::origin(), *radius_m, N_ROUND[1]),
        Boundary::Polygon { vertices } => vertices.clone(),
    };
    shell.extend(shell.first().copied());
    let n_lines = lines.len();
    let all: Vec<Vec<Point>> = lines.into_iter().map(|(line, _)| line).chain([shell]).collect();
    let Some(mut faces) = faces::faces(&all) else {
        notes.push(format!(
            "PLATES: {n_lines} lines are too many to be seams; keep only seams on the layer, or draw each plate \
             as a closed polyline"
        ));
        return Vec::new();
    };
    if faces.rings.len() < 2 {
        notes.push(format!(
            "PLATES: lines that divide no floor were left out ({n_lines}); end each seam at another seam or at the shell"
        ));
        return Vec::new();
    }
    if faces.n_loose > 0 {
        notes.push(format!(
            "PLATES: lines that end at no other line divide no floor ({}); end each seam at another seam or at the shell",
            faces.n_loose
        ));
    }
    let n = faces.rings.len();
    faces.rings.retain(|ring| width_m(ring) >= NARROWEST_M);
    let n_narrow = n - faces.rings.len();
    if n_narrow > 0 {
        notes.push(format!(
            "PLATES: strips narrower than {NARROWEST_M} m were left out ({n_narrow}); their area was added to the \
             adjacent plates"
        ));
    }
    faces.rings
}

/// The width in metres of a strip that has the same area and perimeter as an outline.
fn width_m(ring: &[Point]) -> f64 {
    let around_m: f64 = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| (b - a).norm()).sum();
    2.0 * ring_area_m2(ring).abs() / around_m
}

/// Removes corners at which an outline does not turn.
fn straighten(ring: &mut Vec<Point>) {
    without_corners(ring, STRAIGHT_M);
}

/// Reduces the number of corners of an outline to the limit for a scenario.
fn coarsen(ring: &mut Vec<Point>, notes: &mut Vec<String>) {
    let (n, mut off_m) = (ring.len(), STRAIGHT_M);
    while ring.len() > MOST_CORNERS && off_m < COARSEST_M {
        off_m *= 2.0;
        without_corners(ring, off_m);
    }
    if n > ring.len() {
        let kept = ring.len();
        notes.push(format!(
            "PLATES: an outline of {n} corners was reduced to {kept}, which changes it by at most {off_m:.4} m"
        ));
    }
}

/// Removes corners as long as the line that replaces them stays within a distance of all of them.
fn without_corners(ring: &mut Vec<Point>, off_m: f64) {
    let corners = std::mem::take(ring);
    let n = corners.len();
    let off = |a: Point, b: Point, p: Point| world::polyline::distance_m(&[a, b], p);
    let mut at = 0;
    while at < n {
        ring.push(corners[at]);
        let is_spared = |to: &usize| {
            (at + 1..*to).all(|between| off(corners[at], corners[*to % n], corners[between]) < off_m)
        };
        at = (at + 2..=n).take_while(is_spared).last().unwrap_or(at + 1);
    }
    // The outline need not begin at a corner.
    if let [second, .., last] = ring[1..]
        && ring.len() > 3
        && off(last, second, ring[0]) < off_m
    {
        ring.remove(0);
    }
}

/// Names the plates, and puts small plates first, so that a plate inside another plate takes precedence.
fn named(rings: Vec<Vec<Point>>, labels: &mut Vec<Label>, notes: &mut Vec<String>) -> Vec<DrawnPlate> {
    let mut sorted: Vec<(Point, Vec<Point>)> = rings.into_iter().map(|ring| (mean_of(&ring), ring)).collect();
    let row = |at: &Point| (at.y / ROW_M).round() as i64;
    sorted.sort_by(|(a, _), (b, _)| row(a).cmp(&row(b)).then(a.x.total_cmp(&b.x)));
    let mut by_size: Vec<(usize, i64)> = sorted
        .iter()
        .enumerate()
        .map(|(k, (_, ring))| (k, (ring_area_m2(ring).abs() * 1e3).round() as i64))
        .collect();
    by_size.sort_by_key(|(_, size)| *size);
    let order: Vec<usize> = by_size.into_iter().map(|(k, _)| k).collect();
    let given = given(&sorted, &order, labels);
    let taken: BTreeSet<String> =
        given.values().map(|label| labels[*label].text.clone()).chain([NO_PLATE.into()]).collect();
    let n_digits = sorted.len().to_string().len().max(2);
    let mut numbers = (1..).map(|k| format!("P-{k:0n_digits$}")).filter(|name| !taken.contains(name));
    let mut names: Vec<String> = Vec::new();
    for k in 0..sorted.len() {
        let own = given.get(&k).map(|label| labels[*label].text.clone());
        names.extend(own.or_else(|| numbers.next()));
    }
    let n_numbered = sorted.len() - given.len();
    if n_numbered > 0 {
        notes.push(format!(
            "PLATES: plates without a text of their own ({n_numbered} of {}) were numbered from south to north",
            sorted.len()
        ));
    }
    let used: BTreeSet<usize> = given.into_values().collect();
    let mut index = 0..;
    labels.retain(|_| !index.next().is_some_and(|index| used.contains(&index)));
    let plate = |k: usize| DrawnPlate { name: names[k].clone(), vertices_m: sorted[k].1.clone() };
    order.into_iter().map(plate).collect()
}

/// The label of each plate: the first label inside the plate that is on a layer of plates or, if there is none, the
/// only label inside the plate. A text that would name several plates names none of them.
fn given(plates: &[(Point, Vec<Point>)], order: &[usize], labels: &[Label]) -> BTreeMap<usize, usize> {
    let mut within: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, label) in labels.iter().enumerate() {
        if let Some(k) = order.iter().find(|k| ring_contains(&plates[**k].1, label.at)) {
            within.entry(*k).or_default().push(index);
        }
    }
    let of_plate = |here: &Vec<usize>| match here.iter().find(|index| labels[**index].is_of_plates) {
        None if here.len() > 1 => None,
        own => own.or(here.first()).copied(),
    };
    let mut given: BTreeMap<usize, usize> =
        within.iter().filter_map(|(k, here)| Some((*k, of_plate(here)?))).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for label in given.values() {
        *counts.entry(&labels[*label].text).or_default() += 1;
    }
    given.retain(|_, label| counts[labels[*label].text.as_str()] == 1 && labels[*label].text != NO_PLATE);
    given
}
