//! What a large screen shows about a past run beside its figures: the missed areas, the plates, and the last minutes of the
//! scan and of the position error as curves.

use super::charts::{self, Series};
use super::look::{Look, Parts, fill};
use super::missed::{brief, briefest};
use super::result::plates;
use super::text;
use crate::model::{Glimpse, Run};
use crate::theme::Role;
use account::{Account, Area, MissReason};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Minimum rows of a pane, including the frame.
const PANE: u16 = 6;
/// Rows of the frame and the heading of a table.
const FRAME: u16 = 3;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, glimpse: &Glimpse) {
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
    curves(look, frame, below, &glimpse.run);
}

/// The last minutes of the scan, if the task was to scan, and of the position error.
fn curves(look: &Look, frame: &mut Frame, area: Rect, run: &Run) {
    if area.height < PANE {
        return;
    }
    let shown: Vec<Series> = scanned(run).into_iter().chain([error(run)]).collect();
    let areas = Layout::horizontal(shown.iter().map(|_| Constraint::Fill(1))).split(area);
    for (series, area) in shown.iter().zip(areas.iter()) {
        charts::figure(look, frame, *area, series);
    }
}

fn scanned(run: &Run) -> Option<Series<'_>> {
    run.covers().then_some(Series {
        title: "Scanned, % of reachable",
        values: &run.scanned_history,
        limit: None,
        decimals: 1,
    })
}

fn error(run: &Run) -> Series<'_> {
    Series {
        title: "95 % error, m",
        values: &run.position.history_m,
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
