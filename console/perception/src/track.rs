//! A track: an object that scans have shown, with its position, its shape, and whether it counts as an obstacle yet.

use crate::{
    Drift,
    disc::{self, Fit, Radius},
    outline::Outline,
    rays::Rays,
    through::Look,
    uncertain::Uncertain,
};
use geometry::{Point, Shape, Vector};
use nalgebra::Matrix2;
use world::ObstacleId;

/// The errors of the pose are nearly the same in successive scans. For these errors, this number of scans counts as
/// one.
const ALIKE: f64 = 20.0;
/// In scans from nearly the same position, the edges lie between the same rays. For the shape, this number of scans
/// counts as one.
const LIKE_VIEWS: f64 = 5.0;
/// A track becomes an obstacle when at least `BIRTH_HITS` of the last `BIRTH_OF` scans have shown it.
const BIRTH_HITS: u32 = 5;
const BIRTH_OF: u32 = 8;
/// Maximum standard deviations of the radius and of the position, metres, at which a disc is certain enough for the
/// chart.
const SURE_RADIUS_M: f64 = 0.02;
const SURE_PLACE_M: f64 = 0.05;
/// An object nearer than this, metres, becomes an obstacle even if its shape is not certain yet.
const NEAR_M: f64 = 1.2;
/// A track that is not an obstacle yet is dropped after this number of consecutive scans that do not show it.
const MISSED: u32 = 5;
/// An obstacle is reported as gone after this number of scans that pass through its place, if none in between shows it.
const GONE_AFTER: u32 = 20;
/// An outline is given up after this number of scans that show some of its points, but nothing in its middle.
const CROSSED: u32 = 10;
/// Time out of sight, seconds, after which a moving obstacle could be anywhere and is forgotten.
pub const OUT_OF_SIGHT_S: f64 = 2.0;
/// Mean misfit above which an object no longer counts as a disc, and below which it counts as a disc again.
const MISFIT: (f64, f64) = (2.2, 1.6);
/// Maximum misfit of a view that can show a disc.
const ROUND: f64 = 4.0;
/// Minimum number of points for the misfit of a view to count.
const TELLING: usize = 5;
/// Weight of a new view in the mean misfit.
const SMOOTHING: f64 = 0.1;
/// Minimum standard deviation, metres, so that an estimate can still be corrected.
const FLOOR_M: f64 = 0.003;
/// Maximum extent, metres, of an object whose centre shows whether it moves.
const MOVABLE_M: f64 = 1.2;

/// One track.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    /// The id, once the track is an obstacle.
    pub id: Option<ObstacleId>,
    center: Point,
    covariance: Matrix2<f64>,
    radius: Radius,
    outline: Outline,
    misfit: f64,
    is_disc: bool,
    drift: Drift,
    /// One bit for each recent scan, the latest in the lowest bit: whether the scan showed the track.
    recent: u32,
    missed: u32,
    /// Number of scans through the track's place since the track was last seen, and whether the last scan passed
    /// through it.
    through: u32,
    is_through: bool,
    /// Number of scans in a row whose rays passed through the middle of the outline, although they showed points of it.
    crossed: u32,
    /// Whether the last scan showed the track.
    pub is_seen: bool,
    seen_s: f64,
    /// Largest standard deviation of the centre in the last view, metres.
    view_sigma_m: f64,
    /// Distance from the sensor, metres.
    far_m: f64,
}

impl Track {
    /// Creates a track from points in the order of the scan; `None` if no disc can be fitted to them.
    pub(crate) fn new(rays: &Rays, of: &[usize], pose: &Uncertain, now_s: f64) -> Option<Self> {
        let fit = disc::fit(rays, of, pose.sigma_m, None)?;
        let mut track = Self {
            id: None,
            center: fit.center,
            covariance: place_of(&fit, rays, pose),
            radius: fit.radius,
            outline: Outline::default(),
            misfit: 1.0,
            is_disc: true,
            drift: Drift::default(),
            recent: 0,
            missed: 0,
            through: 0,
            is_through: false,
            crossed: 0,
            is_seen: false,
            seen_s: now_s,
            view_sigma_m: 0.0,
            far_m: 0.0,
        };
        track.note(rays, of, &fit, pose, now_s);
        Some(track)
    }

