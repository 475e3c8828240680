//! Compares indications with the true losses of a simulated floor.

use super::Finding;
use mission::Sampling;
use serde::{Deserialize, Serialize};
use world::{FloorWear, MetalLoss, Point};

/// Lower ends of the classes of depth, as a share of the nominal thickness.
const CLASSES: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// How many losses of a class of depth were found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Least depth, as a share of the nominal thickness.
    pub from: f64,
    /// Number of losses whose deepest place was tested.
    pub losses: usize,
    /// Number of those in an indication.
    pub found: usize,
}

/// How the indications of a simulated run compare with the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Detections {
    /// The losses by depth; losses below the smallest class are not counted.
    pub classes: Vec<Detection>,
    /// Number of indications where no metal is lost.
    pub false_calls: usize,
}

impl Detections {
    /// The share of the losses that were found; `None` without losses.
    pub(super) fn share(&self) -> Option<f64> {
        let sum = |of: fn(&Detection) -> usize| self.classes.iter().map(of).sum::<usize>();
        let losses = sum(|class| class.losses);
        (losses > 0).then(|| sum(|class| class.found) as f64 / losses as f64)
    }
}

pub(super) fn detections(
    wear: &FloorWear,
    sampling: Sampling,
    found: &[Finding],
    is_tested: impl Fn(Point) -> bool,
) -> Detections {
    let holds = |finding: &Finding, loss: &MetalLoss| {
        let reach_m = loss.radius_m + finding.error_m;
        let off = |at: f64, low: f64, high: f64| (low - at).max(at - high).max(0.0);
        off(loss.at.x, finding.low.x, finding.high.x) <= reach_m
            && off(loss.at.y, finding.low.y, finding.high.y) <= reach_m
    };
    let class = |(index, from): (usize, &f64)| {
        let to = CLASSES.get(index + 1).copied().unwrap_or(f64::INFINITY);
        let is_in = |loss: &&MetalLoss| {
            (*from..to).contains(&(loss.depth_mm / sampling.thickness_mm)) && is_tested(loss.at)
        };
        let losses: Vec<&MetalLoss> = wear.losses.iter().filter(is_in).collect();
        let is_found = |loss: &&&MetalLoss| found.iter().any(|finding| holds(finding, loss));
        Detection { from: *from, losses: losses.len(), found: losses.iter().filter(is_found).count() }
    };
    let is_false = |finding: &&Finding| !wear.losses.iter().any(|loss| holds(finding, loss));
    Detections {
        classes: CLASSES.iter().enumerate().map(class).collect(),
        false_calls: found.iter().filter(is_false).count(),
    }
}
