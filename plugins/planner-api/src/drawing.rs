//! What a planner draws to explain itself, on screen and in the recording.

use nalgebra::{Point2, Vector2};

/// What a drawing stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum Layer {
    /// Pull of the target.
    Attraction = 0,
    /// Push of the obstacles.
    Repulsion = 1,
    /// Rotating or tangential force.
    Rotation = 2,
    /// Sum of all forces.
    Resultant = 3,
    /// Obstacles or targets that the planner made up.
    Virtual = 4,
    /// A path under consideration.
    Path = 5,
    /// The tether as the planner sees it.
    Tether = 6,
    /// Anything else.
    Other = 7,
}

impl Layer {
    /// Every layer, in the order of its number.
    pub const ALL: [Self; 8] = [
        Self::Attraction,
        Self::Repulsion,
        Self::Rotation,
        Self::Resultant,
        Self::Virtual,
        Self::Path,
        Self::Tether,
        Self::Other,
    ];

    /// The layer of a number that came over the boundary; `Other` for unknown ones.
    ///
    /// ```
    /// use planner_api::Layer;
    ///
    /// assert_eq!(Layer::from_number(Layer::Path as u32), Layer::Path);
    /// assert_eq!(Layer::from_number(99), Layer::Other);
    /// ```
    pub fn from_number(number: u32) -> Self {
        Self::ALL.get(number as usize).copied().unwrap_or(Self::Other)
    }
}

/// One thing drawn, in the tank frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Drawing {
    /// An arrow; for forces one newton is drawn as one metre unless the planner scales it.
    Arrow {
        /// What it stands for.
        layer: Layer,
        /// Foot of the arrow.
        at: Point2<f64>,
        /// From foot to tip.
        vector: Vector2<f64>,
    },
    /// A circle.
    Circle {
        /// What it stands for.
        layer: Layer,
        /// Centre.
        center: Point2<f64>,
        /// Radius, metres.
        radius_m: f64,
    },
    /// A straight piece of a line.
    Line {
        /// What it stands for.
        layer: Layer,
        /// From.
        from: Point2<f64>,
        /// To.
        to: Point2<f64>,
    },
}
