//! The tether pane: the length out, the wraps, and the return path.

use super::look::{Look, Parts, fill, marked, ranked};
use super::text;
use crate::model::history::HISTORY_S;
use crate::model::{History, Pane, Tether};
use crate::theme::Role;
use mission::{
    Phase,
    event::{MeasuredPull, SLACK_M},
};
use ratatui::{Frame, layout::Rect};

/// Width from which the pane uses full words, columns.
const WIDE: usize = 38;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.pane(Pane::Tether, "Tether", note(look));
    let Some(tether) = &look.run.tether else { return };
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let write = if columns >= WIDE { wide_lines } else { narrow_lines };
    let lines = write(look, tether, columns);
    let lines = lines.into_iter().map(|(rank, parts)| (rank, look.line(parts))).collect();
    fill(frame, area, block, ranked(lines, usize::from(inner.height)));
}

fn note(look: &Look) -> &'static str {
    if look.run.tether.as_ref().is_some_and(|tether| tether.is_broken) {
        return "BROKEN";
    }
    // The certificate assumes a reel that takes the tether up.
    if look.run.is_tether_slack() {
        return "SLACK";
    }
    match look.run.tether.as_ref().and_then(|tether| tether.certified) {
        Some(true) => "plan certified",
        Some(false) => "NOT certified",
        None if *look.run.phase() == Phase::Waiting || look.run.is_survey() => "",
        None => "no certified plan",
    }
}

fn wide_lines(look: &Look, tether: &Tether, columns: usize) -> Vec<(u8, Parts)> {
    let is_stale = look.is_stale(tether.t_s);
    // The label takes 13 columns, and the stale mark takes one.
    let room = columns.saturating_sub(14);
    let row = |rank: u8, label: &str, value: (Role, String)| {
        (rank, vec![(Role::Dim, format!(" {label:<12}")), marked(is_stale, value)])
    };
    let (out, left) = (metres(tether.length_m), metres(tether.free_m));
    let reel = reel(look);
    if tether.is_broken {
        return vec![
            row(0, "torn", (Role::Crit, torn(tether, room))),
            row(1, "the rest", (Role::Text, "lies on the floor".into())),
        ];
    }
    let out = [format!("{out} of {reel}, {left} m left"), format!("{out} of {reel} m")];
    let out = metered(out_share(look, tether), out, room);
    let still_out = format!("{} m still out", metres(tether.length_m));
    let mut lines = vec![
        row(1, "paid out", (out_role(look, tether), out)),
        row(2, "wrap", (wrap_role(look, tether), worst(look, tether, ("", room)))),
        row(5, "total wrap", (Role::Text, total(tether))),
        row(8, "contacts", (Role::Text, contacts(tether))),
        row(0, "return path", home(look, tether)),
    ];
    // Of the two curves, that of a measured pull is the more important.
    lines.push((7, trend(look, tether, columns)));
    lines.extend(pull(look, tether, ("", room)).map(|pull| row(3, "reel needs", pull)));
    match tether.measured {
        Some(measured) => {
            let (label, most_n) = felt_where(look);
            lines.push(row(3, label, felt(measured.pull_n, most_n)));
            lines.push((6, pull_trend(tether, most_n, columns)));
            lines.push(row(slack_rank(measured, 4), "slack", slack(measured)));
        }
        None => lines.push((9, vec![(Role::Dim, format!(" {:<12} no sensor", "pull, slack"))])),
    }
    if look.run.has_ended() {
        lines.push(row(6, "at end", (Role::Text, still_out)));
    }
    lines
}

/// The curve of the length out over the last minutes, up to the length of the reel.
fn trend(look: &Look, tether: &Tether, columns: usize) -> Parts {
    let reel_m = limits(look).map(|limits| limits.reel_length_m);
    curve(&tether.length_history_m, reel_m, "m", columns)
}

/// The curve of the measured pull over the last minutes, up to its limit.
fn pull_trend(tether: &Tether, most_n: Option<f64>, columns: usize) -> Parts {
    curve(&tether.pull_history_n, most_n, "N", columns)
}

/// The curve of a figure over the last minutes, up to its limit or, without one, to its largest value.
fn curve(history: &History, limit: Option<f64>, unit: &str, columns: usize) -> Parts {
    let top = limit.unwrap_or_else(|| history.last(HISTORY_S).fold(0.0, f64::max));
    let note = format!(" {}, 0-{} {unit}", text::minutes(history, HISTORY_S), text::number(top, 0));
    let room = columns.saturating_sub(text::width(&note) + 2);
    let curve = text::sparkline(history, HISTORY_S, top, room);
    vec![(Role::Watch, format!(" {curve}")), (Role::Dim, note)]
}

