//! The panes of the mission screen for a given terminal size, and their positions.
//!
//! Every pane has a rank, and a minimum and a preferred number of rows. If space is short, the highest-ranked panes get
//! their minimum; the remaining rows then go one by one, in order of rank, to the panes that prefer more.

use crate::model::{
    Pane, Run,
    ui::{Arrangement, Chart},
};
use ratatui::layout::{Constraint, Layout, Rect};

/// Minimum and maximum width of a stack of panes, columns.
const STACK: (u16, u16) = (30, 50);
/// Width of the panes beside the map on the plan screen, columns: the minimum on a narrow and on a wide screen, and the
/// maximum.
const PLAN_SIDE: (u16, u16, u16) = (34, 50, 80);
/// Width of the map, in columns, for a given number of floor rows: the round tank, its legend and the frame.
const MAP: (u16, u16) = (2, 22);
/// The minimum number of rows beside the map at which a single stack has a table of the stations.
const TABLE_ROWS: u16 = 32;
/// The minimum number of rows at which the plan screen has room for a curve.
const TALL: u16 = 45;
/// Rows of the map that show no floor: the frame and the readout.
const MAP_FRAME: u16 = 3;

/// The rows that a pane requests, including its frame. Panes earlier in a list rank higher.
struct Wish {
    pane: Pane,
    least: u16,
    rows: u16,
}

const fn wish(pane: Pane, least: u16, rows: u16) -> Wish {
    Wish { pane, least, rows }
}

/// The rows, with the frame, that panes of the plan screen need in the width of the column beside the map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlanRows {
    /// The state of the plan.
    pub state: u16,
    /// The checks that fail, warn or are not ticked; 0 if every check passed.
    pub checks: u16,
}

/// What chooses the ways of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ways {
    /// A planner.
    Planner,
    /// The mission itself, a survey: its pane lists what it has found.
    Survey,
}

/// What the layout must show in addition to the panes that every mission has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shown {
    /// Whether there is a tether.
    pub tether: bool,
    /// Whether the reel of the tether is described, so that there are pulls to show.
    pub reel: bool,
    /// Whether the missed areas are known.
    pub missed: bool,
    /// The number of AE stations.
    pub stations: u16,
    /// What chooses the ways of the robot.
    pub ways: Ways,
    /// The table of the stations, the tether or the survey, if the operator has turned to it; it then takes the place of
    /// other panes.
    pub turned: Option<Pane>,
}

impl Shown {
    /// What the layout must show for a run.
    pub(crate) fn of(run: &Run, missed: bool) -> Self {
        let stations = run.about.as_ref().map_or(0, |about| about.world.stations.len() as u16);
        Self {
            tether: run.tether.is_some(),
            reel: run.reel().is_some(),
            missed,
            stations,
            ways: if run.is_survey() { Ways::Survey } else { Ways::Planner },
            turned: None,
        }
    }
}

