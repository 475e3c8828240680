//! The tether pane: how much is out, round what, and whether there is a way home.

use super::{Look, fill, text};
use crate::{model::Tether, theme::Role};
use ratatui::{Frame, layout::Rect, text::Line};

/// Rows with the frame, on a wide and on a narrow screen.
pub(super) const ROWS: (u16, u16) = (8, 6);

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let block = look.block(Role::Border, "Tether", note(look));
    let Some(tether) = &look.model.tether else { return };
    let lines = if wide { wide_lines(look, tether) } else { narrow_lines(look, tether) };
    let columns = usize::from(block.inner(area).width);
    let lines = lines.into_iter().map(|parts| cut(look, parts, columns)).collect();
    fill(frame, area, block, lines);
}

type Parts = Vec<(Role, String)>;

fn cut(look: &Look, parts: Parts, columns: usize) -> Line<'static> {
    let mut room = columns;
    look.line(parts.into_iter().map(|(role, words)| {
        let words = text::fit(&words, room);
        room = room.saturating_sub(text::width(&words));
        (role, words)
    }))
}

fn note(look: &Look) -> &'static str {
    match look.model.tether.as_ref().and_then(|tether| tether.certified) {
        Some(true) => "plan certified",
        Some(false) => "NOT certified",
        None => "",
    }
}

fn wide_lines(look: &Look, tether: &Tether) -> Vec<Parts> {
    let row = |label: &str, value: (Role, String)| vec![(Role::Dim, format!(" {label:<12}")), value];
    let out = format!("{} m   free {} m", text::number(tether.length_m, 1), free(tether));
    let of = limits(look)
        .map_or_else(String::new, |limits| format!(" of {}", text::number(limits.reel_length_m, 1)));
    let sum = format!("{}°", degrees(tether.wrap_total_rad));
    vec![
        row("out", (out_role(look, tether), out + &of)),
        row("wraps", (wrap_role(look, tether), worst(look, tether, true))),
        row("in sum", (Role::Text, format!("{sum}   pull ×{}", text::number(tether.pull_factor, 2)))),
        row("contacts", (Role::Text, contacts(tether))),
        row("way home", home(tether, true)),
        row("on return", (Role::Text, returned(look))),
    ]
}

fn narrow_lines(look: &Look, tether: &Tether) -> Vec<Parts> {
    let out = format!(" {} m out  {} m free", text::number(tether.length_m, 1), free(tether));
    let (role, way) = home(tether, false);
    vec![
        vec![(out_role(look, tether), out)],
        vec![(Role::Text, " wrap ".into()), (wrap_role(look, tether), worst(look, tether, false))],
        vec![
            (Role::Text, format!(" sum {}°", degrees(tether.wrap_total_rad))),
            (Role::Text, format!("  pull ×{}", text::number(tether.pull_factor, 2))),
        ],
        vec![(Role::Text, " way home ".into()), (role, way)],
    ]
}

fn limits(look: &Look) -> Option<world::tether::Limits> {
    Some(look.model.run.as_ref()?.mission.tether.as_ref()?.limits)
}

fn free(tether: &Tether) -> String {
    text::number(tether.free_m, 1)
}

fn degrees(rad: f64) -> String {
    text::number(rad.to_degrees(), 0)
}

fn out_role(look: &Look, tether: &Tether) -> Role {
    match limits(look) {
        Some(limits) if tether.length_m > limits.reel_length_m => Role::Crit,
        Some(limits) if tether.length_m > 0.8 * limits.reel_length_m => Role::Warn,
        _ => Role::Text,
    }
}

fn wrap_role(look: &Look, tether: &Tether) -> Role {
    let most = tether.contacts.iter().map(|contact| contact.wrap_rad.abs()).fold(0.0, f64::max);
    match limits(look) {
        Some(limits) if most > limits.wrap_max_rad => Role::Crit,
        Some(limits) if most > 0.8 * limits.wrap_max_rad => Role::Warn,
        _ => Role::Text,
    }
}

/// The largest wrap and where it is.
fn worst(look: &Look, tether: &Tether, wide: bool) -> String {
    if tether.is_snagged {
        return "unknown, tether snagged".into();
    }
    let Some(most) = tether.contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()))
    else {
        return "none, tether straight".into();
    };
    let limit = limits(look).map_or_else(|| "-".into(), |limits| degrees(limits.wrap_max_rad));
    let sign = if most.wrap_rad > 0.0 { "+" } else { "" };
    let (angle, of) = (degrees(most.wrap_rad), if wide { "limit" } else { "lim" });
    format!("{sign}{angle}° at {} ({of} {limit}°)", most.on)
}

fn contacts(tether: &Tether) -> String {
    if tether.contacts.is_empty() {
        return "-".into();
    }
    tether.contacts.iter().map(|contact| contact.on.as_str()).collect::<Vec<_>>().join(", ")
}

fn home(tether: &Tether, wide: bool) -> (Role, String) {
    match tether.return_length_m {
        _ if tether.is_snagged && wide => (Role::Crit, "UNKNOWN: tether snagged".into()),
        _ if tether.is_snagged => (Role::Crit, "UNKNOWN, snagged".into()),
        Some(way_m) if wide => (Role::Good, format!("{} m, along the tether: YES", text::number(way_m, 1))),
        Some(way_m) => (Role::Good, format!("{} m  YES", text::number(way_m, 1))),
        None => (Role::Crit, "NO: the hull does not fit".into()),
    }
}

/// What stays out when the mission is over.
fn returned(look: &Look) -> String {
    match (&look.model.tether, look.model.has_ended()) {
        (Some(tether), true) => format!("{} m still deployed", text::number(tether.length_m, 1)),
        _ => "-".into(),
    }
}