fn narrow_lines(look: &Look, tether: &Tether, columns: usize) -> Vec<(u8, Parts)> {
    let is_stale = look.is_stale(tether.t_s);
    let row = |rank: u8, label: &str, value: (Role, String)| {
        (rank, vec![(Role::Text, format!(" {label}")), marked(is_stale, value)])
    };
    let room = columns.saturating_sub(2);
    let (out, reel) = (metres(tether.length_m), reel(look));
    if tether.is_broken {
        let words = format!("torn, {}", torn(tether, room.saturating_sub(6)));
        return vec![row(0, "", (Role::Crit, words))];
    }
    let out = [format!("out {out} of {reel} m"), format!("out {out}/{reel} m")];
    let out = labelled(out_share(look, tether), out, room);
    let pull = pull(look, tether, ("reel needs ", room)).map(|pull| row(4, "", pull));
    let felt = tether
        .measured
        .map(|measured| row(slack_rank(measured, 2), "", pull_and_slack(look, measured, room)));
    let is_wound = wrap_share(look, tether) > text::CLOSE || tether.is_snagged;
    let wrap_rank = if felt.is_none() || is_wound { 2 } else { 3 };
    [
        row(1, "", (out_role(look, tether), out)),
        row(wrap_rank, "", (wrap_role(look, tether), worst(look, tether, ("wrap ", room)))),
        row(6, "total ", (Role::Text, total(tether))),
    ]
    .into_iter()
    .chain(pull)
    .chain(felt)
    .chain([row(0, "return path ", home(look, tether))])
    .collect()
}

/// The length off the reel of a torn tether, now and when the break was noticed: a reel that works winds the end up.
fn torn(tether: &Tether, room: usize) -> String {
    let now = format!("{} m off the reel", metres(tether.length_m));
    let noticed = tether.broke_out_m.map(metres).filter(|noticed| *noticed != metres(tether.length_m));
    match noticed {
        Some(noticed) => {
            let words =
                [format!("{now} now, {noticed} m when noticed"), format!("{now} (first {noticed} m)"), now];
            text::wording(words, room)
        }
        None => now,
    }
}

fn limits(look: &Look) -> Option<world::tether::Limits> {
    Some(look.run.about.as_ref()?.mission.tether.as_ref()?.limits)
}

fn reel(look: &Look) -> String {
    limits(look).map_or_else(|| "-".into(), |limits| metres(limits.reel_length_m))
}

/// The fullest wording that fits beside a meter.
fn metered(share: f64, words: [String; 2], room: usize) -> String {
    format!("{} {}", text::meter(share), text::wording(words, room.saturating_sub(text::METER + 1)))
}

/// A figure with its name in a longer or a shorter wording beside a meter, or the longer wording alone: without its name, a
/// meter could be that of any figure.
fn labelled(share: f64, [long, short]: [String; 2], room: usize) -> String {
    let beside = |words: &str| format!("{} {words}", text::meter(share));
    text::wording([beside(&long), beside(&short), long], room)
}

fn metres(length_m: f64) -> String {
    text::number(length_m, 1)
}

fn degrees(rad: f64) -> String {
    text::number(rad.to_degrees(), 0)
}

/// The length out, as a share of the reel.
pub(super) fn out_share(look: &Look, tether: &Tether) -> f64 {
    limits(look).map_or(f64::NAN, |limits| tether.length_m / limits.reel_length_m)
}

/// The largest wrap, as a share of its limit.
fn wrap_share(look: &Look, tether: &Tether) -> f64 {
    let most_rad = tether.largest().map_or(0.0, |contact| contact.wrap_rad.abs());
    limits(look).map_or(f64::NAN, |limits| most_rad / limits.wrap_max_rad)
}

fn out_role(look: &Look, tether: &Tether) -> Role {
    beside_limit(out_share(look, tether))
}

fn wrap_role(look: &Look, tether: &Tether) -> Role {
    beside_limit(wrap_share(look, tether))
}

fn beside_limit(share: f64) -> Role {
    match share {
        share if share > 1.0 => Role::Crit,
        share if share > text::CLOSE => Role::Warn,
        _ => Role::Text,
    }
}

