//! Ranges from their stations towards the believed position: the gap between tip and robot is the residual.

use super::{
    lane::{Flat, flat},
    paths,
    stream::Stream,
    style,
    tick::Tick,
};
use crate::{error::RecordingError, rr};
use positioning::Ranging;
use world::Station;

/// Draws the ranges and the fix of a tick.
pub(crate) fn draw(stream: &Stream, stations: &[Station], tick: &Tick) -> Result<(), RecordingError> {
    if let Some(ranges) = &tick.ranges {
        let excluded = |range: &Ranging| {
            let mut excluded = tick.fix.iter().flat_map(|fix| &fix.excluded);
            excluded.any(|(station, _)| *station == range.station)
        };
        let drawn: Vec<_> =
            ranges.iter().filter_map(|range| Some((line(range, stations, tick)?, excluded(range)))).collect();
        let ink = |excluded| if excluded { style::RANGE_EXCLUDED } else { style::RANGE };
        let lines = rr::LineStrips2D::update_fields()
            .with_strips(drawn.iter().map(|(line, _)| rr::LineStrip2D::from_iter(*line)))
            .with_colors(drawn.iter().map(|(_, excluded)| style::color(ink(*excluded))));
        stream.once(paths::RANGES, tick.at, &lines)?;
    }
    let Some(fix) = &tick.fix else { return Ok(()) };
    let dot = rr::Points2D::update_fields().with_positions([flat(fix.position)]);
    stream.once(paths::FIX, tick.at, &dot)
}

fn line(range: &Ranging, stations: &[Station], tick: &Tick) -> Option<[Flat; 2]> {
    let station = stations.iter().find(|station| station.id == range.station)?;
    let towards = (tick.believed - station.position).try_normalize(1e-9)?;
    Some([flat(station.position), flat(station.position + towards * range.range_m)])
}