/// The panes of the mission screen and their areas, for a terminal of `size`; empty for a terminal that shows one
/// page at a time.
pub(crate) fn mission(area: Rect, (width, height): (u16, u16), shown: Shown) -> Vec<(Pane, Rect)> {
    let arrangement = Arrangement::of(width, height);
    if !matches!(arrangement, Arrangement::Wide | Arrangement::Narrow) {
        return Vec::new();
    }
    let n_stacks = if width >= 160 && height >= 45 { 2 } else { 1 };
    let events = match (arrangement, height) {
        // The panes beside the map come before the second event.
        (Arrangement::Narrow, ..25) => 3,
        (Arrangement::Narrow, _) => 4,
        (_, 45..) => 12,
        _ => 6,
    };
    let [middle, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(events)]).areas(area);
    let floor_rows = middle.height.saturating_sub(MAP_FRAME);
    let side = width.saturating_sub(MAP.0 * floor_rows + MAP.1).clamp(n_stacks * STACK.0, n_stacks * STACK.1);
    let turned = shown.turned.filter(|pane| match pane {
        Pane::Stations => shown.stations > 0,
        Pane::Coverage => shown.ways == Ways::Survey,
        _ => true,
    });
    let turned = turned.filter(|_| n_stacks == 1);
    let side = if turned.is_some() { side.max(STACK.1) } else { side };
    let [map, side] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(middle);
    let has_alarms_below = n_stacks == 2 && width >= 200 && height >= 60;
    let mut placed = vec![(Pane::Map, map)];
    if n_stacks == 1 {
        let mut wishes = first(shown, arrangement == Arrangement::Wide);
        // A shorter screen names the stations in a row of the position pane.
        let has_table = width >= 100 && side.height >= TABLE_ROWS && shown.stations > 0;
        let table = wish(Pane::Stations, 6, 2 * shown.stations + 3);
        let tether = wish(Pane::Tether, 9, 12);
        let survey = wish(Pane::Coverage, 9, side.height);
        if has_table {
            wishes.push(wish(Pane::Stations, 6, shown.stations + 3));
        } else if let Some(turned) = turned {
            let is_kept = |pane| match (arrangement, turned) {
                (Arrangement::Narrow, _) | (_, Pane::Coverage) => pane == Pane::Position,
                _ => matches!(pane, Pane::Position | Pane::Tether),
            };
            wishes.retain(|wish| is_kept(wish.pane));
            let turned = match turned {
                Pane::Tether => tether,
                Pane::Coverage => survey,
                _ => table,
            };
            wishes.insert(1.min(wishes.len()), turned);
        }
        placed.extend(stack(side, &wishes));
    } else {
        let [one, two] = Layout::horizontal([Constraint::Fill(1); 2]).areas(side);
        let mut wishes = first(shown, true);
        wishes.extend((shown.stations > 0).then_some(chart(Chart::Residual)));
        placed.extend(stack(one, &wishes));
        placed.extend(stack(two, &second(shown, !has_alarms_below)));
    }
    if has_alarms_below {
        let [events, alarms] =
            Layout::horizontal([Constraint::Length(map.width), Constraint::Fill(1)]).areas(below);
        placed.extend([(Pane::Events, events), (Pane::Alarms, alarms)]);
    } else {
        placed.push((Pane::Events, below));
    }
    placed
}

/// The panes of the plan screen and their areas. On a small screen the panes beside the map, or all panes, are shown
/// one at a time; `pane` is the one that responds to keys. `rows` gives the rows that the state of the plan needs in a given
/// width, with its frame: a reason why the plan is refused must be legible, so it comes first.
pub(crate) fn plan(
    area: Rect,
    (width, height): (u16, u16),
    pane: Pane,
    rows: &dyn Fn(u16) -> PlanRows,
) -> Vec<(Pane, Rect)> {
    let arrangement = Arrangement::of(width, height);
    if arrangement == Arrangement::Paged {
        return match pane {
            Pane::Promise => stack(area, &[wish(Pane::Promise, 10, 12), wish(Pane::Plan, 3, 20)]),
            Pane::LeftOut | Pane::Parameters | Pane::Checks => vec![(pane, area)],
            _ => vec![(Pane::Map, area)],
        };
    }
    let floor_rows = area.height.saturating_sub(MAP_FRAME);
    let side = width.saturating_sub(MAP.0 * floor_rows + MAP.1).min(PLAN_SIDE.2);
    let side = side.max(if arrangement == Arrangement::Wide { PLAN_SIDE.1 } else { PLAN_SIDE.0 });
    let [map, side] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(area);
    let mut placed = vec![(Pane::Map, map)];
    // On a tall screen, a curve is shown below the figures.
    let promise = wish(Pane::Promise, 10, if area.height >= TALL { area.height } else { 12 });
    let needed = rows(side.width);
    let is_narrow = arrangement == Arrangement::Narrow;
    // What fails or warns has a row for its reason, too.
    let checks = match (needed.checks, is_narrow) {
        (0, true) => wish(Pane::Checks, 3, 5),
        (0, false) if area.height >= TALL => wish(Pane::Checks, 4, 5),
        (0, false) => wish(Pane::Checks, 4, 8),
        (bad, true) => wish(Pane::Checks, bad.min(7), bad.min(7)),
        (bad, false) => wish(Pane::Checks, bad.clamp(4, 7), bad.max(5)),
    };
    let kept = promise.least + if needed.checks > 0 && is_narrow { checks.least } else { 0 };
    let state = needed.state.clamp(5, area.height.saturating_sub(kept).max(5));
    let state = wish(Pane::Plan, state, state.max(6));
    if is_narrow {
        placed.extend(match pane {
            Pane::LeftOut | Pane::Checks | Pane::Parameters => {
                stack(side, &[wish(pane, 8, side.height), wish(Pane::Plan, 5, 6)])
            }
            _ if needed.checks > 0 => stack(side, &[state, checks, Wish { least: 6, ..promise }]),
            _ => stack(side, &[state, promise, checks]),
        });
        return placed;
    }
    let (left_out, parameters) = if area.height >= TALL {
        // The curve gets what the lists do not need.
        (wish(Pane::LeftOut, 4, 10), wish(Pane::Parameters, 3, 10))
    } else {
        (wish(Pane::LeftOut, 4, 12), wish(Pane::Parameters, 3, 14))
    };
    placed.extend(stack(side, &[state, promise, checks, left_out, parameters]));
    placed
}

