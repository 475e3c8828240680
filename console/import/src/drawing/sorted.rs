//! The entities of a drawing, sorted by the roles of their layers.

use super::{
    Assumed, areas,
    entities::{Drawn, Outline},
    near::{self, NearMiss},
    plates::{Label, plates},
    roles::Role,
};
use nalgebra::Isometry2;
use std::collections::{BTreeMap, BTreeSet};
use world::{Boundary, DrawnPlate, Point, Shape};

/// The outlines of each role.
pub(super) struct Sorted {
    /// The size of the drawing's unit in metres, for positions in messages.
    unit_m: f64,
    by_role: BTreeMap<Role, Vec<Outline>>,
    /// Whether the layer of the shell also contains columns.
    is_shared: bool,
    /// Texts that may name plates; empty if there are no plates.
    labels: Vec<Label>,
}

impl Sorted {
    pub(super) fn new(
        all: Vec<Drawn>,
        unit_m: f64,
        assumed: &Assumed,
        hidden: &[String],
        notes: &mut Vec<String>,
    ) -> Self {
        let mut sorted = Self { unit_m, by_role: BTreeMap::new(), is_shared: false, labels: Vec::new() };
        let is_of_plates = |drawn: &Drawn| assumed.layers.roles(&drawn.layer).contains(&Role::Plates);
        let has_plates = all.iter().any(|drawn| is_of_plates(drawn) && !drawn.outlines.is_empty());
        let drawn_on = lined_layers(&all);
        let mut unused: BTreeMap<String, usize> = BTreeMap::new();
        let mut in_the_dark = BTreeSet::new();
        for drawn in all {
            let roles = assumed.layers.roles(&drawn.layer);
            let role = roles.iter().min().copied().filter(|role| *role < Role::Ignored);
            if role.is_none() || drawn.outlines.is_empty() {
                let is_ignored = roles.contains(&Role::Ignored);
                let what = format!("layer {}: {}", drawn.layer, drawn.kind);
                let is_of_plates = roles.contains(&Role::Plates);
                let is_of_others = !is_of_plates && drawn_on.contains(&drawn.layer);
                let is_name = has_plates && !is_ignored && !is_of_others;
                if let Some((at, text)) = drawn.label.filter(|_| is_name) {
                    sorted.labels.push(Label { at, text, is_of_plates, what });
                    continue;
                }
                *unused.entry(what).or_default() += usize::from(!is_ignored);
                continue;
            }
            if hidden.contains(&drawn.layer) {
                in_the_dark.insert(drawn.layer.clone());
            }
            let role = role.expect("the role was checked above");
            sorted.is_shared |= role == Role::Shell && roles.contains(&Role::Columns);
            sorted.by_role.entry(role).or_default().extend(drawn.outlines);
        }
        note_unused(unused, notes);
        let used =
            |layer| format!("layer {layer} is off or frozen in the drawing, but its contents were used");
        notes.extend(in_the_dark.into_iter().map(used));
        sorted
    }

    fn take(&mut self, role: Role) -> impl Iterator<Item = Outline> + use<> {
        self.by_role.remove(&role).unwrap_or_default().into_iter()
    }

    /// The shell, and other areas on its layer, which are columns.
    ///
    /// # Errors
    /// The reason why there is no shell, such as an outline that is nearly closed or crosses itself; empty if there is
    /// no outline at all.
    pub(super) fn shell(
        &mut self,
        notes: &mut Vec<String>,
    ) -> Result<(areas::Area, Vec<areas::Area>), String> {
        let (all, open) = areas::areas(self.take(Role::Shell));
        let n = all.len();
        let miss = near::nearest(&open);
        let told = |miss: &NearMiss| format!("{}; join the ends there", miss.told(self.unit_m));
        let Some((shell, rest)) = areas::shell(all, notes) else {
            return Err(miss.as_ref().map(told).unwrap_or_default());
        };
        if let Some(miss) = miss.filter(|miss| miss.across_m > shell.across_m()) {
            let largest_m = shell.across_m();
            return Err(format!(
                "the largest closed outline is {largest_m:.3} m across, but {}",
                told(&miss)
            ));
        }
        if let Some(at) = near::crossing(shell.corners()) {
            let at = near::place(at, self.unit_m);
            return Err(format!(
                "the outline crosses itself at {at} in the drawing; draw it without crossings"
            ));
        }
        self.note_open(Role::Shell, &open, notes);
        if self.is_shared {
            return Ok((shell, rest));
        }
        if !rest.is_empty() {
            notes.push(format!("SHELL: {n} closed outlines; the largest was taken as the shell"));
        }
        Ok((shell, Vec::new()))
    }

    /// Closed outlines as convex shapes.
    pub(super) fn areas(
        &mut self,
        role: Role,
        name: &str,
        more: Vec<areas::Area>,
        notes: &mut Vec<String>,
    ) -> Vec<Shape> {
        let (mut all, open) = areas::areas(self.take(role));
        self.note_open(role, &open, notes);
        all.extend(more);
        let (shapes, grown) = areas::shapes(&all);
        notes.extend(
            grown.iter().map(|k| format!("{name} {k} is not convex and was replaced by its convex hull")),
        );
        shapes
    }

    /// The plates of the floor; notes the texts that name no plate.
    pub(super) fn plates(
        &mut self,
        boundary: &Boundary,
        moved: &Isometry2<f64>,
        notes: &mut Vec<String>,
    ) -> Vec<DrawnPlate> {
        let outlines: Vec<Outline> = self.take(Role::Plates).collect();
        if outlines.is_empty() {
            return Vec::new();
        }
        let found = plates(outlines, &mut self.labels, boundary, (moved, self.unit_m), notes);
        let mut unused: BTreeMap<String, usize> = BTreeMap::new();
        for label in self.labels.drain(..) {
            *unused.entry(label.what).or_default() += 1;
        }
        note_unused(unused, notes);
        found
    }

    fn note_open(&self, role: Role, open: &[Vec<Point>], notes: &mut Vec<String>) {
        if open.is_empty() {
            return;
        }
        let miss =
            near::nearest(open).map(|miss| format!("; {}", miss.told(self.unit_m))).unwrap_or_default();
        notes
            .push(format!("{role}: lines that do not close an outline were left out ({}){miss}", open.len()));
    }

    pub(super) fn pipes(&mut self, assumed_m: f64, notes: &mut Vec<String>) -> Vec<Shape> {
        let mut n_thin = 0;
        let mut shape = |outline: Outline| match outline {
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
        let shapes: Vec<Shape> = self.take(Role::Pipes).filter_map(&mut shape).collect();
        if n_thin > 0 {
            notes.push(format!(
                "PIPES: lines without a width ({n_thin}) were assumed to be {assumed_m} m wide"
            ));
        }
        shapes
    }
}

/// The layers with lines of their own. A text on such a layer names these lines; layer 0 is exempt, since anything can
/// be on it.
fn lined_layers(all: &[Drawn]) -> BTreeSet<String> {
    let lined = all.iter().filter(|drawn| !drawn.outlines.is_empty() && drawn.layer != "0");
    lined.map(|drawn| drawn.layer.clone()).collect()
}

fn note_unused(unused: BTreeMap<String, usize>, notes: &mut Vec<String>) {
    let unused = unused.into_iter().filter(|(_, n)| *n > 0);
    notes.extend(unused.map(|(what, n)| format!("not used: {what} ({n})")));
}
