//! What a planner draws to explain its decisions, on screen and in the recording.

use nalgebra::{Point2, Vector2};

/// The meaning of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum Layer {
    /// The pull of the target.
    Attraction = 0,
    /// The push of the obstacles.
    Repulsion = 1,
    /// A rotating or tangential force.
    Rotation = 2,
    /// The sum of all forces.
    Resultant = 3,
    /// Virtual obstacles or targets.
    Virtual = 4,
    /// A path under consideration.
    Path = 5,
    /// The tether as the planner models it.
    Tether = 6,
    /// Anything else.
    Other = 7,
}

impl Layer {
    /// All layers, in the order of their numbers.
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

    /// Converts a number that was passed across the boundary; unknown numbers become `Other`.
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

/// One drawing, in the tank frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Drawing {
    /// An arrow. A force is drawn at one metre per newton unless the planner scales it.
    Arrow {
        /// What the arrow means.
        layer: Layer,
        /// The foot of the arrow.
        at: Point2<f64>,
        /// The vector from foot to tip.
        vector: Vector2<f64>,
    },
    /// A circle.
    Circle {
        /// What the circle means.
        layer: Layer,
        /// The centre.
        center: Point2<f64>,
        /// Radius, metres.
        radius_m: f64,
    },
    /// A straight line.
    Line {
        /// What the line means.
        layer: Layer,
        /// The first end.
        from: Point2<f64>,
        /// The second end.
        to: Point2<f64>,
    },
}
