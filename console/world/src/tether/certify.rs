//! What a whole path does to the cable: the certificate, computed from the final path and from nothing else.

use super::{
    cable::TetherError,
    cable_obstacles::CableObstacles,
    case::Case,
    certificate::Certificate,
    clearance::Clearance,
    cuts,
    reasons::Reasons,
    replay::Replay,
    sealed_region::{SealedRegions, sealed_regions},
};
use std::sync::Arc;

/// Certifies a path: drags the cable along it and checks for collisions, crossings of cuts and sealed floor.
///
/// It knows nothing of the planner. Without cuts nothing is crossed or sealed.
///
/// ```
/// use world::{Boundary, Point, tether::{Case, Limits, certify}};
/// # let (cable, obstacles, cuts, room_m) = (None, &[], &[], 0.3);
/// # let (anchor, boundary) = (Point::origin(), &Boundary::Circle { radius_m: 10.0 });
/// let path = &[Point::new(0.0, 0.0), Point::new(6.0, 0.0), Point::new(6.0, 4.0), Point::new(0.0, 0.0)];
/// let limits = Limits { reel_length_m: 7.0, wrap_max_rad: 2.0, wrap_total_max_rad: 3.0 };
/// let case = Case { path, anchor, cable, boundary, obstacles, room_m, limits, returns: true, cuts };
/// let certificate = certify(&case).unwrap();
/// assert!(!certificate.certified, "the reel is too short");
/// assert!((certificate.tether_length_max_m - 52.0_f64.sqrt()).abs() < 1e-9);
/// ```
///
/// # Errors
/// [`TetherError`]: the anchor lies inside an obstacle or has a coordinate that is not finite, and the case brings no
/// cable of its own.
pub fn certify(case: &Case<'_>) -> Result<Certificate, TetherError> {
    let shapes: Vec<_> = case.obstacles.iter().map(|o| o.shape.clone()).collect();
    let obstacles = Arc::new(CableObstacles::new(case.boundary, &shapes));
    let replay = Replay::new(case, &obstacles)?;
    let clearance = Clearance::of(case);
    let sealed = if case.cuts.is_empty() { None } else { sealed_regions(case) };
    let left = replay.cable_on_return(case.anchor);
    let mut certificate = Certificate {
        tether_length_max_m: replay.max_cable.0,
        eccentricity_m: replay.eccentricity_m(case.anchor, obstacles),
        wrap_max_rad: replay.max_wrap.0,
        wrap_total_max_rad: replay.max_sum.0,
        end_length_m: case.returns.then(|| left.length_m()),
        crossings_left: if case.returns { left.signature().crossings().len() } else { 0 },
        collisions: clearance.collisions,
        clearance_min_m: clearance.least_m,
        cut_crossings: cuts::crossings(case.path, case.cuts),
        sealed_m2: sealed.map_or(0.0, |SealedRegions { area_m2, .. }| area_m2),
        ..Certificate::default()
    };
    let reasons = Reasons { case, replay: &replay, left: &left, clearance: &clearance, sealed };
    certificate.reasons = reasons.of(&certificate);
    certificate.certified = certificate.reasons.is_empty();
    Ok(certificate)
}

#[cfg(test)]
mod tests;
