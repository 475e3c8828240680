//! The requested floor that the plan leaves out, one line for each area with its reason.

use crate::model::Pane;
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts, fill};
use crate::view::{table, text};
use account::{Area, LeftOut, MissReason};
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of an area, columns.
const AREA: usize = 8;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let left_out = look.model.live.left_out();
    let block = look.pane(Pane::LeftOut, &title(left_out), &keys(look, usize::from(area.width)));
    let inner = block.inner(area);
    let size = (usize::from(inner.width), usize::from(inner.height));
    let Some(left_out) = left_out else {
        let words = match look.run.planning.plan {
            _ if !look.run.covers() => "Not a scanning mission.",
            Some(_) => "Not known yet.",
            None => "No plan.",
        };
        return fill(frame, area, block, vec![look.line([(Role::Dim, format!(" {words}"))])]);
    };
    let place = left_out.areas.iter().map(|area| text::width(&text::place(area.at))).max().unwrap_or(0);
    let mut rows: Vec<Parts> = left_out.areas.iter().map(|area| row(area, place, size.0)).collect();
    let n_areas = rows.len();
    rows.extend(smaller(left_out, size.0));
    if rows.is_empty() {
        return fill(frame, area, block, vec![look.line([(Role::Good, " Nothing.".into())])]);
    }
    let is_focused = look.model.ui.pane == Pane::LeftOut;
    let selected = is_focused.then(|| look.model.ui.left_out.min(n_areas.saturating_sub(1)));
    table::place(look, inner, Rows::LeftOut, table::window(selected.unwrap_or(0), n_areas, size.1));
    fill(frame, area, block, table::rows(look, rows, selected, size));
}

fn title(left_out: Option<&LeftOut>) -> String {
    let Some(left_out) = left_out else { return "Left out".into() };
    let share = text::percent(1.0 - left_out.scanned());
    let listed = match left_out.areas.len() {
        0 => String::new(),
        1 => ", 1 area".to_owned(),
        n => format!(", {n} areas"),
    };
    format!("Left out  {share} %, {} m²{listed}", text::number(left_out.area_m2(), 2))
}

fn keys(look: &Look, columns: usize) -> String {
    if look.model.ui.pane == Pane::LeftOut && columns >= 44 {
        look.keys("<accept>: on the map")
    } else {
        String::new()
    }
}

/// An area, its place in a column of a width, and the reason.
fn row(area: &Area<MissReason>, place: usize, columns: usize) -> Parts {
    let room = columns.saturating_sub(AREA + 2);
    let place = text::column(&text::place(area.at), place);
    let [whole, brief, word] = [area.reason.plainly(), area.reason.briefly(), in_a_word(area.reason)];
    let words = [whole, brief, word].map(|reason| format!("{place} {reason}"));
    let [whole, brief, short] = words;
    let words = text::wording([whole, brief, short, word.to_owned()], room);
    vec![(Role::Text, format!("{:>AREA$} ", square_metres(area.area_m2))), (Role::Text, words)]
}

/// The reason in a word or two, below the title that says that the area is left out.
fn in_a_word(reason: MissReason) -> &'static str {
    match reason {
        MissReason::Clearance => "clearance",
        MissReason::Wrap => "tether",
        MissReason::BeyondReel => "beyond the reel",
        MissReason::Narrow => "outside lanes",
        reason => reason.briefly(),
    }
}

fn smaller(left_out: &LeftOut, columns: usize) -> Option<Parts> {
    let slivers = &left_out.slivers;
    let words = [format!("in {} smaller areas", slivers.count), format!("{} smaller", slivers.count)];
    (slivers.count > 0).then(|| {
        vec![
            (Role::Dim, format!("{:>AREA$} ", square_metres(slivers.area_m2))),
            (Role::Dim, text::wording(words, columns.saturating_sub(AREA + 2))),
        ]
    })
}

fn square_metres(area_m2: f64) -> String {
    format!("{} m²", text::number(area_m2, 2))
}