    /// Updates the track with points in the order of the scan.
    pub(crate) fn see(&mut self, rays: &Rays, of: &[usize], pose: &Uncertain, now_s: f64) {
        let before = (!self.moves()).then_some(self.radius);
        if let Some(fit) = disc::fit(rays, of, pose.sigma_m, before) {
            self.note(rays, of, &fit, pose, now_s);
        }
    }

    fn note(&mut self, rays: &Rays, of: &[usize], fit: &Fit, pose: &Uncertain, now_s: f64) {
        (self.is_seen, self.seen_s, self.missed, self.through) = (true, now_s, 0, 0);
        self.is_through = false;
        self.recent |= 1;
        self.view_sigma_m = fit.covariance.symmetric_eigenvalues().max().max(0.0).sqrt();
        self.far_m = (fit.center - rays.eye()).norm() - fit.radius.mean_m;
        if of.len() >= TELLING {
            self.misfit += SMOOTHING * (fit.misfit.min(20.0) - self.misfit);
        }
        self.is_disc = if self.is_disc { self.misfit < MISFIT.0 } else { self.misfit < MISFIT.1 };
        // If a disc is fitted to an object that is not a disc, its centre moves with the robot. If an object is partly
        // hidden, its centre seems to move with the edge of what hides it.
        if self.is_disc && fit.misfit < ROUND && self.extent_m() < MOVABLE_M {
            if self.view_sigma_m < SURE_PLACE_M {
                self.drift.see(now_s, fit.center);
            }
        } else if !self.is_disc {
            self.drift = Drift::default();
        }
        if self.moves() {
            (self.center, self.covariance, self.radius) = (fit.center, place_of(fit, rays, pose), fit.radius);
            self.outline.clear();
        } else {
            self.blend(fit, rays, pose);
        }
        let noise_m = 2.0 * pose.sigma_m;
        for ray in of {
            self.outline.add(rays.point(*ray), noise_m);
        }
    }

    /// Combines the position and the radius so far with those of a new view.
    fn blend(&mut self, fit: &Fit, rays: &Rays, pose: &Uncertain) {
        let seen = place_of(fit, rays, pose);
        if let Some(inverse) = (self.covariance + seen).try_inverse() {
            let gain = self.covariance * inverse;
            self.center += gain * (fit.center - self.center);
            let left = self.covariance - gain * self.covariance;
            self.covariance = 0.5 * (left + left.transpose()) + Matrix2::identity() * 1e-9;
        }
        self.radius = self.radius.with_share(&fit.radius, 1.0 / LIKE_VIEWS);
        self.radius.variance_m2 = self.radius.variance_m2.max(FLOOR_M * FLOOR_M);
    }

    /// Prepares the track for a new scan, which was made `later_s` seconds after the last one.
    pub(crate) fn begin(&mut self, later_s: f64) {
        if let Some(velocity) = self.drift.velocity() {
            self.center += velocity * later_s.clamp(0.0, OUT_OF_SIGHT_S);
        }
        self.recent <<= 1;
        self.is_seen = false;
    }

    /// Records that a scan did not show the track; `through` states whether its rays passed through the track's place.
    pub(crate) fn miss(&mut self, through: bool) {
        self.missed = self.missed.saturating_add(1);
        self.through = self.through.saturating_add(u32::from(through));
        self.is_through = through;
    }

    /// Records what the last scan shows in the middle of an outline; returns whether it has become certain that nothing
    /// is there, so that the points of the outline belong to several objects.
    pub(crate) fn cross(&mut self, look: Look) -> bool {
        self.crossed = match look {
            Look::Through if !self.is_disc => self.crossed + 1,
            Look::Hidden => self.crossed,
            _ => 0,
        };
        self.crossed >= CROSSED
    }