/// The largest wrap, with the obstacle round which the tether is wrapped, after a label.
fn worst(look: &Look, tether: &Tether, (label, room): (&str, usize)) -> String {
    if tether.is_snagged {
        return format!("{label}UNKNOWN (snagged)");
    }
    let Some(most) = tether.largest() else { return format!("{label}none, tether straight") };
    let limit = limits(look).map_or_else(|| "-".into(), |limits| degrees(limits.wrap_max_rad));
    let turn = if most.wrap_rad > 0.0 { "CCW" } else { "CW" };
    let wrap = format!("{}° {turn} on {}", degrees(most.wrap_rad.abs()), most.on);
    let share = wrap_share(look, tether);
    if label.is_empty() {
        return metered(share, [format!("{wrap}, max {limit}°"), wrap], room);
    }
    let short = wrap.replace(" on ", " ");
    labelled(share, [wrap, short].map(|words| format!("{label}{words}")), room)
}

fn total(tether: &Tether) -> String {
    format!("{}°, pull ×{}", degrees(tether.wrap_total_rad), text::number(tether.pull_factor, 2))
}

/// The pull at the reel that taking up the tether needs, after a label; `None` if the scenario does not describe the reel.
fn pull(look: &Look, tether: &Tether, (label, room): (&str, usize)) -> Option<(Role, String)> {
    let reel = look.run.reel()?;
    let pull_n = tether.pull_n?;
    let share = pull_n / reel.pull_n;
    let role = match share {
        share if share > 1.0 => Role::Crit,
        share if share > reel.pull_ratio_max => Role::Warn,
        _ => Role::Text,
    };
    let [now, most] = [pull_n, reel.pull_n].map(|newtons| text::number(newtons, 1));
    let words = [format!("{label}{now} of {most} N"), format!("{label}{now}/{most} N")];
    Some((role, labelled(share, words, room)))
}

/// Where the pull is measured, and its largest permitted value there, newtons. A simulated robot feels the tether; a real
/// vehicle reports the pull at its reel.
fn felt_where(look: &Look) -> (&'static str, Option<f64>) {
    if look.run.is_live() {
        ("reel now", look.run.reel().map(|reel| reel.pull_n))
    } else {
        ("robot pull", look.run.robot_pull_most_n())
    }
}

/// The measured pull beside its limit.
fn felt(pull_n: f64, most_n: Option<f64>) -> (Role, String) {
    match most_n {
        Some(most_n) => {
            let [now, most] = world::beside_limit(pull_n, most_n, 1);
            (beside_limit(pull_n / most_n), format!("{now} of {most} N"))
        }
        None => (Role::Text, format!("{} N (no limit given)", text::number(pull_n, 1))),
    }
}

/// The measured pull and the slack in one narrow row; near its limit, the slack comes first, with the limit.
fn pull_and_slack(look: &Look, measured: MeasuredPull, room: usize) -> (Role, String) {
    let (label, most_n) = felt_where(look);
    let pull = format!("{label} {} N", text::number(measured.pull_n, 1));
    if slack_rank(measured, 1) == 0 {
        let (role, slack) = slack(measured);
        let slack = format!("slack {slack}");
        return (role, text::wording([format!("{slack}, {pull}"), slack], room));
    }
    let (role, beside) = felt(measured.pull_n, most_n);
    let slack = format!("{pull}, slack {} m", text::number(measured.slack_m, 2));
    (role, text::wording([slack, format!("{label} {beside}"), pull], room))
}

/// The rank of the slack among the rows of the pane: near its limit, it is more important than the wrap.
fn slack_rank(measured: MeasuredPull, calm: u8) -> u8 {
    if measured.slack_m > text::CLOSE * SLACK_M { 0 } else { calm }
}

/// The slack beside its limit.
fn slack(measured: MeasuredPull) -> (Role, String) {
    let [slack, limit] = world::beside_limit(measured.slack_m, SLACK_M, 2);
    (beside_limit(measured.slack_m / SLACK_M), format!("{slack} of {limit} m"))
}

fn contacts(tether: &Tether) -> String {
    if tether.contacts.is_empty() {
        return "none".into();
    }
    tether.contacts.iter().map(|contact| contact.on.as_str()).collect::<Vec<_>>().join(", ")
}

fn home(look: &Look, tether: &Tether) -> (Role, String) {
    match tether.return_length_m {
        _ if tether.is_snagged => (Role::Crit, "UNKNOWN".into()),
        // The robot must not drive along a tether that lies on the floor.
        Some(_) if look.run.is_tether_slack() => (Role::Warn, "see :return".into()),
        Some(way_m) => (Role::Good, format!("CLEAR, {} m", metres(way_m))),
        None => (Role::Crit, "BLOCKED".into()),
    }
}
