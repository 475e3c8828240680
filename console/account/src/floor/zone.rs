//! The critical zone along the shell.

use mission::MissionConfig;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use world::{Point, ShellFigures, ShellStretch};

/// Width of the critical zone along the shell, metres (API 653: 3 inches).
pub(crate) const CRITICAL_ZONE_M: f64 = 0.075;
/// Share of the shell along which the full width must be scanned for the zone to count as done.
const CRITICAL_DONE: f64 = 0.995;
/// Width, metres, below which an unreachable rim is not stated.
const LEAST_RIM_M: f64 = 0.005;
/// Length, metres: arcs less than this apart are merged, and arcs shorter than this are omitted.
const ARC_M: f64 = 0.1;

/// The critical zone along the shell, where the floor meets it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CriticalZone {
    /// Width of the zone, metres.
    pub width_m: f64,
    /// Length of the shell beside free floor, metres.
    #[serde(default)]
    pub length_m: f64,
    /// Length of shell along which the full width of the zone was scanned, metres.
    #[serde(default)]
    pub done_m: f64,
    /// Scanned share of the zone's area, 0 to 1; absent if the shell has no free floor beside it.
    pub scanned: Option<f64>,
    /// Median distance from the shell to the edge of the scanned floor, taken over the stretches where the zone is not
    /// done, metres; the width of the zone if none of it was scanned.
    #[serde(default)]
    pub gap_m: f64,
    /// Whether the zone is done: its full width is scanned along 99.5 % of the shell.
    pub done: bool,
    /// The reason why the zone is not done, as a sentence; absent if it is done.
    pub why: Option<String>,
    /// The zone plate by plate, in the order along the shell; empty if the plate layout is not known.
    #[serde(default)]
    pub plates: Vec<ZoneOfPlate>,
    /// Arcs of the shell of at least 0.1 m that are not done, in order along the shell; arcs less than 0.1 m apart
    /// count as one.
    #[serde(default)]
    pub arcs: Vec<ZoneArc>,
}

/// The zone on one plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ZoneOfPlate {
    /// Name of the plate.
    pub plate: String,
    /// Length of the shell beside free floor, metres.
    pub length_m: f64,
    /// Length of shell along which the full width of the zone was scanned, metres.
    pub done_m: f64,
    /// Median distance from the shell to the scanned floor, taken over the stretches where the zone is not done,
    /// metres.
    pub gap_m: f64,
}

/// An arc of the shell along which the full width of the zone was not scanned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ZoneArc {
    /// Distance along the shell to the start of the arc, metres: counter-clockwise from due east, or from the first
    /// corner of the drawing.
    pub from_m: f64,
    /// Distance along the shell to the end of the arc, metres; greater than the length of the shell if the arc runs
    /// past the origin.
    pub to_m: f64,
    /// Start point of the arc, metres.
    pub from: Point,
    /// End point of the arc, metres.
    pub to: Point,
    /// Length of shell that is not done, metres.
    pub not_done_m: f64,
    /// Median distance from the shell to the scanned floor, taken over the stretches where the arc is not done, metres.
    pub gap_m: f64,
    /// Largest distance from the shell to the scanned floor, metres.
    pub gap_max_m: f64,
}

/// The width of floor along the shell that a mission's tool cannot reach, with the reason, as the end of a sentence;
/// empty if the tool reaches the shell.
pub(crate) fn rim(mission: &MissionConfig) -> String {
    let (hull_m, room_m, swath_m) = (mission.limits.radius_m, mission.room_m(), mission.swath_m);
    let rim_m = room_m - swath_m / 2.0;
    if rim_m < LEAST_RIM_M {
        return String::new();
    }
    let clearance_m = room_m - hull_m;
    format!(
        "; the outer {rim_m:.2} m is unreachable: hull radius {hull_m:.2} m + clearance {clearance_m:.2} m \
         - half of the swath of {swath_m:.2} m"
    )
}

