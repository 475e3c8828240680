//! The true loss of metal of a simulated floor.

use geometry::Point;
use serde::{Deserialize, Serialize};

/// The shape of a loss across its radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossProfile {
    /// Deepest in the middle, and nothing at the edge: a paraboloid.
    Pit,
    /// The same depth everywhere.
    Thinning,
}

/// The side of the plate from which metal is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlateSide {
    /// The side on which the robot drives.
    Top,
    /// The side on the ground.
    Underside,
}

/// A round loss of metal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MetalLoss {
    /// The middle, tank frame, metres.
    pub at: Point,
    /// Radius, metres.
    pub radius_m: f64,
    /// Depth in the middle, millimetres.
    pub depth_mm: f64,
    /// The shape.
    pub profile: LossProfile,
    /// The side.
    pub side: PlateSide,
}

impl MetalLoss {
    /// Returns the depth at a place, millimetres; 0 outside the radius.
    ///
    /// ```
    /// use world::{LossProfile, MetalLoss, PlateSide, Point};
    /// let (at, profile, side) = (Point::origin(), LossProfile::Pit, PlateSide::Top);
    /// let pit = MetalLoss { at, radius_m: 0.02, depth_mm: 4.0, profile, side };
    /// assert_eq!([0.0, 0.01, 0.02].map(|x| pit.depth_mm_at(Point::new(x, 0.0))), [4.0, 3.0, 0.0]);
    /// ```
    pub fn depth_mm_at(&self, place: Point) -> f64 {
        let share2 = (place - self.at).norm_squared() / self.radius_m.powi(2);
        match self.profile {
            _ if share2 >= 1.0 => 0.0,
            LossProfile::Pit => self.depth_mm * (1.0 - share2),
            LossProfile::Thinning => self.depth_mm,
        }
    }
}

/// The true thickness of a simulated floor.
///
/// ```
/// use world::{FloorWear, LossProfile, MetalLoss, PlateSide, Point};
/// let loss = |x, depth_mm, side| MetalLoss {
///     at: Point::new(x, 0.0),
///     radius_m: 0.1,
///     depth_mm,
///     profile: LossProfile::Thinning,
///     side,
/// };
/// let losses = vec![loss(0.0, 2.0, PlateSide::Top), loss(0.05, 3.0, PlateSide::Underside)];
/// let wear = FloorWear { thickness_mm: 8.0, losses };
/// assert_eq!([-0.08, 0.0, 0.12].map(|x| wear.left_mm(Point::new(x, 0.0))), [6.0, 3.0, 5.0]);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FloorWear {
    /// Thickness where no metal is lost, millimetres.
    pub thickness_mm: f64,
    /// The losses; where several from the same side overlap, the deepest one counts.
    pub losses: Vec<MetalLoss>,
}

impl FloorWear {
    /// Returns the thickness that is left at a place, millimetres; at least 0.
    pub fn left_mm(&self, place: Point) -> f64 {
        self.left_mm_among(&self.losses, place)
    }

    /// Returns the thickness that is left at a place if only some losses are near it, millimetres; at least 0.
    pub fn left_mm_among<'a>(&self, losses: impl IntoIterator<Item = &'a MetalLoss>, place: Point) -> f64 {
        let (mut top_mm, mut underside_mm) = (0.0_f64, 0.0_f64);
        for loss in losses {
            let deepest_mm = if loss.side == PlateSide::Top { &mut top_mm } else { &mut underside_mm };
            *deepest_mm = deepest_mm.max(loss.depth_mm_at(place));
        }
        (self.thickness_mm - top_mm - underside_mm).max(0.0)
    }
}
