//! The position pane: what the AE stations measure, and how reliable it is.

use super::look::{Look, Parts, fill, marked, ranked};
use super::text;
use crate::model::{Pane, Run, history::SLOT_S};
use crate::theme::Role;
use mission::PositionTrust;
use positioning::{Exclusion, Integrity, Residual};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::{Station, StationId, beside_limit};

/// The mission time covered by the curve, seconds.
const CURVE_S: usize = 120;
/// Width from which the pane uses full words, columns.
const WIDE: usize = 40;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let note = if look.run.position.lost { "LOST" } else { "" };
    let block = look.pane(Pane::Position, "AE position", note);
    let inner = block.inner(area);
    let wide = usize::from(inner.width) >= WIDE;
    let lines = if wide { wide_lines(look, inner) } else { narrow_lines(look, inner) };
    fill(frame, area, block, ranked(lines, usize::from(inner.height)));
}

/// The lines of a wide pane. Status words come first, because lines are cut at their ends.
fn wide_lines(look: &Look, inner: Rect) -> Vec<(u8, Line<'static>)> {
    let columns = usize::from(inner.width);
    let run = look.run;
    let row = |label: &str, value: (Role, String)| look.line([(Role::Dim, format!(" {label:<11}")), value]);
    let heard = marked(is_ranging_stale(look), (Role::Text, heard(run, " of ")));
    let rms = marked(is_fix_stale(look), (Role::Text, residual(run)));
    let (role, age) = fix(look);
    let fix = (role, text::wording([format!("{age}, {}", source(look)), age], columns.saturating_sub(12)));
    let mut lines = vec![
        (0, row("95 % error", error(look))),
        (1, row("fix", fix)),
        (
            2,
            look.line([
                (Role::Dim, format!(" {:<11}", "heard")),
                heard,
                (Role::Dim, ", residual ".into()),
                rms,
            ]),
        ),
        (4, curve(look, columns)),
    ];
    if let Some(scale) = run.position.scale {
        let (value, sigma) = (100.0 * scale.value, 200.0 * scale.sigma);
        let slip = if run.position.is_slip_possible { ", or slip" } else { "" };
        let words = format!("{value:+.2} % ±{sigma:.2} %{slip}");
        lines.push((2, row("all ranges", (Role::Text, words))));
    }
    // The least known clock counts, because it limits the accuracy of every fix that uses it.
    let sigmas_m = run.position.clocks.iter().map(|clock| clock.offset_m.sigma);
    if let Some(sigma_m) = sigmas_m.max_by(f64::total_cmp) {
        let words = format!("agree to ±{:.2} m of range", 2.0 * sigma_m);
        lines.push((2, row("clocks", (Role::Text, words))));
    }
    let rows = usize::from(inner.height).saturating_sub(lines.len()).max(1);
    lines.extend(station_lines(look, columns, rows).into_iter().map(|line| (3, line)));
    lines
}

fn narrow_lines(look: &Look, inner: Rect) -> Vec<(u8, Line<'static>)> {
    let columns = usize::from(inner.width).saturating_sub(1);
    let first = look.run.position.fix.as_ref().and_then(|fix| fix.excluded.first());
    let last = match first {
        Some((id, why)) => (Role::Watch, text::fit(&rejected(look.run, *id, why), columns)),
        None => (Role::Text, format!("residual {}", residual(look.run))),
    };
    let blank = || (Role::Text, " ".to_owned());
    let heard = (Role::Text, format!(", {}", heard(look.run, "/")));
    vec![
        (0, look.line([blank(), error(look)])),
        (1, look.line([blank(), fix(look), heard])),
        (2, look.line([blank(), marked(is_fix_stale(look), last)])),
    ]
}

/// The state and age of the last fix, the stations heard and the residual, as one sentence.
pub(super) fn brief(look: &Look) -> String {
    format!("{}, {} heard, residual {}", fix(look).1, heard(look.run, "/"), residual(look.run))
}

pub(super) fn is_fix_stale(look: &Look) -> bool {
    let position = &look.run.position;
    let expects = !look.run.has_ended() && position.fix.is_some();
    expects && (look.model.silent_s().is_some() || position.is_fix_stale(look.run.clock.t_s))
}

