//! The position pane: the AE stations' measurements, and how far to trust them.

use super::look::{Look, Parts, fill};
use super::text;
use crate::model::{Model, Pane, position::HISTORY_S};
use crate::theme::Role;
use positioning::{Exclusion, Integrity};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::{Station, StationId};

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let note = if look.model.position.lost { "LOST" } else { "" };
    let block = look.pane(Pane::Position, "AE position", note);
    let inner = block.inner(area);
    let lines = if wide { wide_lines(look, inner) } else { narrow_lines(look, inner) };
    fill(frame, area, block, lines);
}

fn wide_lines(look: &Look, inner: Rect) -> Vec<Line<'static>> {
    let columns = usize::from(inner.width);
    let mut lines = vec![
        look.line([
            (Role::Dim, " heard      ".into()),
            (Role::Text, format!("{}   residual {}", heard(look.model, " of "), residual(look.model))),
        ]),
        look.line([(Role::Dim, " error      ".into()), error(look.model, true)]),
        curve(look, columns),
        look.line([
            (Role::Dim, " fix age    ".into()),
            age(look.model),
            (Role::Text, format!("   integrity {}", integrity(look.model))),
        ]),
    ];
    lines.extend(station_lines(look, columns, usize::from(inner.height).saturating_sub(lines.len())));
    lines
}

fn narrow_lines(look: &Look, inner: Rect) -> Vec<Line<'static>> {
    let columns = usize::from(inner.width).saturating_sub(1);
    let first = look.model.position.fix.as_ref().and_then(|fix| fix.excluded.first());
    let last = match first {
        Some((id, why)) => (Role::Watch, text::fit(&rejected(look.model, *id, why), columns)),
        None => (Role::Text, format!("residual {}", residual(look.model))),
    };
    vec![
        look.line([(Role::Text, format!(" {} ", heard(look.model, "/"))), error(look.model, false)]),
        look.line([(Role::Text, " ".into()), last]),
        look.line([(Role::Dim, " fix age ".into()), age(look.model)]),
    ]
}

fn stations(model: &Model) -> &[Station] {
    model.run.as_ref().map_or(&[], |run| &run.world.stations)
}

/// Stations heard in the last ranging cycle, of how many.
fn heard(model: &Model, of: &str) -> String {
    let heard = model.position.ranged_t_s.map_or_else(|| "-".into(), |_| model.position.heard.to_string());
    format!("{heard}{of}{}", stations(model).len())
}

fn residual(model: &Model) -> String {
    let rms = model.position.residual_rms_m();
    rms.map_or_else(|| "- mm".into(), |rms_m| format!("{} mm RMS", text::number(rms_m * 1000.0, 0)))
}

fn limit_m(model: &Model) -> f64 {
    model.run.as_ref().map_or(f64::NAN, |run| run.mission.position_limit_m)
}

fn error(model: &Model, wide: bool) -> (Role, String) {
    let limit_m = limit_m(model);
    let error_m = model.position.error_m();
    let role = match error_m {
        _ if model.position.lost => Role::Crit,
        Some(error_m) if error_m > 0.8 * limit_m => Role::Warn,
        _ => Role::Text,
    };
    let error = error_m.map_or_else(|| "-".into(), |error_m| format!("±{}", text::number(error_m, 2)));
    let limit = text::number(limit_m, 2);
    let lost = if model.position.lost { " LOST" } else { "" };
    if wide {
        (role, format!("{error} m (95 %)  limit {limit} m{lost}"))
    } else {
        (role, format!("{error} m (max {limit}){lost}"))
    }
}

fn curve(look: &Look, columns: usize) -> Line<'static> {
    let limit_m = limit_m(look.model);
    let note = format!(" 2 min, 0-{} m", text::number(limit_m, 2));
    let room = columns.saturating_sub(text::width(&note) + 2);
    let curve = text::sparkline(look.model.position.history_m(), limit_m, room, HISTORY_S);
    look.line([(Role::Text, " ".into()), (Role::Watch, curve), (Role::Dim, note)])
}

fn age(model: &Model) -> (Role, String) {
    let t_s = model.clock.t_s;
    match model.position.fix_age_s(t_s) {
        None => (Role::Text, "none yet".into()),
        Some(age_s) if model.position.is_fix_stale(t_s) => {
            (Role::Stale, format!("◌ {} s old", text::number(age_s, 1)))
        }
        Some(age_s) => (Role::Text, format!("{} s", text::number(age_s, 1))),
    }
}

fn integrity(model: &Model) -> &'static str {
    match (&model.position.failure, &model.position.fix) {
        (Some(_), _) => "NO FIX",
        (None, None) => "-",
        (None, Some(fix)) => match fix.integrity {
            Integrity::Ok => "ok",
            Integrity::Suspect => "SUSPECT",
            Integrity::Untestable => "UNTESTED",
            Integrity::Alarm => "ALARM",
        },
    }
}

/// A few words per station: its residual, or why it was rejected; those rejected come first.
fn station_lines(look: &Look, columns: usize, rows: usize) -> Vec<Line<'static>> {
    let mut words = Parts::new();
    if let Some(fix) = &look.model.position.fix {
        words.extend(fix.excluded.iter().map(|(id, why)| (Role::Watch, rejected(look.model, *id, why))));
        words.extend(fix.residuals.iter().map(|residual| {
            let residual_mm = text::number(residual.residual_m * 1000.0, 0);
            let sign = if residual.residual_m >= 0.0005 { "+" } else { "" };
            (Role::Text, format!("{} ok {sign}{residual_mm} mm", look.model.station_name(residual.station)))
        }));
    }
    let mut lines: Vec<Parts> = Vec::new();
    let mut used = columns;
    for (role, word) in words {
        let word = text::fit(&format!(" {word} "), columns);
        if used + text::width(&word) > columns {
            lines.push(Vec::new());
            used = 0;
        }
        used += text::width(&word);
        if let Some(line) = lines.last_mut() {
            line.push((role, word));
        }
    }
    lines.into_iter().take(rows).map(|line| look.line(line)).collect()
}

/// A station that has no part in the fix, and why.
fn rejected(model: &Model, id: StationId, why: &Exclusion) -> String {
    let name = model.station_name(id);
    match why {
        Exclusion::Silent => format!("{name} not heard"),
        Exclusion::Residual { residual_m, gate_m } => {
            format!("{name} rejected: {} > {} m", text::number(*residual_m, 2), text::number(*gate_m, 2))
        }
    }
}
