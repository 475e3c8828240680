//! The scans that arrive while a vehicle is only listened to. Whether they are mirrored or rotated shows only against the
//! drawing of a tank, which a trial does not have; the pre-flight check of a mission judges that.

use super::{Figure, Listened, Row};
use crate::wire::message::{Hello, Scan};
use std::f64::consts::TAU;

/// Longest time between two scans, seconds: the guard of a mission cannot use older ones.
const GAP_MAX_S: f64 = 0.5;
/// Share of the rays of a scan by which the scan may exceed a full turn: some scanners repeat their first rays.
const TURN_SPARE: f64 = 0.05;
/// Maximum share of the scans without any echo, and of those whose distances are all 0.
const EMPTY_SHARE: f64 = 0.1;

/// Whether the scans can serve a mission; `None` for a vehicle without a scanner.
pub fn scanner(hello: &Hello, listened: &Listened) -> Option<Row> {
    hello.has.scan.then(|| judged(listened))
}

fn judged(listened: &Listened) -> Row {
    let check = "scanner";
    let scans: Vec<(f64, &Scan)> = listened
        .readings
        .iter()
        .filter_map(|(_, readings)| Some((readings.stamp_s, readings.scan.as_ref()?)))
        .collect();
    if scans.is_empty() {
        return Row::fail(check, Vec::new(), "no scan arrived; check the scanner and its connection");
    }
    let rays = |scan: &Scan| scan.ranges_m.len();
    let share = |is_so: &dyn Fn(&Scan) -> bool| {
        scans.iter().filter(|(_, scan)| is_so(scan)).count() as f64 / scans.len() as f64
    };
    let echoes: usize = scans.iter().map(|(_, scan)| scan.ranges_m.iter().flatten().count()).sum();
    let all_rays: usize = scans.iter().map(|(_, scan)| rays(scan)).sum();
    let (fewest, most) = scans
        .iter()
        .map(|(_, scan)| rays(scan))
        .fold((usize::MAX, 0), |(fewest, most), rays| (fewest.min(rays), most.max(rays)));
    let first_s = listened.readings.first().map_or(0.0, |(_, readings)| readings.stamp_s);
    let last_s = listened.readings.last().map_or(first_s, |(_, readings)| readings.stamp_s);
    let times = [first_s].into_iter().chain(scans.iter().map(|(at_s, _)| *at_s)).chain([last_s]);
    let times: Vec<f64> = times.collect();
    let gap_s = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let figures = vec![
        Figure::new("rays", most as f64, ""),
        Figure::new("with an echo", 100.0 * echoes as f64 / all_rays.max(1) as f64, "%"),
        Figure::new("longest gap", gap_s, "s").at_most(GAP_MAX_S),
    ];
    let is_over_a_turn = |scan: &Scan| {
        let turn_rad = (rays(scan).saturating_sub(1)) as f64 * scan.step_rad.abs();
        turn_rad > (1.0 + TURN_SPARE) * TAU
    };
    let wrong = if share(&|scan| scan.ranges_m.iter().all(|range_m| *range_m == Some(0.0))) > EMPTY_SHARE {
        Some(
            "all distances of the scan are 0; check that nothing covers the scanner, and its driver"
                .to_owned(),
        )
    } else if share(&|scan| scan.ranges_m.iter().all(Option::is_none)) > EMPTY_SHARE {
        let range_m = scans.iter().map(|(_, scan)| scan.range_max_m).fold(0.0, f64::max);
        Some(format!(
            "no ray has an echo; place the vehicle within {range_m} m of a wall, and check that nothing covers the \
             scanner"
        ))
    } else if let Some((_, scan)) = scans.iter().find(|(_, scan)| is_over_a_turn(scan)) {
        let turns = rays(scan).saturating_sub(1) as f64 * scan.step_rad.abs() / TAU;
        Some(format!("the rays cover {turns:.1} turns; `step_rad` is the angle between two rays, in radians"))
    } else if fewest.saturating_mul(2) < most {
        Some(format!(
            "the scans have from {fewest} to {most} rays; a scan must have the rays of a full sweep"
        ))
    } else {
        None
    };
    if let Some(wrong) = wrong {
        return Row::fail(check, figures, wrong);
    }
    let says =
        format!("{} scans; the pre-flight check compares their direction with the drawing", scans.len());
    let failed = format!("more than {GAP_MAX_S} s without a scan; the guard of a mission would be blind");
    Row::judged(check, figures, &says, &failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        trial::Verdict,
        wire::message::{Has, Limits, MotionKind, Readings},
    };

    /// The row for scans that are made every `every_s` seconds for 5 s, and spoiled in turn.
    fn row(every_s: f64, spoil: impl Fn(usize, &mut Scan)) -> Row {
        let one = |n: usize| {
            let ranges_m = (0..360).map(|ray| (ray % 7 != 0).then_some(2.0)).collect();
            let mut scan = Scan {
                first_rad: -std::f64::consts::PI,
                step_rad: TAU / 360.0,
                range_max_m: 8.0,
                sensor_m: [0.0, 0.0],
                ranges_m,
            };
            spoil(n, &mut scan);
            let scan = (0.1 * n as f64 % every_s < 0.05).then_some(scan);
            let stamp_s = 20.0 + 0.1 * n as f64;
            (stamp_s, Readings { seq: n as u64, stamp_s, scan, ..Readings::default() })
        };
        let heard = Listened { readings: (0..50).map(one).collect(), ..Listened::default() };
        judged(&heard)
    }

    #[test]
    fn each_wrong_scan_is_named_and_good_ones_pass() {
        let cases: [(Row, &str); 8] = [
            (row(0.1, |_, _| {}), ""),
            // A ray or a scan may be lost now and then.
            (
                row(0.1, |n, scan| {
                    if n % 20 == 0 {
                        scan.ranges_m.fill(None);
                    }
                }),
                "",
            ),
            (row(0.1, |n, scan| scan.ranges_m.truncate(360 - n)), ""),
            (
                row(0.1, |_, scan| scan.ranges_m.fill(None)),
                "no ray has an echo; place the vehicle within 8 m",
            ),
            (row(0.1, |_, scan| scan.ranges_m.fill(Some(0.0))), "all distances of the scan are 0"),
            (row(0.1, |_, scan| scan.step_rad = 1.0), "the rays cover 57.1 turns"),
            (
                row(0.1, |n, scan| {
                    if n % 2 == 0 {
                        scan.ranges_m.truncate(90);
                    }
                }),
                "from 90 to 360 rays",
            ),
            (row(0.9, |_, _| {}), "more than 0.5 s without a scan"),
        ];
        for (row, why) in cases {
            assert_eq!(row.verdict == Verdict::Pass, why.is_empty(), "{why}: {row:?}");
            assert!(row.says.contains(why), "{why}: {row:?}");
        }
    }

    #[test]
    fn a_scanner_that_never_sends_or_stops_is_named() {
        let mut heard = Listened::default();
        assert!(judged(&heard).says.starts_with("no scan arrived"));
        let scan = Scan {
            first_rad: 0.0,
            step_rad: 0.1,
            range_max_m: 8.0,
            sensor_m: [0.0, 0.0],
            ranges_m: vec![Some(1.0); 60],
        };
        let reading = |n: u64| {
            let scan = (n < 20).then(|| scan.clone());
            (0.1 * n as f64, Readings { seq: n, stamp_s: 0.1 * n as f64, scan, ..Readings::default() })
        };
        heard.readings = (0..50).map(reading).collect();
        let row = judged(&heard);
        assert!(row.verdict == Verdict::Fail && row.says.contains("without a scan"), "{row:?}");
    }

    #[test]
    fn a_vehicle_without_a_scanner_has_no_such_row() {
        let limits =
            Limits { speed_m_per_s: 0.4, turn_rad_per_s: 1.0, acceleration_m_per_s2: 0.5, radius_m: 0.2 };
        let hello = |scan| Hello {
            protocol: 1,
            name: "crawler".into(),
            motion: MotionKind::Unicycle,
            limits,
            has: Has { scan, ..Has::default() },
            period_s: 0.1,
            stop_time_s: 0.9,
            lease_max_s: 0.5,
            session: None,
        };
        assert_eq!(scanner(&hello(false), &Listened::default()), None);
        assert!(scanner(&hello(true), &Listened::default()).is_some());
    }
}