/// The age of the figures of the stations, if they are not those of the last ranging cycle: the last fix is stale, or the
/// last cycle gave no fix.
pub(super) fn old_figures(look: &Look) -> Option<String> {
    let position = &look.run.position;
    let is_old = is_fix_stale(look) || (position.failure.is_some() && !look.run.has_ended());
    let age_s = position.fix_age_s(look.run.clock.t_s).filter(|_| is_old)?;
    Some(format!("{} s old", text::number(age_s, 0)))
}

fn is_ranging_stale(look: &Look) -> bool {
    let position = &look.run.position;
    let expects = !look.run.has_ended() && position.ranged_t_s.is_some();
    expects && (look.model.silent_s().is_some() || position.is_ranging_stale(look.run.clock.t_s))
}

fn stations(run: &Run) -> &[Station] {
    run.about.as_ref().map_or(&[], |about| &about.world.stations)
}

/// Stations heard in the last ranging cycle, out of the total.
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

fn error(look: &Look) -> (Role, String) {
    let run = look.run;
    let limit_m = limit_m(run);
    let error_m = run.position.error_m();
    // While the ranges contradict each other, the error computed from them cannot be trusted.
    let is_doubtful = run.standing.standing().position == PositionTrust::Alarmed;
    let role = match error_m {
        _ if run.position.lost || is_doubtful => Role::Crit,
        Some(error_m) if error_m > 0.8 * limit_m => Role::Warn,
        _ => Role::Text,
    };
    let error = error_m.map_or_else(|| "-".into(), |error_m| format!("±{}", text::number(error_m, 2)));
    let lost = if run.position.lost { "LOST " } else { "" };
    let (error, limit) = match error_m.map(|error_m| beside_limit(error_m, limit_m, 2)) {
        Some([beside, limit]) if limit_m.is_finite() && run.position.protection.is_none() => {
            (format!("±{beside}"), limit)
        }
        _ => (error, text::number(limit_m, 2)),
    };
    let (role, words) = match run.position.protection {
        _ if is_doubtful => (role, format!("{lost}{error} m, NOT RELIABLE")),
        None => (role, format!("{lost}{error} m (limit {limit})")),
        Some(Some(level_m)) => (role, format!("{lost}{error} m, protected {} m", text::number(level_m, 2))),
        Some(None) => (role.max(Role::Warn), format!("{lost}{error} m, NOT PROTECTED")),
    };
    marked(look.is_pose_stale(), (role, words))
}

fn curve(look: &Look, columns: usize) -> Line<'static> {
    let limit_m = limit_m(look.run);
    let history_m = &look.run.position.history_m;
    let note = format!(" {}, 0-{} m", text::minutes(history_m, CURVE_S), text::number(limit_m, 2));
    let room = columns.saturating_sub(text::width(&note) + 2);
    let curve = text::sparkline(history_m, CURVE_S, limit_m, room.min(CURVE_S / SLOT_S));
    look.line([(Role::Text, " ".into()), (Role::Watch, curve), (Role::Dim, note)])
}

/// What the estimated position is based on.
fn source(look: &Look) -> &'static str {
    let position = &look.run.position;
    let has_fix = position.fix.is_some() && position.failure.is_none();
    let has_ae = has_fix && !position.is_fix_stale(look.run.clock.t_s);
    let scanner = &look.run.scanner;
    match (has_ae, scanner.aids && scanner.trouble.is_none()) {
        (true, true) => "AE, scan, odometry",
        (true, false) => "AE and odometry",
        (false, true) => "scan and odometry",
        (false, false) => "odometry only",
    }
}

/// The state and age of the last fix.
fn fix(look: &Look) -> (Role, String) {
    let run = look.run;
    let Some(age_s) = run.position.fix_age_s(run.clock.t_s) else {
        let failed = run.position.failure.is_some();
        return if failed { (Role::Warn, "NO FIX yet".into()) } else { (Role::Text, "none yet".into()) };
    };
    let age = text::number(age_s, usize::from(age_s < 100.0));
    let (role, state) = state(run);
    marked(is_fix_stale(look), (role, format!("{state}, {age} s old")))
}