    /// Forgets the shape, and begins again with points in the order of the scan.
    pub(crate) fn restart(&mut self, rays: &Rays, of: &[usize], pose: &Uncertain, now_s: f64) {
        if let Some(track) = Self::new(rays, of, pose, now_s) {
            *self = Self { id: self.id, recent: self.recent, ..track };
        }
    }

    /// Whether the track is to be dropped. An obstacle that is gone stays on the chart.
    pub(crate) fn is_over(&self, now_s: f64) -> bool {
        match self.id {
            None => self.missed >= MISSED,
            Some(_) => self.is_gone().is_some() || self.moves() && now_s - self.seen_s > OUT_OF_SIGHT_S,
        }
    }

    /// Time, seconds, at which the track was last seen, if it can be dropped because the chart has it.
    pub(crate) fn charted_s(&self) -> Option<f64> {
        (self.id.is_some() && !self.is_seen && !self.moves()).then_some(self.seen_s)
    }

    /// Returns the number of scans that passed through the track's place if the last scan has made it certain that the
    /// object is gone.
    pub(crate) fn is_gone(&self) -> Option<u32> {
        (self.through == GONE_AFTER && self.is_through).then_some(self.through)
    }

    /// Whether the track is near enough (`reach_m`, metres) and certain enough to become an obstacle.
    pub(crate) fn is_mature(&self, reach_m: f64) -> bool {
        let recent = self.recent & ((1 << BIRTH_OF) - 1);
        let is_sure = self.radius.variance_m2.sqrt() < SURE_RADIUS_M && self.view_sigma_m < SURE_PLACE_M;
        let is_seen = recent.count_ones() >= BIRTH_HITS && self.far_m <= reach_m;
        is_seen && (is_sure || !self.is_disc || self.far_m < NEAR_M)
    }

    /// The shape as far as it is known, tank frame.
    pub(crate) fn shape(&self) -> Shape {
        let disc = || Shape::Disc { center: self.center, radius_m: self.radius.mean_m };
        if self.is_disc { disc() } else { self.outline.shape().unwrap_or_else(disc) }
    }

    /// A disc around the shape: its centre and radius.
    pub(crate) fn around(&self) -> (Point, f64) {
        if self.is_disc {
            (self.center, self.radius.mean_m)
        } else {
            crate::drawing::disc_around(&self.shape())
        }
    }

    /// Maximum distance from the track's outline at which a point belongs to the track, metres.
    pub(crate) fn gate_m(&self, pose: &Uncertain, range_m: f64) -> f64 {
        let own_m2 = self.covariance.trace() + self.radius.variance_m2;
        let gate_m = 3.0 * (pose.sigma_m.powi(2) + pose.point_m2(range_m) + own_m2).sqrt();
        let room_m = if self.moves() || !self.is_disc { 0.1 } else { 0.03 };
        gate_m.min(0.3) + room_m
    }

    /// Standard deviation of the outline, metres.
    pub(crate) fn sigma_m(&self) -> f64 {
        let place_m2 = self.covariance.symmetric_eigenvalues().max();
        (place_m2 + self.radius.variance_m2).max(0.0).sqrt()
    }

    /// The velocity, metres per second, tank frame; `None` if the object stands still.
    pub(crate) fn velocity(&self) -> Option<Vector> {
        self.drift.velocity()
    }

    /// Whether the object moves.
    pub(crate) fn moves(&self) -> bool {
        self.velocity().is_some()
    }

    /// The recent positions.
    pub(crate) fn drift(&self) -> &Drift {
        &self.drift
    }

    /// Largest extent, metres.
    pub(crate) fn extent_m(&self) -> f64 {
        self.outline.extent_m()
    }
}

/// Covariance of the centre after a single view, including the error of the pose.
fn place_of(fit: &Fit, rays: &Rays, pose: &Uncertain) -> Matrix2<f64> {
    let arm = fit.center.coords - rays.frame().translation.vector;
    let floor = Matrix2::identity() * FLOOR_M * FLOOR_M;
    fit.covariance * LIKE_VIEWS + pose.of_place(arm) * ALIKE + floor
}