/// The panes on a page of a small screen.
pub(crate) fn page(area: Rect, pane: Pane, shown: Shown) -> Vec<(Pane, Rect)> {
    match pane {
        Pane::Planner if shown.tether => {
            let rows = if shown.reel { 9 } else { 6 };
            stack(area, &[wish(Pane::Tether, 5, rows), wish(Pane::Planner, 4, 20)])
        }
        pane => vec![(pane, area)],
    }
}

/// The panes beside the map. The panes about conditions that can end a mission come first.
fn first(shown: Shown, wide: bool) -> Vec<Wish> {
    let rows = |full: u16, short: u16| if wide { full } else { short };
    let (least, most) = if shown.reel { (rows(6, 5), rows(12, 7)) } else { (5, rows(10, 6)) };
    let tether = shown.tether.then_some(wish(Pane::Tether, least, most));
    let (planner, coverage) = (wish(Pane::Planner, 4, rows(9, 6)), wish(Pane::Coverage, 4, rows(10, 6)));
    let mut panes: Vec<Wish> = [wish(Pane::Position, 4, rows(8, 5))].into_iter().chain(tether).collect();
    if shown.ways == Ways::Survey {
        // No planner drives, and what the survey has found is its result.
        panes.insert(1, wish(Pane::Coverage, rows(6, 4), rows(20, 6)));
        panes.push(planner);
    } else {
        panes.extend([planner, coverage]);
    }
    panes
}

/// A chart.
const fn chart(chart: Chart) -> Wish {
    wish(Pane::Chart(chart), 6, 10)
}

/// The panes in the second stack.
fn second(shown: Shown, alarms: bool) -> Vec<Wish> {
    let tether = [chart(Chart::TetherOut), chart(Chart::Wrap)];
    let alarms = alarms.then_some(wish(Pane::Alarms, 5, 8));
    // On the largest screens, each station has a curve below its row.
    let (rows, rows_with_curves) = (shown.stations + 3, 2 * shown.stations + 3);
    let least = if alarms.is_some() { rows.min(9) } else { rows_with_curves.min(15) };
    let stations = (shown.stations > 0).then(|| wish(Pane::Stations, least, rows_with_curves));
    let missed = shown.missed.then_some(wish(Pane::Missed, 5, 10));
    let tether = tether.into_iter().filter(|_| shown.tether);
    alarms
        .into_iter()
        .chain(missed)
        .chain([chart(Chart::Error)])
        .chain(stations)
        .chain(tether)
        .chain([chart(Chart::Scanned)])
        .collect()
}

/// Stacks panes vertically in the operator's reading order. The highest-ranked panes are always placed.
fn stack(area: Rect, wishes: &[Wish]) -> Vec<(Pane, Rect)> {
    let mut taken: Vec<(&Wish, u16)> = Vec::new();
    let mut left = area.height;
    for wish in wishes {
        if wish.least <= left || taken.is_empty() {
            let rows = wish.least.min(left);
            taken.push((wish, rows));
            left -= rows;
        }
    }
    while left > 0 && taken.iter().any(|(wish, rows)| *rows < wish.rows) {
        for (wish, rows) in &mut taken {
            if left > 0 && *rows < wish.rows {
                *rows += 1;
                left -= 1;
            }
        }
    }
    taken.sort_by_key(|(wish, _)| order(wish.pane));
    // Rows that no pane requests go to the last pane.
    if let Some((_, rows)) = taken.last_mut() {
        *rows += left;
    }
    let mut y = area.y;
    let place = |(wish, height): (&Wish, u16)| {
        let place = Rect { y, height, ..area };
        y += height;
        (wish.pane, place)
    };
    taken.into_iter().map(place).collect()
}

