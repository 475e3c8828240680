//! Compares two surveys of one tank floor, years apart.
//!
//! [`compare`] places the second survey in the frame of the first one ([`Registration`]), finds the indications that both
//! surveys show, and computes the growth of each with its 95 % interval, the rates of the plates, and when the floor
//! reaches a given thickness. Pure: no files, clocks, pages or runs.

mod assign;
mod compare;
mod growth;
mod matching;
mod outlook;
mod parts;
mod plates;
mod refusal;
mod register;

pub use compare::{Comparison, Unmatched, compare};
pub use growth::{Growth, SIGMAS_95};
pub use matching::{GATE, Match};
pub use outlook::{Basis, Outlook, Premises};
pub use plates::PlateRate;
pub use refusal::Refusal;
pub use register::{Column, Landmark, Registration, Residual, TOLERANCE_M, Tank};

use nalgebra::Matrix2;
use serde::Serialize;
use world::Point;

/// A survey of a floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// The tank, in the frame of this survey.
    pub tank: Tank,
    /// Nominal thickness of the floor, from which losses are measured, millimetres.
    pub thickness_mm: f64,
    /// Loss from which there is an indication, millimetres.
    pub threshold_mm: f64,
    /// The tested floor, square metres.
    pub tested_m2: f64,
    /// The indications.
    pub indications: Vec<Indication>,
}

/// A loss of metal that a survey shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indication {
    /// Its number in the report on the survey.
    pub number: usize,
    /// Name of the plate, if the layout of the plates is known.
    pub plate: Option<String>,
    /// The middle, in the frame of the survey, metres.
    pub at: Point,
    /// South-west corner of its readings, in the frame of the survey, metres.
    #[serde(skip)]
    pub low: Point,
    /// North-east corner of its readings, in the frame of the survey, metres.
    #[serde(skip)]
    pub high: Point,
    /// Covariance of the middle, square metres.
    #[serde(skip)]
    pub covariance: Matrix2<f64>,
    /// Depth, millimetres.
    pub depth_mm: f64,
    /// Standard deviation of the depth, millimetres.
    pub depth_sigma_mm: f64,
    /// Whether untested floor lies beside its readings. Its deepest place may be there, so its depth is a lower bound.
    pub is_cut: bool,
}

impl Indication {
    /// The longer side of its extent, metres.
    pub fn size_m(&self) -> f64 {
        (self.high - self.low).max()
    }
}

#[cfg(test)]
mod tests;
