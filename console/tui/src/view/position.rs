//! The position pane: the AE stations' measurements, and how far to trust them.

use super::look::{Look, Parts, fill};
use super::text;
use crate::model::{Pane, Run, position::HISTORY_S};
use crate::theme::Role;
use positioning::{Exclusion, Integrity};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::{Station, StationId};

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let note = if look.run.position.lost { "LOST" } else { "" };
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
            (Role::Text, format!("{}   residual {}", heard(look.run, " of "), residual(look.run))),
        ]),
        look.line([(Role::Dim, " error      ".into()), error(look.run, true)]),
        curve(look, columns),
        look.line([
            (Role::Dim, " fix age    ".into()),
            age(look.run),
            (Role::Text, format!("   integrity {}", integrity(look.run))),
        ]),
    ];
    lines.extend(station_lines(look, columns, usize::from(inner.height).saturating_sub(lines.len())));
    lines
}

fn narrow_lines(look: &Look, inner: Rect) -> Vec<Line<'static>> {
    let columns = usize::from(inner.width).saturating_sub(1);
    let first = look.run.position.fix.as_ref().and_then(|fix| fix.excluded.first());
    let last = match first {
        Some((id, why)) => (Role::Watch, text::fit(&rejected(look.run, *id, why), columns)),
        None => (Role::Text, format!("residual {}", residual(look.run))),
    };
    vec![
        look.line([(Role::Text, format!(" {} ", heard(look.run, "/"))), error(look.run, false)]),
        look.line([(Role::Text, " ".into()), last]),
        look.line([(Role::Dim, " fix age ".into()), age(look.run)]),
    ]
}

fn stations(run: &Run) -> &[Station] {
    run.about.as_ref().map_or(&[], |about| &about.world.stations)
}

/// Stations heard in the last ranging cycle, of how many.
fn heard(run: &Run, of: &str) -> String {
    let heard = run.position.ranged_t_s.map_or_else(|| "-".into(), |_| run.position.heard.to_string());
    format!("{heard}{of}{}", stations(run).len())
}

fn residual(run: &Run) -> String {
    let rms = run.position.residual_rms_m();
    rms.map_or_else(|| "- mm".into(), |rms_m| format!("{} mm RMS", text::number(rms_m * 1000.0, 0)))
}

fn limit_m(run: &Run) -> f64 {
    run.about.as_ref().map_or(f64::NAN, |about| about.mission.position_limit_m)
}

fn error(run: &Run, wide: bool) -> (Role, String) {
    let limit_m = limit_m(run);
    let error_m = run.position.error_m();
    let role = match error_m {
        _ if run.position.lost => Role::Crit,
        Some(error_m) if error_m > 0.8 * limit_m => Role::Warn,
        _ => Role::Text,
    };
    let error = error_m.map_or_else(|| "-".into(), |error_m| format!("±{}", text::number(error_m, 2)));
    let limit = text::number(limit_m, 2);
    let lost = if run.position.lost { " LOST" } else { "" };
    if wide {
        (role, format!("{error} m (95 %)  limit {limit} m{lost}"))
    } else {
        (role, format!("{error} m (max {limit}){lost}"))
    }
}

fn curve(look: &Look, columns: usize) -> Line<'static> {
    let limit_m = limit_m(look.run);
    let note = format!(" 2 min, 0-{} m", text::number(limit_m, 2));
    let room = columns.saturating_sub(text::width(&note) + 2);
    let curve = text::sparkline(look.run.position.history_m(), limit_m, room, HISTORY_S);
    look.line([(Role::Text, " ".into()), (Role::Watch, curve), (Role::Dim, note)])
}

fn age(run: &Run) -> (Role, String) {
    let t_s = run.clock.t_s;
    match run.position.fix_age_s(t_s) {
        None => (Role::Text, "none yet".into()),
        Some(age_s) if run.position.is_fix_stale(t_s) => {
            (Role::Stale, format!("◌ {} s old", text::number(age_s, 1)))
        }
        Some(age_s) => (Role::Text, format!("{} s", text::number(age_s, 1))),
    }
}

fn integrity(run: &Run) -> &'static str {
    match (&run.position.failure, &run.position.fix) {
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
    if let Some(fix) = &look.run.position.fix {
        words.extend(fix.excluded.iter().map(|(id, why)| (Role::Watch, rejected(look.run, *id, why))));
        words.extend(fix.residuals.iter().map(|residual| {
            let residual_mm = text::number(residual.residual_m * 1000.0, 0);
            let sign = if residual.residual_m >= 0.0005 { "+" } else { "" };
            (Role::Text, format!("{} ok {sign}{residual_mm} mm", look.run.station_name(residual.station)))
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
fn rejected(run: &Run, id: StationId, why: &Exclusion) -> String {
    let name = run.station_name(id);
    match why {
        Exclusion::Silent => format!("{name} not heard"),
        Exclusion::Residual { residual_m, gate_m } => {
            format!("{name} rejected: {} > {} m", text::number(*residual_m, 2), text::number(*gate_m, 2))
        }
    }
}
