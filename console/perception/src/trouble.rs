//! Why scans cannot be used.

use std::fmt;

/// What shows that the directions of a scan are wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The drawing.
    Drawing,
    /// Earlier scans and the motion of the robot since then.
    Motion,
}

impl Shown {
    /// What the scan fits only if its directions are corrected, in a sentence.
    fn words(self) -> &'static str {
        match self {
            Self::Drawing => "the drawing",
            Self::Motion => "the motion of the robot",
        }
    }
}

/// The reason why scans cannot be used. Its text is a clause that ends with what to check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trouble {
    /// A scan without rays.
    Empty,
    /// Angles that are not numbers, or all the same.
    Angles,
    /// Another number of rays than the scenario states.
    Rays {
        /// Number of rays.
        rays: usize,
        /// The number that the scenario states.
        wanted: u32,
    },
    /// Fewer than half as many rays as in the first scan.
    FewRays {
        /// Number of rays.
        rays: usize,
        /// The minimum.
        least: usize,
    },
    /// All distances are 0.
    Zero,
    /// Hardly any of the rays that must hit something on the drawing have an echo.
    NoEcho {
        /// The share of them that have an echo, 0 to 1.
        share: f64,
    },
    /// The scan fits only if it is mirrored.
    Mirrored {
        /// What shows this.
        by: Shown,
    },
    /// The scan fits only if it is rotated by half a turn.
    Backwards {
        /// What shows this.
        by: Shown,
    },
    /// Hardly any of the rays fit the drawing.
    Misfit {
        /// The share of them that fit, 0 to 1.
        share: f64,
    },
    /// More objects that are not drawn than can be followed.
    Crowded {
        /// The maximum number of objects.
        most: usize,
    },
}

impl Trouble {
    /// Whether another trouble has the same cause; its figures may differ.
    pub fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| (100.0 * share).round();
        match *self {
            Self::Empty => write!(f, "the scan has no rays; check the driver of the scanner"),
            Self::Angles => write!(
                f,
                "the angles of the scan are not numbers, or all the same; check the driver of the scanner"
            ),
            Self::Rays { rays, wanted } => write!(
                f,
                "the scan has {rays} rays instead of {wanted}; correct `robot.scanner` or the setting of the scanner"
            ),
            Self::FewRays { rays, least } => write!(
                f,
                "the scan has {rays} rays; it must have at least {least}, half as many as the first scan; check the \
                 driver of the scanner"
            ),
            Self::Zero => {
                write!(
                    f,
                    "all distances of the scan are 0; check that nothing covers the scanner, and its driver"
                )
            }
            Self::NoEcho { share } => write!(
                f,
                "only {} % of the rays that must hit the wall or a column have an echo; check the scanner",
                percent(share)
            ),
            Self::Mirrored { by } => write!(
                f,
                "the scan fits {} only if it is mirrored; check the direction of its angles",
                by.words()
            ),
            Self::Backwards { by } => write!(
                f,
                "the scan fits {} only if it is rotated by half a turn; check how the scanner is mounted",
                by.words()
            ),
            Self::Misfit { share } => write!(
                f,
                "only {} % of the scan fits the drawing; check the scanner, the position and the drawing",
                percent(share)
            ),
            Self::Crowded { most } => write!(
                f,
                "the scans show more than {most} objects that are not drawn; check the scanner, the position and the \
                 drawing"
            ),
        }
    }
}
