//! The requested floor that the plan leaves out, one line for each area with its reason.

use crate::model::Pane;
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts, fill};
use crate::view::{table, text};
use account::{Area, Cause, LeftOut, Measure, MissReason};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Width of an area, columns.
const AREA: usize = 8;
/// The most lines of the reason below the rows.
const MOST_ABOUT: usize = 3;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let left_out = look.model.live.left_out();
    let block = look.pane(
        Pane::LeftOut,
        &title(left_out, usize::from(area.width)),
        &keys(look, usize::from(area.width)),
    );
    let inner = block.inner(area);
    let size = (usize::from(inner.width), usize::from(inner.height));
    let Some(left_out) = left_out else {
        let words = match look.run.planning.plan {
            _ if look.run.is_survey() => "A survey leaves out what its tether and hull cannot reach.",
            _ if !look.run.covers() => "Not a scanning mission.",
            Some(_) => "Not known yet.",
            None => "No plan.",
        };
        let lines = text::wrap(words, size.0.saturating_sub(1)).into_iter();
        let lines = lines.map(|line| look.line([(Role::Dim, format!(" {line}"))])).collect();
        return fill(frame, area, block, lines);
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
    let about = about(left_out, selected, place, size);
    // The reason of the selected area takes the place of rows, of which one must stay. While no area is selected, it only
    // takes spare rows.
    let fits = selected.is_some() || rows.len() + about.len() <= size.1;
    let about = if fits { about } else { Vec::new() };
    let height = size.1.saturating_sub(about.len()).max(1);
    let spare = size.1.saturating_sub(rows.len().min(height) + about.len());
    table::place(look, inner, Rows::LeftOut, table::window(selected.unwrap_or(0), n_areas, height));
    let mut lines = table::rows(look, rows, selected, (size.0, height));
    if !about.is_empty() {
        lines.extend((spare > 0).then(Line::default));
        lines.extend(about.into_iter().map(|line| look.line([(Role::Dim, format!(" {line}"))])));
    }
    fill(frame, area, block, lines);
}

/// The reason of the selected area or, if none is selected, of the largest one, in lines below the rows; empty if the row
/// of the area shows the whole reason.
fn about(left_out: &LeftOut, selected: Option<usize>, place: usize, size: (usize, usize)) -> Vec<String> {
    let Some(area) = left_out.areas.get(selected.unwrap_or(0)) else { return Vec::new() };
    let [whole, ..] = reason(area.reason, &area.causes);
    let is_cut = AREA + 3 + place + text::width(&whole) > size.0;
    if !is_cut {
        return Vec::new();
    }
    let words = match selected {
        Some(_) => text::capitalized(&whole),
        None => format!("The largest: {whole}"),
    };
    let most = size.1.saturating_sub(1).min(MOST_ABOUT);
    text::first_lines(text::wrap(&format!("{words}."), size.0.saturating_sub(2)), most, size.0)
}

fn title(left_out: Option<&LeftOut>, columns: usize) -> String {
    let Some(left_out) = left_out else { return "Left out".into() };
    let share = text::percent(1.0 - left_out.scanned());
    let listed = match left_out.areas.len() {
        0 => String::new(),
        1 => ", 1 area".to_owned(),
        n => format!(", {n} areas"),
    };
    let area = format!("Left out  {share} %, {} m²", text::number(left_out.area_m2(), 2));
    // Beside the title: the frame, the key of the pane, and the mark of the focus.
    text::wording(
        [format!("{area}{listed}"), area, format!("Left out  {share} %")],
        columns.saturating_sub(10),
    )
}

fn keys(look: &Look, columns: usize) -> String {
    if look.model.ui.pane == Pane::LeftOut && columns >= 44 {
        look.keys("<accept>: on the map")
    } else {
        String::new()
    }
}