fn state(run: &Run) -> (Role, &'static str) {
    let integrity = run.position.fix.as_ref().map(|fix| fix.integrity);
    match integrity {
        _ if run.position.failure.is_some() => (Role::Warn, "NO FIX"),
        Some(Integrity::Suspect) => (Role::Warn, "SUSPECT"),
        Some(Integrity::Untestable) => (Role::Watch, "UNTESTED"),
        Some(Integrity::Alarm) => (Role::Crit, "ALARM"),
        Some(Integrity::Ok) | None => (Role::Text, "ok"),
    }
}

/// A few words per station: its residual, or why it was rejected. Rejected stations come first; if not all stations fit,
/// their number comes last.
fn station_lines(look: &Look, columns: usize, rows: usize) -> Vec<Line<'static>> {
    let mut words = Parts::new();
    if let Some(fix) = &look.run.position.fix {
        let age = old_figures(look);
        let word = |role: Role, words: String| match &age {
            Some(age) => marked(true, (Role::Text, format!("{words}, {age}"))),
            None => (role, words),
        };
        let rejected = fix.excluded.iter().map(|(id, why)| word(Role::Watch, rejected(look.run, *id, why)));
        words.extend(rejected);
        // A station that contradicts the others comes before those that agree.
        let (beyond, within): (Vec<_>, Vec<_>) =
            fix.residuals.iter().partition(|residual| residual.is_beyond());
        words.extend(beyond.into_iter().map(|residual| word(Role::Warn, beyond_limit(look.run, residual))));
        // A figure of an earlier fix does not say that the station is heard now, and while the ranges contradict each
        // other, no single range is known to be right.
        let agrees = age.is_none() && look.run.position.failure.is_none() && fix.integrity == Integrity::Ok;
        let state = if agrees {
            "ok "
        } else if age.is_some() {
            ""
        } else {
            "used "
        };
        words.extend(within.into_iter().map(|residual| {
            let residual_mm = text::number(residual.residual_m * 1000.0, 0);
            let sign = if residual.residual_m >= 0.0005 { "+" } else { "" };
            let name = look.run.station_name(residual.station);
            word(Role::Text, format!("{name} {state}{sign}{residual_mm} mm"))
        }));
    }
    let all = words.len();
    let fitting = (0..=all).rev().map(|n| (n, laid_out(&words[..n], all - n, columns)));
    let fits = fitting.into_iter().find(|(_, lines)| lines.len() <= rows);
    fits.map_or_else(Vec::new, |(_, lines)| lines.into_iter().map(|line| look.line(line)).collect())
}

/// The words in lines; if not all of them fit, the number left out comes last.
fn laid_out(words: &[(Role, String)], more: usize, columns: usize) -> Vec<Parts> {
    let mut lines = vec![Parts::new()];
    let mut used = 0;
    let more = (more > 0).then(|| (Role::Dim, format!("+{more}")));
    for (role, word) in words.iter().chain(&more) {
        // A blank before each word, and one more between two words.
        let word = text::fit(&format!(" {word}"), columns);
        let gap = usize::from(used > 0);
        if used + gap + text::width(&word) > columns {
            lines.push(Vec::new());
            used = 0;
        }
        if let Some(line) = lines.last_mut() {
            let gap = if used > 0 { " " } else { "" };
            used += text::width(&word) + gap.len();
            line.push((*role, format!("{gap}{word}")));
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

/// A station that is used in the fix although its range contradicts it, with its residual and the limit.
fn beyond_limit(run: &Run, residual: &Residual) -> String {
    let [size, limit] = beside_limit(residual.residual_m.abs(), residual.limit_m(), 2);
    let sign = if residual.residual_m < 0.0 { '-' } else { '+' };
    format!("{} used, {sign}{size} m! (limit {limit})", run.station_name(residual.station))
}

/// A station that is not used in the fix, and the reason.
fn rejected(run: &Run, id: StationId, why: &Exclusion) -> String {
    let name = run.station_name(id);
    match why {
        Exclusion::Silent => format!("{name} not heard"),
        Exclusion::ByOrder => format!("{name} excluded"),
        Exclusion::Biased { bias_m } => format!("{name} biased by {} m", text::number(*bias_m, 2)),
        Exclusion::Impossible { range_m, most_m } => {
            format!("{name} impossible: {} > {} m", text::number(*range_m, 1), text::number(*most_m, 1))
        }
        Exclusion::Residual { residual_m, gate_m } => {
            format!("{name} rejected: {} > {} m", text::number(*residual_m, 2), text::number(*gate_m, 2))
        }
    }
}
