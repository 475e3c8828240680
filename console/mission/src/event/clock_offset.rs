//! The estimated clock of a station.

use positioning::Estimated;
use serde::{Deserialize, Serialize};
use world::StationId;

/// The offset of a station's clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClockOffset {
    /// Id of the station.
    pub station: StationId,
    /// Length by which the ranges of the station are too long, relative to the mean of all stations, metres.
    pub offset_m: Estimated,
}