/// An area, its place in a column of the given width, and the reason.
fn row(area: &Area<MissReason>, place: usize, columns: usize) -> Parts {
    let room = columns.saturating_sub(AREA + 2);
    let place = text::column(&text::place(area.at), place);
    let [whole, brief, word] = reason(area.reason, &area.causes);
    let [whole, brief, word] = [whole, brief, word].map(|reason| format!("{place} {reason}"));
    // A reason that does not fit into its row is shown below the rows.
    let words = text::wording([whole, brief, word, place], room);
    vec![(Role::Text, format!("{:>AREA$} ", square_metres(area.area_m2))), (Role::Text, words)]
}

/// The reason, from the longest wording to the shortest. The title says that the floor is left out.
fn reason(reason: MissReason, causes: &[Cause<MissReason>]) -> [String; 3] {
    let measure = causes.iter().find(|cause| cause.reason == reason).and_then(|cause| cause.measure.as_ref());
    let words: [&str; 3] = match reason {
        MissReason::NotPlanned => return beside_lanes(measure),
        MissReason::Clearance => {
            ["too little room for hull and clearance", "no room for hull and clearance", "no room for hull"]
        }
        MissReason::NoLaneBeside => return along(measure),
        MissReason::Wrap => ["a lane here would wind the tether", "would wind the tether", "tether"],
        MissReason::BeyondReel => ["beyond the reach of the tether", "beyond the tether", "beyond tether"],
        MissReason::Narrow => ["outside the outermost lane", "outside the lanes", "outside lanes"],
        reason => [reason.plainly(), reason.briefly(), reason.briefly()],
    };
    words.map(str::to_owned)
}

/// Why floor beside a solid object is left out although the robot has room there.
fn along(measure: Option<&Measure>) -> [String; 3] {
    let near = measure.and_then(|measure| measure.near.as_deref()).unwrap_or("the solid object");
    [
        format!("no lane of this planner runs along {near} here"),
        format!("no lane along {near}"),
        "no lane".into(),
    ]
}

/// Why floor between or beside the lanes is left out: too narrow for a lane of its own, or the planner puts no lane
/// there.
fn beside_lanes(measure: Option<&Measure>) -> [String; 3] {
    let Some(measure) = measure else {
        return ["the planner puts no lane here", "no lane here", "no lane"].map(str::to_owned);
    };
    let wide_m = text::number(measure.value_m, 2);
    if measure.limit_m.is_some_and(|lane_m| measure.value_m < lane_m / 2.0) {
        let gap = format!("{wide_m} m outside the lane");
        return [format!("{gap}, too narrow for its own"), gap, "outside the lane".into()];
    }
    let far = format!("no lane within {wide_m} m");
    [format!("the planner puts {far}"), far, "no lane".into()]
}

/// The areas that are too small to be listed, with the reason for most of them.
fn smaller(left_out: &LeftOut, columns: usize) -> Option<Parts> {
    let slivers = &left_out.slivers;
    let counted = format!("{} smaller", slivers.count);
    let room = columns.saturating_sub(AREA + 2);
    let words = match slivers.causes.first() {
        Some(cause) => {
            let [whole, brief, word] =
                reason(cause.reason, &slivers.causes).map(|why| format!("{counted}, most: {why}"));
            text::wording([whole, brief, word, counted], room)
        }
        None => text::wording([format!("in {counted} areas"), counted], room),
    };
    (slivers.count > 0)
        .then(|| vec![(Role::Dim, format!("{:>AREA$} ", square_metres(slivers.area_m2))), (Role::Dim, words)])
}

fn square_metres(area_m2: f64) -> String {
    format!("{} m²", text::number(area_m2, 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_without_a_lane_says_whether_it_is_too_narrow_for_one() {
        let measure = |value_m| Measure { value_m, to_m: None, limit_m: Some(0.5), near: None };
        assert_eq!(beside_lanes(Some(&measure(0.08)))[1], "0.08 m outside the lane");
        assert_eq!(beside_lanes(Some(&measure(2.3)))[0], "the planner puts no lane within 2.30 m");
        assert_eq!(beside_lanes(None)[2], "no lane");
    }
}
