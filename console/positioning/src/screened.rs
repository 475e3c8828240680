//! A solver that checks its residuals, and leaves out the one station that contradicts all others.

use crate::{
    fix::{Exclusion, Fix, FixError, Integrity, PositionSolver, Prior, Ranging},
    quality::residual_gate_m,
};
use world::Station;

/// The number of stations needed to identify a wrong one.
const NEEDED_TO_EXCLUDE: usize = 5;

/// Solves; if the residuals raise an alarm, looks for the one station without which the other stations agree.
///
/// If two stations qualify and their answers are far apart, the fix is suspect. If none qualifies, the alarm stays:
/// two stations that are wrong together need [`crate::Consensus`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Screened<S>(pub S);

impl<S: PositionSolver> PositionSolver for Screened<S> {
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError> {
        let fix = self.0.solve(ranges, stations, prior)?;
        if fix.integrity != Integrity::Alarm || ranges.len() < NEEDED_TO_EXCLUDE {
            return Ok(fix);
        }
        let mut sound: Vec<Fix> =
            ranges.iter().filter_map(|left_out| self.without(left_out, ranges, stations, prior)).collect();
        sound.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));
        let mut found = sound.into_iter();
        let Some(mut best) = found.next() else { return Ok(fix) };
        let is_elsewhere = |other: &Fix| {
            (other.position - best.position).norm() > best.ellipse_95().0 + other.ellipse_95().0
        };
        if let Some(rival) = found.find(is_elsewhere) {
            best.integrity = Integrity::Suspect;
            best.mirror = best.mirror.or(Some(rival.position));
        }
        Ok(best)
    }
}

impl<S: PositionSolver> Screened<S> {
    /// Returns the fix without one station, if the other stations agree and the omitted station contradicts them.
    fn without(
        &self,
        left_out: &Ranging,
        ranges: &[Ranging],
        stations: &[Station],
        prior: Option<Prior>,
    ) -> Option<Fix> {
        let others: Vec<Ranging> = ranges.iter().filter(|r| r.station != left_out.station).copied().collect();
        let mut fix = self.0.solve(&others, stations, prior).ok()?;
        let station = stations.iter().find(|s| s.id == left_out.station)?;
        let distance_m = (fix.position - station.position).norm();
        let gate_m = residual_gate_m(left_out.sigma_at_m(distance_m));
        let residual_m = left_out.range_m - self.0.excess_m(&fix, &others, stations) - distance_m;
        fix.excluded.push((left_out.station, Exclusion::Residual { residual_m, gate_m }));
        (fix.integrity == Integrity::Ok && residual_m.abs() > gate_m).then_some(fix)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::{
        Aggregation, Nls,
        draws::{Draws, ring},
    };
    use world::{Point, StationId};

    #[test]
    fn a_station_off_by_a_metre_never_misleads_unnoticed() {
        let mut draws = Draws::new(0.05, 20, 12);
        for n in [6, 7, 8] {
            let stations = ring(n, 7.5);
            let (mut misled, mut available) = (0, 0);
            for run in 0..1_500 {
                let truth = draws.on_disc();
                let mut ranges = draws.rangings(&stations, truth, Aggregation::Mean);
                ranges[run % n as usize].range_m += 1.0;
                let fix = Screened(Nls).solve(&ranges, &stations, None).unwrap();
                let is_trusted = fix.integrity == Integrity::Ok;
                misled += usize::from(is_trusted && (fix.position - truth).norm() > 0.3);
                available += usize::from(is_trusted);
            }
            assert_eq!(misled, 0, "{n} stations");
            assert!(available > 1_400, "{n} stations: {available}");
        }
    }

    #[test]
    fn the_station_left_out_is_named_with_its_residual() {
        let stations = ring(6, 7.5);
        let mut ranges = crate::draws::exact(&stations, Point::new(2.0, 1.0));
        ranges[3].range_m += 1.0;
        let fix = Screened(Nls).solve(&ranges, &stations, None).unwrap();
        assert!(
            matches!(fix.excluded[..], [(StationId(4), Exclusion::Residual { residual_m, .. })] if (residual_m - 1.0).abs() < 1e-6)
        );
    }
}
