//! What a large screen shows about a past run beside its figures: the missed areas, the plates, the last minutes of its
//! figures as curves, and its last events.

use super::charts::{self, Series};
use super::look::{Look, Parts, fill};
use super::missed::{brief, briefest};
use super::result::plates;
use super::text;
use crate::model::log::severity_word;
use crate::model::{Entry, Glimpse, Run};
use crate::theme::Role;
use account::{Account, Area, MissReason};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Minimum rows of a pane, including the frame.
const PANE: u16 = 6;
/// Rows of the frame and the heading of a table.
const FRAME: u16 = 3;
/// Maximum rows of a curve beside events, including the frame.
const CURVE: u16 = 12;
/// Curves beside each other.
const ABREAST: usize = 2;

/// Draws the details; `with_events` if no other pane shows the events of the run.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, glimpse: &Glimpse, with_events: bool) {
    let own = || glimpse.summary.as_ref().and_then(|summary| summary.floor.as_ref());
    let floor = glimpse.together().map(|all| &all.floor).or_else(own);
    let rows = |listed: usize| {
        let wanted = u16::try_from(listed).unwrap_or(u16::MAX).saturating_add(FRAME);
        if listed == 0 { 0 } else { wanted.min(area.height / 3).max(PANE) }
    };
    let rows = floor.map_or([0, 0], |floor| [rows(floor.listed().len().max(1)), rows(floor.plates.len())]);
    let [above, middle, below] =
        Layout::vertical([Constraint::Length(rows[0]), Constraint::Length(rows[1]), Constraint::Fill(1)])
            .areas(area);
    if let Some(floor) = floor {
        missed(look, frame, above, floor);
        if middle.height > FRAME {
            plates::list(look, frame, middle, floor, None);
        }
    }
    let lines = glimpse.events.len().min(usize::from(u16::MAX)) as u16;
    let wanted = if with_events && lines > 0 { (lines + 2).clamp(PANE, below.height.max(PANE)) } else { 0 };
    let all = all_series(&glimpse.run);
    let curve_rows = all.len().div_ceil(ABREAST) as u16;
    // The curves keep their usual height; events get the rest.
    let kept = (curve_rows * CURVE).min(below.height.saturating_sub(PANE));
    let events_rows = if wanted > 0 { wanted.min(below.height.saturating_sub(kept)) } else { 0 };
    let events_rows = if events_rows < PANE { 0 } else { events_rows };
    let [curves_area, events_area] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(events_rows)]).areas(below);
    curves(look, frame, curves_area, &all);
    if events_rows > 0 {
        events(look, frame, events_area, glimpse);
    }
}

/// The last events of a run, newest first.
pub(super) fn events(look: &Look, frame: &mut Frame, area: Rect, glimpse: &Glimpse) {
    let inner = look.block(Role::Border, "", "").inner(area);
    let rows = usize::from(inner.height);
    let mut lines = Vec::new();
    let mut shown = 0;
    for entry in &glimpse.events {
        let more = event(entry, usize::from(inner.width));
        if lines.len() + more.len() > rows {
            break;
        }
        lines.extend(more.into_iter().map(|parts| look.line(parts)));
        shown += 1;
    }
    let title = format!("Last events of this run  {shown}");
    fill(frame, area, look.block(Role::Border, &title, "newest first"), lines);
}

/// An event with its whole text: no other pane shows it.
fn event(entry: &Entry, columns: usize) -> Vec<Parts> {
    let front: Parts = vec![
        (Role::Dim, format!(" T+{} ", text::clock(entry.t_s))),
        (super::events::role(entry.severity), format!("{:<5}", severity_word(entry.severity))),
        (Role::Dim, format!(" {}", text::column(&entry.source, 8))),
    ];
    let indent = front.iter().map(|(_, words)| text::width(words)).sum();
    let lines = text::wrap(&entry.text, columns.saturating_sub(indent)).into_iter().enumerate();
    lines
        .map(|(line, words)| {
            let front = if line == 0 { front.clone() } else { vec![(Role::Dim, " ".repeat(indent))] };
            [front, vec![(Role::Text, words)]].concat()
        })
        .collect()
}

/// The curves in rows, as many rows as fit.
fn curves(look: &Look, frame: &mut Frame, area: Rect, all: &[Series]) {
    let rows = (area.height / PANE).min(all.len().div_ceil(ABREAST) as u16);
    let areas = Layout::vertical((0..rows).map(|_| Constraint::Fill(1))).split(area);
    for (series, area) in all.chunks(ABREAST).zip(areas.iter()) {
        let areas = Layout::horizontal(series.iter().map(|_| Constraint::Fill(1))).split(*area);
        for (series, area) in series.iter().zip(areas.iter()) {
            charts::figure(look, frame, *area, series);
        }
    }
}

/// The figures of a run as curves: the scan, if the task was to scan, the position error, and the tether.
fn all_series(run: &Run) -> Vec<Series<'_>> {
    let limits =
        run.about.as_ref().and_then(|about| about.mission.tether.as_ref()).map(|tether| tether.limits);
    let of_tether = run.tether.iter().flat_map(|tether| {
        [
            Series {
                title: "Tether out, m",
                values: &tether.length_history_m,
                now: Some(tether.length_m),
                limit: limits.map(|limits| limits.reel_length_m),
                decimals: 1,
            },
            Series {
                title: "Largest wrap, °",
                values: &tether.wrap_history_deg,
                now: Some(tether.largest_deg()),
                limit: limits.map(|limits| limits.wrap_max_rad.to_degrees()),
                decimals: 0,
            },
        ]
    });
    scanned(run).into_iter().chain([error(run)]).chain(of_tether).collect()
}

fn scanned(run: &Run) -> Option<Series<'_>> {
    run.covers().then_some(Series {
        title: "Scanned, % of reachable",
        values: &run.scanned_history,
        now: None,
        limit: None,
        decimals: 1,
    })
}

fn error(run: &Run) -> Series<'_> {
    Series {
        title: "95 % error, m",
        values: &run.position.history_m,
        now: run.position.error_m(),
        limit: run.about.as_ref().map(|about| about.mission.position_limit_m),
        decimals: 2,
    }
}

fn missed(look: &Look, frame: &mut Frame, area: Rect, floor: &Account) {
    let listed: Vec<&Area<MissReason>> = floor.listed();
    let inner = look.block(Role::Border, "", "").inner(area);
    let columns = usize::from(inner.width);
    let shown = listed.len().min(usize::from(inner.height));
    let title = match listed.len() - shown {
        0 => format!("Missed areas  {shown}"),
        _ => format!("Missed areas  {shown} of {}", listed.len()),
    };
    let mut rows: Vec<Parts> =
        listed.into_iter().take(shown).enumerate().map(|(index, area)| row(index, area, columns)).collect();
    if rows.is_empty() {
        rows.push(vec![(Role::Good, " None.".into())]);
    }
    let lines = rows.into_iter().map(|parts| look.line(parts)).collect();
    fill(frame, area, look.block(Role::Border, &title, ""), lines);
}

fn row(index: usize, area: &Area<MissReason>, columns: usize) -> Parts {
    let area_m2 = text::number(area.area_m2, 2);
    let place = format!("{:>3} {:>7} m² {:>15}  ", index + 1, area_m2, text::place(area.at));
    let room = columns.saturating_sub(text::width(&place));
    vec![(Role::Dim, place), (Role::Text, text::wording([area.why(), brief(area), briefest(area)], room))]
}