impl CriticalZone {
    /// Evaluates the zone from the scanned state of the shell; `plate_of` names the plate at a point on the wall.
    pub(crate) fn of(shell: &[ShellStretch], rim: &str, plate_of: impl Fn(Point) -> Option<String>) -> Self {
        let ShellFigures { length_m, done_m, scanned, gap_m } = ShellFigures::of(shell);
        let has_floor = length_m > 0.0;
        let done = has_floor && done_m >= CRITICAL_DONE * length_m;
        let why = match gap_m {
            _ if done => None,
            _ if !has_floor => Some("no free floor at the shell".to_owned()),
            _ if scanned <= 0.0 => Some("not scanned".to_owned()),
            gap_m => {
                let rest = if gap_m >= CRITICAL_ZONE_M - 1e-9 {
                    "the rest mostly unscanned".to_owned()
                } else {
                    format!("the rest scanned from {:.0} mm off the shell (median)", 1000.0 * gap_m)
                };
                Some(format!("full width along {done_m:.1} of {length_m:.1} m, {rest}{rim}"))
            }
        };
        let scanned = has_floor.then_some(scanned);
        let (plates, arcs) = (by_plate(shell, plate_of), arcs(shell));
        Self { width_m: CRITICAL_ZONE_M, length_m, done_m, scanned, gap_m, done, why, plates, arcs }
    }
}

fn by_plate(shell: &[ShellStretch], plate_of: impl Fn(Point) -> Option<String>) -> Vec<ZoneOfPlate> {
    let mut order: Vec<String> = Vec::new();
    let mut groups: BTreeMap<String, Vec<&ShellStretch>> = BTreeMap::new();
    for stretch in shell {
        let Some(plate) = plate_of(stretch.at) else { continue };
        if !groups.contains_key(&plate) {
            order.push(plate.clone());
        }
        groups.entry(plate).or_default().push(stretch);
    }
    let zone = |plate: String| {
        let ShellFigures { length_m, done_m, gap_m, .. } =
            ShellFigures::of(groups.get(&plate).into_iter().flatten().copied());
        ZoneOfPlate { plate, length_m, done_m, gap_m }
    };
    order.into_iter().map(zone).collect()
}

/// The arcs that are not done.
fn arcs(shell: &[ShellStretch]) -> Vec<ZoneArc> {
    let end_m = |stretch: &ShellStretch| stretch.along_m + stretch.length_m;
    let mut open: Vec<Vec<&ShellStretch>> = Vec::new();
    for stretch in shell.iter().filter(|stretch| stretch.gap_m.is_some()) {
        match open.last_mut() {
            Some(arc) if arc.last().is_some_and(|last| stretch.along_m - end_m(last) <= ARC_M) => {
                arc.push(stretch);
            }
            _ => open.push(vec![stretch]),
        }
    }
    // The end of the wall is its start.
    let total_m = shell.last().map_or(0.0, end_m);
    let is_over_the_end = |first: &[&ShellStretch], last: &[&ShellStretch]| {
        first[0].along_m + total_m - last.last().map_or(0.0, |stretch| end_m(stretch)) <= ARC_M
    };
    let mut over_m = None;
    if open.len() > 1 && is_over_the_end(&open[0], &open[open.len() - 1]) {
        let first = open.remove(0);
        over_m = first.last().map(|stretch| end_m(stretch) + total_m);
        open.last_mut().expect("at least two arcs remain").extend(first);
    }
    let last = open.len().saturating_sub(1);
    let arc = |(index, arc): (usize, Vec<&ShellStretch>)| {
        let (first, end) = (*arc.first()?, *arc.last()?);
        let figures = ShellFigures::of(arc.iter().copied());
        Some(ZoneArc {
            from_m: first.along_m,
            to_m: over_m.filter(|_| index == last).unwrap_or(end_m(end)),
            from: first.at,
            to: end.at,
            not_done_m: figures.length_m,
            gap_m: figures.gap_m,
            gap_max_m: arc.iter().filter_map(|stretch| stretch.gap_m).fold(0.0, f64::max),
        })
    };
    let arcs = open.into_iter().enumerate().filter_map(arc);
    arcs.filter(|arc| arc.to_m - arc.from_m >= ARC_M - 1e-9).collect()
}