/// The position of a pane in the stack, from top to bottom.
fn order(pane: Pane) -> usize {
    const ORDER: [Pane; 18] = [
        Pane::Map,
        Pane::Plan,
        Pane::Promise,
        Pane::LeftOut,
        Pane::Parameters,
        Pane::Checks,
        Pane::Coverage,
        Pane::Position,
        Pane::Tether,
        Pane::Planner,
        Pane::Alarms,
        Pane::Missed,
        Pane::Stations,
        Pane::Chart(Chart::Error),
        Pane::Chart(Chart::Residual),
        Pane::Chart(Chart::TetherOut),
        Pane::Chart(Chart::Wrap),
        Pane::Chart(Chart::Scanned),
    ];
    ORDER.iter().position(|other| *other == pane).unwrap_or(ORDER.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(width: u16, height: u16, shown: Shown) -> Vec<(Pane, Rect)> {
        mission(Rect::new(0, 2, width, height.saturating_sub(4)), (width, height), shown)
    }

    fn every_shown() -> impl Iterator<Item = Shown> {
        [(false, false), (true, false), (false, true), (true, true)]
            .into_iter()
            .flat_map(|parts| [(parts, Ways::Planner), (parts, Ways::Survey)])
            .map(|((tether, missed), ways)| Shown {
                tether,
                reel: tether,
                missed,
                stations: 6,
                ways,
                turned: None,
            })
    }

    #[test]
    fn panes_fill_the_screen_without_overlap_and_those_beside_the_map_never_vanish() {
        for (width, height) in (80..=300).step_by(5).flat_map(|w| (24..=100).map(move |h| (w, h))) {
            for shown in every_shown() {
                let placed = placed(width, height, shown);
                let area: u32 = placed.iter().map(|(_, place)| place.area()).sum();
                assert_eq!(area, u32::from(width) * u32::from(height - 4), "{width}x{height} {placed:?}");
                let apart = |one: &Rect, other: &Rect| !one.intersects(*other);
                for (index, (_, one)) in placed.iter().enumerate() {
                    assert!(placed[index + 1..].iter().all(|(_, other)| apart(one, other)), "{placed:?}");
                }
                let needed = [Pane::Map, Pane::Coverage, Pane::Position, Pane::Planner, Pane::Events];
                for pane in needed.into_iter().chain(shown.tether.then_some(Pane::Tether)) {
                    assert!(placed.iter().any(|(other, _)| *other == pane), "{pane:?} at {width}x{height}");
                }
            }
        }
    }

    #[test]
    fn large_screens_have_two_stacks_ten_events_and_charts() {
        let shown = Shown {
            tether: true,
            reel: false,
            missed: false,
            stations: 6,
            ways: Ways::Planner,
            turned: None,
        };
        let place = |size: (u16, u16), pane| {
            placed(size.0, size.1, shown)
                .into_iter()
                .find(|(other, _)| *other == pane)
                .map(|(_, place)| place)
        };
        assert_eq!(place((80, 24), Pane::Map).map(|map| map.width), Some(50));
        assert_eq!(place((120, 36), Pane::Map).map(|map| map.width), Some(70));
        assert_eq!(place((120, 36), Pane::Alarms), None);
        let [events, alarms] = [Pane::Events, Pane::Alarms].map(|pane| place((160, 45), pane));
        assert_eq!(events.map(|events| events.height), Some(12));
        assert!(alarms.is_some_and(|alarms| alarms.x > 80 && alarms.y < 10));
        assert!(place((160, 45), Pane::Chart(Chart::Error)).is_some());
        let alarms = place((200, 60), Pane::Alarms);
        assert!(alarms.is_some_and(|alarms| alarms.height == 12 && alarms.bottom() == 58));
        assert!(place((200, 60), Pane::Chart(Chart::Scanned)).is_some());
        // A heading, two rows for each station, and the frame.
        assert!(place((200, 60), Pane::Stations).is_some_and(|stations| stations.height >= 15));
    }

    #[test]
    fn the_pane_of_a_survey_gets_the_rows_of_the_others_if_the_operator_turns_to_it() {
        let shown = |turned| Shown { turned, ..every_shown().last().expect("four kinds of missions") };
        let rows = |size: (u16, u16), shown: Shown| {
            let placed = placed(size.0, size.1, shown);
            placed.into_iter().find(|(pane, _)| *pane == Pane::Coverage).map_or(0, |(_, area)| area.height)
        };
        for size in [(120, 36), (80, 24)] {
            let (before, turned) = (rows(size, shown(None)), rows(size, shown(Some(Pane::Coverage))));
            assert!(before >= 4 && turned >= before + 6, "{size:?}: {before} {turned}");
            let scan = Shown { ways: Ways::Planner, ..shown(Some(Pane::Coverage)) };
            assert_eq!(placed(size.0, size.1, scan), placed(size.0, size.1, Shown { turned: None, ..scan }));
        }
    }
}
