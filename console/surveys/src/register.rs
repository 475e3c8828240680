//! Places the second survey in the frame of the first one, by shell, columns and plates.

mod fit;
mod plates;

use crate::{Indication, Refusal};
use fit::{fitted, spokes};
use nalgebra::{Isometry2, Matrix2};
use plates::residual;
use serde::Serialize;
use world::{Boundary, PlateLayout, Point};

/// The largest distance between a landmark and its counterpart, metres.
pub const TOLERANCE_M: f64 = 0.1;

/// The tank of a survey, as drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Tank {
    /// The shell.
    pub boundary: Boundary,
    /// The columns and other drawn obstacles.
    pub columns: Vec<Column>,
    /// The plates, if their layout is known.
    pub plates: Option<PlateLayout>,
}

/// A column, or any other drawn obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its middle, metres.
    pub at: Point,
    /// Its largest extent, metres.
    pub size_m: f64,
}

/// What a residual is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Landmark {
    /// The shell: its radius, or its corners.
    Shell,
    /// The columns.
    Columns,
    /// The plates: the dimensions of their layout, or their corners.
    Plates,
}

/// How far landmarks of the second survey are from their counterparts after the registration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Residual {
    /// The landmarks.
    pub of: Landmark,
    /// Their number.
    pub count: usize,
    /// Root of the mean squared distance, metres.
    pub rms_m: f64,
    /// The greatest distance, metres.
    pub max_m: f64,
}

impl Residual {
    fn new(of: Landmark, distances_m: &[f64]) -> Self {
        let count = distances_m.len();
        let sum: f64 = distances_m.iter().map(|m| m * m).sum();
        let max_m = distances_m.iter().copied().fold(0.0, f64::max);
        Self { of, count, rms_m: (sum / count.max(1) as f64).sqrt(), max_m }
    }
}

/// How the second survey lies in the frame of the first one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Registration {
    /// Turn from the second frame to the first one, counter-clockwise, radians.
    pub turn_rad: f64,
    /// Shift after the turn, metres.
    pub shift_m: [f64; 2],
    /// Whether columns, corners or plates fix the turn. If not, both frames are taken to have the same north.
    pub is_turn_fixed: bool,
    /// The residuals of the landmarks that both surveys have.
    pub residuals: Vec<Residual>,
    #[serde(skip)]
    motion: Isometry2<f64>,
}

impl Registration {
    /// Registers the second tank to the first one. The frames are taken to be the same if the landmarks then fit;
    /// otherwise the turn is the only one that makes them fit.
    ///
    /// # Errors
    /// The tanks differ, or the landmarks fit in more than one way.
    pub fn of(first: &Tank, second: &Tank) -> Result<Self, Refusal> {
        let shell = shell(first, second)?;
        if first.columns.len() != second.columns.len() {
            let [first, second] = [first, second].map(|tank| tank.columns.len());
            return Err(Refusal::Columns { first, second });
        }
        let (motion, mut residuals) = fitted(first, second)?;
        residuals.extend(shell);
        let of_plates = first.plates.as_ref().zip(second.plates.as_ref());
        let of_plates = of_plates.map(|both| residual(both, &motion, &first.boundary)).transpose()?;
        let is_turn_fixed = !spokes(first).is_empty() || of_plates.is_some();
        residuals.extend(of_plates);
        residuals.sort_by_key(|residual| residual.of as u8);
        let shift_m = [motion.translation.x, motion.translation.y];
        Ok(Self { turn_rad: motion.rotation.angle(), shift_m, is_turn_fixed, residuals, motion })
    }

    /// The place in the first frame of a place in the second one.
    pub fn apply(&self, place: Point) -> Point {
        self.motion * place
    }

    /// The place in the second frame of a place in the first one.
    pub fn back(&self, place: Point) -> Point {
        self.motion.inverse_transform_point(&place)
    }

    /// The covariance of an indication of the second survey in the first frame, square metres.
    pub(crate) fn turned(&self, one: &Indication) -> Matrix2<f64> {
        let turn = self.motion.rotation.to_rotation_matrix();
        turn * one.covariance * turn.inverse()
    }

    /// The covariance of the registration, from the residuals, square metres.
    pub(crate) fn covariance(&self) -> Matrix2<f64> {
        let worst = self.residuals.iter().map(|residual| residual.rms_m).fold(0.0, f64::max);
        Matrix2::identity() * (worst * worst / 2.0)
    }
}

/// Compares the shells of two tanks; the residual of a circle is the difference of the radii.
fn shell(first: &Tank, second: &Tank) -> Result<Option<Residual>, Refusal> {
    let differ = || Refusal::Shell { first: named(&first.boundary), second: named(&second.boundary) };
    match (&first.boundary, &second.boundary) {
        (Boundary::Circle { radius_m: one }, Boundary::Circle { radius_m: other }) => {
            let off_m = (one - other).abs();
            let residual = Residual::new(Landmark::Shell, &[off_m]);
            if off_m <= TOLERANCE_M { Ok(Some(residual)) } else { Err(differ()) }
        }
        (Boundary::Polygon { vertices: one }, Boundary::Polygon { vertices: other }) => {
            if one.len() == other.len() { Ok(None) } else { Err(differ()) }
        }
        _ => Err(differ()),
    }
}

fn named(boundary: &Boundary) -> String {
    match boundary {
        Boundary::Circle { radius_m } => format!("a circle with a radius of {radius_m} m"),
        Boundary::Polygon { vertices } => format!("a polygon with {} corners", vertices.len()),
    }
}
