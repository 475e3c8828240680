//! The map: its part of the tank, and its layers.

use serde::{Deserialize, Serialize};

/// The part of the tank on the map.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MapView {
    /// How many times the scale has been doubled; 0 shows the whole tank.
    pub zoom: u8,
    /// Whether the map stays centred on the robot.
    pub follow: bool,
    /// The offset of the map's centre from the tank's centre, metres, when the map does not follow the robot.
    pub offset: world::Vector,
}

/// The maximum number of doublings of the map's scale.
pub const MAX_ZOOM: u8 = 6;

/// A map layer that can be hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapLayer {
    /// Scanned floor.
    Scanned,
    /// The robot's trail.
    Trail,
    /// The path of the plan.
    Plan,
    /// The planner's drawings.
    Drawings,
    /// Acoustic-emission stations.
    Stations,
    /// Floor where the stations are forecast to locate the robot poorly.
    Accuracy,
    /// The points of the last scan.
    Scan,
    /// Floor where fixes are forecast to have a large protection level, or none.
    Protection,
    /// The map that a survey makes: floor not seen, frontiers, columns and the way.
    Explored,
}

impl MapLayer {
    /// All layers, in the order of the layer list.
    pub const ALL: [Self; 9] = [
        Self::Scanned,
        Self::Trail,
        Self::Plan,
        Self::Drawings,
        Self::Stations,
        Self::Accuracy,
        Self::Scan,
        Self::Protection,
        Self::Explored,
    ];

    /// The layer's name in the list.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scanned => "scanned floor",
            Self::Trail => "robot trail",
            Self::Plan => "plan",
            Self::Drawings => "planner drawings",
            Self::Stations => "AE stations",
            Self::Accuracy => "accuracy forecast",
            Self::Scan => "scan points",
            Self::Protection => "protection level",
            Self::Explored => "map of a survey",
        }
    }
}

/// Which map layers are hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layers {
    hidden: [bool; MapLayer::ALL.len()],
}

impl Default for Layers {
    /// Shows every layer except the forecasts, which are for planning rather than for watching.
    fn default() -> Self {
        let is_forecast = |layer| matches!(layer, MapLayer::Accuracy | MapLayer::Protection);
        Self { hidden: MapLayer::ALL.map(is_forecast) }
    }
}

impl Layers {
    /// Whether a layer is shown.
    pub fn shows(&self, layer: MapLayer) -> bool {
        !self.hidden[layer as usize]
    }

    /// Shows or hides a layer.
    pub fn toggle(&mut self, layer: MapLayer) {
        self.hidden[layer as usize] = self.shows(layer);
    }
}
