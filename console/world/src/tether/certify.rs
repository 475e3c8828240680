//! Computes the certificate, which states the effect of a whole path on the cable, from the final path alone.

use super::{
    cable::TetherError,
    case::Case,
    certificate::Certificate,
    clearance::Clearance,
    cuts,
    ground::Ground,
    own_gap::OwnGap,
    reasons::Reasons,
    replay::Replay,
    sealed_region::{SealedRegions, sealed_regions},
};

/// Certifies a path: drags the cable along it and checks for collisions, crossings of cuts and sealed floor.
///
/// The result does not depend on the planner. If there are no cuts, nothing is crossed or sealed.
///
/// ```
/// use world::{Boundary, Point, tether::{Case, Limits, certify}};
/// # let (cable, obstacles, cuts, room_m, pull) = (None, &[], &[], 0.3, None);
/// # let (anchor, boundary) = (Point::origin(), &Boundary::Circle { radius_m: 10.0 });
/// let path = &[Point::new(0.0, 0.0), Point::new(6.0, 0.0), Point::new(6.0, 4.0), Point::new(0.0, 0.0)];
/// let limits = Limits { reel_length_m: 7.0, wrap_max_rad: 2.0, wrap_total_max_rad: 3.0 };
/// let case = Case { path, anchor, cable, boundary, obstacles, room_m, limits, pull, returns: true, cuts };
/// let certificate = certify(&case).unwrap();
/// assert!(!certificate.certified, "the reel is too short");
/// assert!((certificate.tether_length_max_m - 52.0_f64.sqrt()).abs() < 1e-9);
/// ```
///
/// # Errors
/// [`TetherError`]: the case has no cable of its own, and the anchor lies inside an obstacle or has a coordinate that
/// is not finite.
pub fn certify(case: &Case<'_>) -> Result<Certificate, TetherError> {
    certify_on(&Ground::new(case.anchor, case.boundary, case.obstacles), case)
}

/// Certifies a path on ground that several paths share; the anchor, wall and obstacles of the ground must be those of
/// the case.
///
/// # Errors
/// As for [`certify`].
pub fn certify_on(ground: &Ground, case: &Case<'_>) -> Result<Certificate, TetherError> {
    let replay = Replay::new(case, ground)?;
    let clearance = Clearance::of(case);
    let sealed = if case.cuts.is_empty() { None } else { sealed_regions(case) };
    let left = replay.cable_on_return(case.anchor);
    let mut certificate = Certificate {
        tether_length_max_m: replay.max_cable.0,
        eccentricity_m: replay.eccentricity_m(ground),
        wrap_max_rad: replay.max_wrap.0,
        wrap_total_max_rad: replay.max_sum.0,
        end_length_m: case.returns.then(|| left.length_m()),
        crossings_left: if case.returns { left.signature().crossings().len() } else { 0 },
        collisions: clearance.collisions,
        clearance_min_m: clearance.least_m,
        cut_crossings: cuts::crossings(case.path, case.cuts),
        sealed_m2: sealed.map_or(0.0, |SealedRegions { area_m2, .. }| area_m2),
        pull: replay.pull(),
        own_gap: if case.pull.is_some() { OwnGap::on(case, ground)? } else { None },
        ..Certificate::default()
    };
    let reasons = Reasons { case, replay: &replay, left: &left, clearance: &clearance, sealed };
    certificate.reasons = reasons.of(&certificate);
    certificate.warnings = reasons.warnings(&certificate);
    certificate.certified = certificate.reasons.is_empty();
    Ok(certificate)
}

/// The effect of a path on the cable itself; its figures are the same as those with the same names in the certificate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strain {
    /// Longest cable, metres.
    pub tether_length_max_m: f64,
    /// Length of the shortest cable that would suffice, metres.
    pub eccentricity_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest total wrap, radians.
    pub wrap_total_max_rad: f64,
    /// Largest pull at the reel that taking up the cable needs, newtons; 0 if the pull is not checked.
    pub pull_max_n: f64,
}

/// Computes the effect of a path on the cable, without checking collisions, cuts and sealed floor: quicker than
/// [`certify_on`].
///
/// # Errors
/// As for [`certify`].
pub fn strain(ground: &Ground, case: &Case<'_>) -> Result<Strain, TetherError> {
    let replay = Replay::new(case, ground)?;
    Ok(Strain {
        tether_length_max_m: replay.max_cable.0,
        eccentricity_m: replay.eccentricity_m(ground),
        wrap_max_rad: replay.max_wrap.0,
        wrap_total_max_rad: replay.max_sum.0,
        pull_max_n: replay.pull().map_or(0.0, |pull| pull.needed_n),
    })
}

impl Strain {
    /// Returns the longest cable as a multiple of the shortest that would suffice.
    pub fn cable_share(&self) -> f64 {
        self.tether_length_max_m / self.eccentricity_m.max(1e-9)
    }
}

impl From<&Certificate> for Strain {
    fn from(certificate: &Certificate) -> Self {
        let Certificate { tether_length_max_m, eccentricity_m, wrap_max_rad, wrap_total_max_rad, .. } =
            *certificate;
        let pull_max_n = certificate.pull.map_or(0.0, |pull| pull.needed_n);
        Self { tether_length_max_m, eccentricity_m, wrap_max_rad, wrap_total_max_rad, pull_max_n }
    }
}

#[cfg(test)]
mod tests;
