//! The floor shares, relative to the whole and to the reachable floor, and the critical zone along the shell.

use crate::model::{RunResult, Source};
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use account::Shares;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// The maximum missed share at which a plate counts as scanned except for slivers, per cent.
const MISSED_PERCENT: f64 = 1.0;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let block = look.block(Role::Border, "Coverage", "% by estimated position");
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let mut rows: Vec<Parts> = Vec::new();
    match &result.summary.floor {
        None => rows.push(vec![(Role::Dim, " Scanning was not part of this mission.".into())]),
        Some(account) => {
            rows.push(vec![(Role::Dim, head(columns))]);
            rows.push(vec![(Role::Text, shares("whole floor", &account.whole, columns))]);
            rows.push(vec![(Role::Text, shares("reachable floor", &account.reachable, columns))]);
            if let Some(Ok(all)) = &look.model.live.combined {
                rows.push(vec![(Role::Text, shares("whole, all runs", &all.whole, columns))]);
                rows.push(vec![(Role::Text, shares("reach., all runs", &all.reachable, columns))]);
            }
        }
    }
    // A note that does not fit would end in mid-sentence; all notes are in the report.
    for note in notes(look, result, columns) {
        if rows.len() + note.len() <= usize::from(block.inner(area).height) {
            rows.extend(note.into_iter().map(|line| vec![(Role::Text, format!(" {line}"))]));
        }
    }
    let lines: Vec<Line> = rows.into_iter().map(|parts| look.line(parts)).collect();
    fill(frame, area, block, lines);
}

/// Whether the areas and the unreachable floor fit.
fn is_wide(columns: usize) -> bool {
    columns >= 59
}

fn head(columns: usize) -> String {
    if is_wide(columns) {
        format!(" {:<16}{:>10}{:>8}{:>8}{:>8}{:>8}", "% of", "area", "scanned", "missed", "unrch.", "margin")
    } else {
        format!(" {:<17}{:>10}{:>8}", "% of", "scanned", "missed")
    }
}

fn shares(label: &str, shares: &Shares, columns: usize) -> String {
    let percent = |value: f64| text::number(value, 1);
    let Shares { area_m2, percent: p, .. } = shares;
    if is_wide(columns) {
        format!(
            " {label:<16}{:>10}{:>8}{:>8}{:>8}{:>8}",
            format!("{} m²", text::number(*area_m2, 1)),
            percent(p.scanned),
            percent(p.missed),
            percent(p.unreachable),
            percent(p.margin)
        )
    } else {
        format!(" {label:<17}{:>10}{:>8}", percent(p.scanned), percent(p.missed))
    }
}

/// Which runs are combined, or why they are not.
fn of_all_runs(look: &Look) -> Option<String> {
    let live = &look.model.live;
    let earlier = match &live.source {
        Some(Source::Rescan(earlier)) => earlier.as_slice(),
        _ => &[],
    };
    match &live.combined {
        Some(Ok(_)) => {
            let runs = if earlier.len() == 1 { "run" } else { "runs" };
            Some(format!(
                "All runs: this one and the {} {runs} before it; zone, plates and missed areas are for all \
                runs.",
                earlier.len()
            ))
        }
        Some(Err(why)) => Some(format!("This run alone; the runs cannot be combined: {why}.")),
        None if !earlier.is_empty() => {
            Some("This run alone; combining it with the runs before it...".to_owned())
        }
        None if live.not_requested_m2() > 0.0 => {
            Some("This run alone; `tankops report FIRST SECOND` combines runs.".to_owned())
        }
        None => None,
    }
}

/// The notes below the table, in lines.
fn notes(look: &Look, result: &RunResult, columns: usize) -> Vec<Vec<String>> {
    let summary = &result.summary;
    let overlap = summary.coverage.as_ref().and_then(|coverage| coverage.overlap);
    let again = overlap.map(|share| {
        format!("Overlap: {} % of the scanned floor was scanned more than once.", text::percent(share))
    });
    let truth =
        summary.coverage.as_ref().and_then(|coverage| coverage.by_truth).map(|truth| {
            format!("By true position: {} % of reachable floor.", text::percent(truth.reachable))
        });
    let zone = look.model.live.floor().map(|floor| {
        let zone = &floor.critical_zone;
        let width_mm = text::number(1000.0 * zone.width_m, 0);
        if zone.done {
            format!("Critical zone, {width_mm} mm along the shell: done.")
        } else {
            let (done_m, length_m) = (text::number(zone.done_m, 1), text::number(zone.length_m, 1));
            format!("Critical zone, {width_mm} mm along the shell: NOT done, full width on {done_m} of {length_m} m.")
        }
    });
    let broken = summary.violations.iter().flatten().map(|violation| format!("Not met: {violation}."));
    let plates = look.model.live.floor().filter(|floor| !floor.plates.is_empty()).map(|floor| {
        let all = floor.plates.iter().filter(|plate| plate.shares.percent.missed <= MISSED_PERCENT).count();
        format!("Plates: {all} of {} with at most {MISSED_PERCENT} % missed.", floor.plates.len())
    });
    let notes =
        of_all_runs(look).into_iter().chain(zone).chain(plates).chain(again).chain(truth).chain(broken);
    notes.map(|note| text::wrap(&note, columns)).collect()
}
