//! Ranges, drawn from their stations towards the estimated position: the gap between the tip and the robot is the
//! residual.

use super::{
    lane::{Flat, InkedLines, Lane, flat},
    paths,
    stream::Stream,
    style, table,
    tick::Tick,
};
use crate::error::RecordingError;
use positioning::{Exclusion, Fix, Ranging};
use world::{Station, StationId};

/// The ranges and the fixes on the map.
pub(crate) struct Rangings {
    ranges: Lane<InkedLines>,
    fixes: Lane<Flat>,
}

impl Rangings {
    /// State before any range.
    pub(crate) fn new() -> Self {
        Self { ranges: Lane::new(paths::RANGES), fixes: Lane::new(paths::FIX) }
    }

    /// Adds a completed tick.
    pub(crate) fn push(&mut self, stations: &[Station], tick: &Tick) {
        if let Some(ranges) = &tick.ranges {
            let ink = |range: &Ranging| {
                let mut excluded = tick.fix.iter().flat_map(|fix| &fix.excluded);
                let is_excluded = excluded.any(|(station, _)| *station == range.station);
                if is_excluded { style::RANGE_EXCLUDED } else { style::RANGE }
            };
            let drawn = ranges.iter().filter_map(|range| Some((line(range, stations, tick)?, ink(range))));
            self.ranges.push(tick.at, InkedLines(drawn.collect()));
        }
        if let Some(fix) = &tick.fix {
            self.fixes.push(tick.at, flat(fix.position));
        }
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        self.ranges.send(stream)?;
        self.fixes.send(stream)
    }
}

fn line(range: &Ranging, stations: &[Station], tick: &Tick) -> Option<[Flat; 2]> {
    let station = stations.iter().find(|station| station.id == range.station)?;
    let towards = (tick.believed - station.position).try_normalize(1e-9)?;
    Some([flat(station.position), flat(station.position + towards * range.range_m)])
}

/// The residuals of each station: measured minus expected range, including stations that were rejected because of
/// them.
pub(crate) struct Residuals(Vec<(StationId, Lane<f64>)>);

impl Residuals {
    /// The stations of a run, and the styles of their curves.
    pub(crate) fn open(stream: &Stream, stations: &[Station]) -> Result<Self, RecordingError> {
        let mut lanes = Vec::new();
        for (station, color) in stations.iter().zip(style::SERIES.into_iter().cycle()) {
            let lane = Lane::new(format!("{}/{}", paths::RESIDUALS, table::entity_name(&station.name)));
            stream.always(lane.path(), &table::curve(&station.name, color))?;
            lanes.push((station.id, lane));
        }
        Ok(Self(lanes))
    }

    /// Adds a completed tick.
    pub(crate) fn push(&mut self, tick: &Tick) {
        let Some(fix) = &tick.fix else { return };
        for (station, lane) in &mut self.0 {
            if let Some(residual_m) = residual_m(fix, *station) {
                lane.push(tick.at, residual_m);
            }
        }
    }

    /// Sends the waiting rows.
    pub(crate) fn send(&mut self, stream: &Stream) -> Result<(), RecordingError> {
        self.0.iter_mut().try_for_each(|(_, lane)| lane.send(stream))
    }
}

fn residual_m(fix: &Fix, station: StationId) -> Option<f64> {
    let used = fix.residuals.iter().find(|residual| residual.station == station);
    let rejected = || {
        fix.excluded.iter().find_map(|(id, why)| match why {
            Exclusion::Residual { residual_m, .. } if *id == station => Some(*residual_m),
            _ => None,
        })
    };
    used.map(|residual| residual.residual_m).or_else(rejected)
}
