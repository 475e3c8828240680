//! The tether pane: how much is out, round what, and whether there is a return path.

use super::look::{Look, Parts, fill};
use super::text;
use crate::{model::Tether, theme::Role};
use ratatui::{Frame, layout::Rect, text::Line};

/// Rows with the frame, on a wide and on a narrow screen.
pub(super) const ROWS: (u16, u16) = (8, 6);

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let block = look.block(Role::Border, "Tether", note(look));
    let Some(tether) = &look.run.tether else { return };
    let lines = if wide { wide_lines(look, tether) } else { narrow_lines(look, tether) };
    let columns = usize::from(block.inner(area).width);
    let lines = lines.into_iter().map(|parts| cut(look, parts, columns)).collect();
    fill(frame, area, block, lines);
}

fn cut(look: &Look, parts: Parts, columns: usize) -> Line<'static> {
    let mut room = columns;
    look.line(parts.into_iter().map(|(role, words)| {
        let words = text::fit(&words, room);
        room = room.saturating_sub(text::width(&words));
        (role, words)
    }))
}

fn note(look: &Look) -> &'static str {
    match look.run.tether.as_ref().and_then(|tether| tether.certified) {
        Some(true) => "plan certified",
        Some(false) => "NOT certified",
        None => "",
    }
}

fn wide_lines(look: &Look, tether: &Tether) -> Vec<Parts> {
    let row = |label: &str, value: (Role, String)| vec![(Role::Dim, format!(" {label:<12}")), value];
    let of =
        limits(look).map_or_else(String::new, |limits| format!(" of {} m", metres(limits.reel_length_m)));
    let out = format!("{} m{of}, {} m left", metres(tether.length_m), metres(tether.free_m));
    let still_out = format!("{} m still out", metres(tether.length_m));
    vec![
        row("paid out", (out_role(look, tether), out)),
        row("wrap", (wrap_role(look, tether), worst(look, tether))),
        row("total wrap", (Role::Text, total(tether))),
        row("contacts", (Role::Text, contacts(tether))),
        row("return path", home(tether)),
        row("at end", (Role::Text, if look.run.has_ended() { still_out } else { "-".into() })),
    ]
}

fn narrow_lines(look: &Look, tether: &Tether) -> Vec<Parts> {
    let out = format!(" {} m out, {} m left", metres(tether.length_m), metres(tether.free_m));
    vec![
        vec![(out_role(look, tether), out)],
        vec![(Role::Text, " wrap ".into()), (wrap_role(look, tether), worst(look, tether))],
        vec![(Role::Text, format!(" total {}", total(tether)))],
        vec![(Role::Text, " return path ".into()), home(tether)],
    ]
}

fn limits(look: &Look) -> Option<world::tether::Limits> {
    Some(look.run.about.as_ref()?.mission.tether.as_ref()?.limits)
}

fn metres(length_m: f64) -> String {
    text::number(length_m, 1)
}

fn degrees(rad: f64) -> String {
    text::number(rad.to_degrees(), 0)
}

fn out_role(look: &Look, tether: &Tether) -> Role {
    beside_limit(tether.length_m, limits(look).map(|limits| limits.reel_length_m))
}

fn wrap_role(look: &Look, tether: &Tether) -> Role {
    let most_rad = tether.contacts.iter().map(|contact| contact.wrap_rad.abs()).fold(0.0, f64::max);
    beside_limit(most_rad, limits(look).map(|limits| limits.wrap_max_rad))
}

fn beside_limit(value: f64, limit: Option<f64>) -> Role {
    match limit {
        Some(limit) if value > limit => Role::Crit,
        Some(limit) if value > 0.8 * limit => Role::Warn,
        _ => Role::Text,
    }
}

/// The largest wrap and where it is.
fn worst(look: &Look, tether: &Tether) -> String {
    if tether.is_snagged {
        return "unknown, tether snagged".into();
    }
    let Some(most) = tether.contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()))
    else {
        return "none, tether straight".into();
    };
    let limit = limits(look).map_or_else(|| "-".into(), |limits| degrees(limits.wrap_max_rad));
    let sign = if most.wrap_rad > 0.0 { "+" } else { "" };
    format!("{sign}{}° on {}, max {limit}°", degrees(most.wrap_rad), most.on)
}

fn total(tether: &Tether) -> String {
    format!("{}°, pull ×{}", degrees(tether.wrap_total_rad), text::number(tether.pull_factor, 2))
}

fn contacts(tether: &Tether) -> String {
    if tether.contacts.is_empty() {
        return "none".into();
    }
    tether.contacts.iter().map(|contact| contact.on.as_str()).collect::<Vec<_>>().join(", ")
}

fn home(tether: &Tether) -> (Role, String) {
    match tether.return_length_m {
        _ if tether.is_snagged => (Role::Crit, "UNKNOWN".into()),
        Some(way_m) => (Role::Good, format!("CLEAR, {} m", metres(way_m))),
        None => (Role::Crit, "BLOCKED".into()),
    }
}
