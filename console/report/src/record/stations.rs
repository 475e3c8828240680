//! The fixes of a run, station by station.

use mission::ClockOffset;
use positioning::{Estimated, Fix};
use serde::Serialize;
use std::collections::BTreeMap;
use world::{Point, Station, StationId};

/// A station and its part in the fixes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StationRecord {
    /// Name of the station.
    pub name: String,
    /// Surveyed position, metres.
    pub at: Point,
    /// Number of fixes that used the station.
    pub used: u64,
    /// Number of fixes that left the station out.
    pub rejected: u64,
    /// Mean of the station's residuals, metres; absent if the station was never used.
    pub residual_mean_m: Option<f64>,
    /// Root mean square of the station's residuals, metres; absent if the station was never used.
    pub residual_rms_m: Option<f64>,
    /// Last estimate of the offset of the station's clock, relative to the mean of all stations, as a length that sound
    /// travels, metres; absent if the stations share one clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clock_offset_m: Option<Estimated>,
}

#[derive(Debug, Default)]
struct Sums {
    used: u64,
    rejected: u64,
    sum_m: f64,
    squares_m2: f64,
    clock_offset_m: Option<Estimated>,
}

#[derive(Debug, Default)]
pub(super) struct Stations {
    stations: Vec<Station>,
    sums: BTreeMap<StationId, Sums>,
}

impl Stations {
    pub(super) fn new(stations: &[Station]) -> Self {
        let sums = stations.iter().map(|station| (station.id, Sums::default())).collect();
        Self { stations: stations.to_vec(), sums }
    }

    pub(super) fn fix(&mut self, fix: &Fix) {
        for residual in &fix.residuals {
            // A damaged journal may name stations that do not exist.
            let Some(sums) = self.sums.get_mut(&residual.station) else { continue };
            sums.used += 1;
            sums.sum_m += residual.residual_m;
            sums.squares_m2 += residual.residual_m.powi(2);
        }
        for (station, _) in &fix.excluded {
            if let Some(sums) = self.sums.get_mut(station) {
                sums.rejected += 1;
            }
        }
    }

    pub(super) fn clocks(&mut self, offsets: &[ClockOffset]) {
        for ClockOffset { station, offset_m } in offsets {
            if let Some(sums) = self.sums.get_mut(station) {
                sums.clock_offset_m = Some(*offset_m);
            }
        }
    }

    pub(super) fn records(&self) -> Vec<StationRecord> {
        let none = Sums::default();
        let record = |station: &Station| {
            let sums = self.sums.get(&station.id).unwrap_or(&none);
            let mean = |sum: f64| (sums.used > 0).then(|| sum / sums.used as f64);
            StationRecord {
                name: station.name.clone(),
                at: station.position,
                used: sums.used,
                rejected: sums.rejected,
                residual_mean_m: mean(sums.sum_m),
                residual_rms_m: mean(sums.squares_m2).map(f64::sqrt),
                clock_offset_m: sums.clock_offset_m,
            }
        };
        self.stations.iter().map(record).collect()
    }
}
