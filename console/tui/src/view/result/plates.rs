//! The plates with their shares and the accuracy of the position on each, worst first.

use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use account::{Account, PlateAccount};
use ratatui::Frame;
use ratatui::layout::Rect;

pub(in crate::view) fn draw(look: &Look, frame: &mut Frame, area: Rect, floor: &Account) {
    let mut plates: Vec<&PlateAccount> = floor.plates.iter().collect();
    plates.sort_by(|one, other| other.shares.missed.total_cmp(&one.shares.missed));
    let inner = look.block(Role::Border, "", "").inner(area);
    // One row is for the headings.
    let shown = usize::from(inner.height).saturating_sub(1).min(plates.len());
    let hidden = plates.len() - shown;
    let title = match hidden {
        0 => format!("Plates  {}", plates.len()),
        _ => format!("Plates  {shown} of {}, most missed first", plates.len()),
    };
    let limit = text::number(floor.position_limit_m, 2);
    let block = look.block(Role::Border, &format!("{title}; limit of the 95 % error {limit} m"), "");
    let head = format!(
        " {:<12}{:>10}{:>10}{:>9}{:>14}{:>14}",
        "plate", "area", "scanned", "missed", "error p95", "error worst"
    );
    let mut rows: Vec<Parts> = vec![vec![(Role::Dim, head)]];
    rows.extend(plates.into_iter().take(shown).map(|plate| row(plate, floor.position_limit_m)));
    let lines = rows.into_iter().map(|parts| look.line(parts)).collect();
    fill(frame, area, block, lines);
}

/// The plate on which the position was least accurate, in one line; `None` if no plate has a figure.
pub(super) fn worst(look: &Look, columns: usize) -> Option<Parts> {
    let floor = look.model.live.floor()?;
    let figures = floor.plates.iter().filter_map(|plate| Some((plate.error_max_m?, plate)));
    let (error_m, plate) = figures.max_by(|one, other| one.0.total_cmp(&other.0))?;
    let limit_m = floor.position_limit_m;
    let (role, mark) = if error_m > limit_m { (Role::Warn, "!") } else { (Role::Text, "") };
    let (error, limit) = (text::number(error_m, 2), text::number(limit_m, 2));
    let front = format!("Worst plate {}: ", plate.name);
    let words = [
        format!("95 % error {error} m{mark}, limit {limit} m"),
        format!("95 % error {error} m{mark}"),
        format!("error {error} m{mark}"),
        format!("{error} m{mark}"),
    ];
    let room = columns.saturating_sub(text::width(&front) + 2);
    Some(vec![(Role::Dim, format!(" {front}")), (role, text::wording(words, room))])
}

fn row(plate: &PlateAccount, limit_m: f64) -> Parts {
    let metres = |m: Option<f64>| m.map_or_else(|| "-".into(), |m| format!("{} m", text::number(m, 3)));
    let percent = plate.shares.percent;
    let area = format!("{} m²", text::number(plate.shares.area_m2, 1));
    let is_beyond = plate.error_max_m.is_some_and(|m| m > limit_m);
    vec![
        (Role::Text, format!(" {}{area:>10}", text::column(&plate.name, 12))),
        (Role::Text, format!("{:>8} %", text::number(percent.scanned, 1))),
        (
            if percent.missed > 0.0 { Role::Warn } else { Role::Text },
            format!("{:>7} %", text::number(percent.missed, 1)),
        ),
        (Role::Text, format!("{:>14}", metres(plate.error_p95_m))),
        (if is_beyond { Role::Warn } else { Role::Text }, format!("{:>14}", metres(plate.error_max_m))),
    ]
}
