//! No-go zones that were drawn after the scenario was opened.

use mission::Phase;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Point, Shape, Zone, shape::ring_area_m2};

/// The source of drawn zones; only the operator can draw one.
const OPERATOR: &str = "operator";

/// A no-go zone that was drawn after the scenario was opened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DrawnZone {
    /// Name of the zone.
    pub name: String,
    /// The source of the zone: who drew it.
    pub by: String,
    /// Mission time at which the zone was drawn, seconds; absent if that was before the start.
    pub t_s: Option<f64>,
    /// Area of the zone, square metres.
    pub area_m2: f64,
    /// Corners of the zone, metres, tank frame.
    pub corners: Vec<Point>,
}

impl DrawnZone {
    /// Creates the record of a zone that is being drawn, in a mission of this phase.
    pub(crate) fn new(zone: &Zone, t_s: f64, phase: &Phase) -> Self {
        let corners = match &zone.shape {
            Shape::Polygon { vertices } => vertices.clone(),
            _ => Vec::new(),
        };
        Self {
            name: zone.name.clone(),
            by: OPERATOR.to_owned(),
            t_s: (*phase != Phase::Waiting).then_some(t_s),
            area_m2: ring_area_m2(&corners).abs(),
            corners,
        }
    }

    /// A text with the name of the zone, who drew it, and when.
    pub(crate) fn words(&self) -> String {
        let when = self.t_s.map_or_else(|| "before the start".to_owned(), |t_s| format!("at {t_s:.1} s"));
        format!("no-go zone {}, drawn by the {} {when}", self.name, self.by)
    }
}

impl fmt::Display for DrawnZone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let corner = |corner: &Point| format!("{:.2}, {:.2}", corner.x + 0.0, corner.y + 0.0);
        let corners = self.corners.iter().map(corner).collect::<Vec<_>>().join("; ");
        write!(f, "{}: {:.2} m², corners {corners} m", self.words(), self.area_m2)
    }
}
