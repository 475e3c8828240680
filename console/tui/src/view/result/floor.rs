//! The floor shares, relative to the whole and to the reachable floor, and the critical zone along the shell.

use super::{figures, plates};
use crate::model::{Model, Pane, RunResult};
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::text;
use account::{Percent, Shares};
use ratatui::Frame;
use ratatui::layout::Rect;

/// The maximum missed share at which a plate counts as scanned except for slivers, per cent.
const MISSED_PERCENT: f64 = 1.0;

/// The minimum rows of the pane, including its frame: those without the notes.
pub(super) fn least(model: &Model, result: &RunResult, columns: u16) -> u16 {
    bases(model, result, usize::from(columns).saturating_sub(1)).len() as u16 + 2
}

/// The rows that the pane needs, without its frame.
pub(super) fn rows(model: &Model, result: &RunResult, columns: u16) -> u16 {
    lines(model, result, usize::from(columns).saturating_sub(1)).len() as u16
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let columns = usize::from(area.width).saturating_sub(3);
    let lines = lines(look.model, result, columns);
    super::scrolled(look, frame, (Pane::Coverage, area), (Role::Border, "Coverage"), lines);
}

fn lines(model: &Model, result: &RunResult, columns: usize) -> Vec<Parts> {
    let notes = notes(model, result).into_iter().flat_map(|note| text::wrap(&note, columns));
    let notes = notes.map(|line| vec![(Role::Text, format!(" {line}"))]);
    bases(model, result, columns).into_iter().chain(notes).collect()
}

/// Why a mission has no scanned floor, as a sentence.
pub(super) fn no_scan(model: &Model) -> &'static str {
    if model.live.run.is_survey() { "A survey: the map is its result." } else { "Not a scanning mission." }
}

/// The shares of each floor of which shares are stated, as bars.
fn bases(model: &Model, result: &RunResult, columns: usize) -> Vec<Parts> {
    let Some(account) = &result.summary.floor else {
        return vec![vec![(Role::Dim, format!(" {}", no_scan(model)))]];
    };
    let at = Columns::of(columns, account.whole.untestable > 0.0);
    let mut rows = vec![vec![(Role::Dim, at.head())]];
    rows.push(at.row("reachable", &account.reachable));
    rows.push(at.row("whole floor", &account.whole));
    rows.extend(model.live.requested().map(|shares| at.row("requested", shares)));
    if let Some(all) = model.live.together() {
        rows.push(at.row("all runs", &all.floor.reachable));
        rows.push(at.row("all, whole", &all.floor.whole));
    }
    let others = others(&account.whole.percent).filter(|_| at.others == [0; 3]);
    let others = others.into_iter().flat_map(|words| text::wrap(&words, columns));
    rows.extend(others.map(|line| vec![(Role::Text, format!(" {line}"))]));
    rows.extend(plates::worst(model, columns).filter(|_| columns < figures::WORST));
    rows
}

/// The shares of the whole floor for which a narrow table has no columns, as a sentence; `None` if all of them are zero.
fn others(percent: &Percent) -> Option<String> {
    let shares = [
        ("not testable by this tool", percent.untestable),
        ("unreachable", percent.unreachable),
        ("margin", percent.margin),
    ];
    let shares = shares.into_iter().filter(|(_, share)| *share > 0.0);
    let shares: Vec<String> =
        shares.map(|(name, share)| format!("{name} {} %", text::number(share, 1))).collect();
    (!shares.is_empty()).then(|| format!("Of the whole floor: {}.", shares.join(", ")))
}

/// The widths of the columns; 0 for a column that does not fit.
struct Columns {
    bar: usize,
    area: usize,
    /// The last one is 0 also if the tool can test all floor.
    others: [usize; 3],
}

/// Width of the name of a floor, and of its scanned and unscanned share. In a mission that ended early, unscanned floor is not
/// the same as missed floor.
const NAME: usize = 12;
const SHARE: usize = 8;
const LEFT: usize = 12;
/// Width of the shares that are shown only if there is room: unreachable floor, the margin, and floor that the tool cannot test.
const OTHERS: [usize; 3] = [12, 7, 11];
/// Width of an area.
const AREA: usize = 11;
/// Minimum and maximum width of a bar.
const BAR: (usize, usize) = (6, 24);

impl Columns {
    fn of(room: usize, has_untestable: bool) -> Self {
        let left = room.saturating_sub(1 + NAME + SHARE + LEFT);
        let [unreachable, margin, untestable] = OTHERS;
        let others = [unreachable, margin, if has_untestable { untestable } else { 0 }];
        let others = if left >= others.iter().sum::<usize>() + AREA + BAR.0 { others } else { [0; 3] };
        let taken: usize = others.iter().sum();
        let area = if left >= taken + AREA + BAR.0 { AREA } else { 0 };
        let bar = left.saturating_sub(taken + area).min(BAR.1);
        Self { bar, area, others }
    }

    fn head(&self) -> String {
        let right =
            |word: &str, width: usize| if width > 0 { format!("{word:>width$}") } else { String::new() };
        [
            format!(" {}", text::column("% of", NAME + self.bar)),
            right("scanned", SHARE),
            right("not scanned", LEFT),
            right("unreachable", self.others[0]),
            right("margin", self.others[1]),
            right("untestable", self.others[2]),
            right("area", self.area),
        ]
        .concat()
    }

    fn row(&self, name: &str, shares: &Shares) -> Parts {
        let percent = &shares.percent;
        let number = |value: f64, width: usize| match width {
            0 => String::new(),
            width => format!("{:>width$}", text::number(value, 1)),
        };
        let area = format!("{} m²", text::number(shares.area_m2, 1));
        let area = if self.area > 0 { format!("{area:>width$}", width = self.area) } else { String::new() };
        let rest = [
            number(percent.scanned, SHARE),
            number(percent.missed, LEFT),
            number(percent.unreachable, self.others[0]),
            number(percent.margin, self.others[1]),
            number(percent.untestable, self.others[2]),
            area,
        ];
        vec![
            (Role::Text, format!(" {}", text::column(name, NAME))),
            (Role::Good, text::bar(percent.scanned / 100.0, self.bar)),
            (Role::Text, rest.concat()),
        ]
    }
}

/// Which runs are combined, or why they are not.
fn of_all_runs(model: &Model) -> Option<String> {
    let live = &model.live;
    match &live.combined {
        Some(Ok(all)) => Some(format!(
            "All runs: this one and {}; map, zone, plates and missed areas are for all runs.",
            all.before()
        )),
        Some(Err(why)) => Some(format!("This run alone; the runs cannot be combined: {why}.")),
        None if !live.earlier.is_empty() => {
            Some("This run alone; combining it with the runs before it...".to_owned())
        }
        None if live.not_requested_m2() > 0.0 => {
            Some("This run alone; `tankops report FIRST SECOND` combines runs.".to_owned())
        }
        None => None,
    }
}

/// The notes below the table, as sentences.
fn notes(model: &Model, result: &RunResult) -> Vec<String> {
    let summary = &result.summary;
    let overlap = summary.coverage.as_ref().and_then(|coverage| coverage.overlap);
    let again = overlap.map(|share| {
        format!("Overlap: {} % of the scanned floor was scanned more than once.", text::percent(share))
    });
    let truth =
        summary.coverage.as_ref().and_then(|coverage| coverage.by_truth).map(|truth| {
            format!("By true position: {} % of reachable floor.", text::percent(truth.reachable))
        });
    let zone = model.live.floor().map(|floor| {
        let zone = &floor.critical_zone;
        let width_mm = text::number(1000.0 * zone.width_m, 0);
        if zone.done {
            format!("Critical zone, {width_mm} mm along the shell: done.")
        } else {
            let (done_m, length_m) = (text::number(zone.done_m, 1), text::number(zone.length_m, 1));
            format!("Critical zone, {width_mm} mm along the shell: done on {done_m} of {length_m} m.")
        }
    });
    let plates = model.live.floor().filter(|floor| !floor.plates.is_empty()).map(|floor| {
        let all = floor.plates.iter().filter(|plate| plate.shares.percent.missed <= MISSED_PERCENT).count();
        format!("At most {MISSED_PERCENT} % missed on {all} of {} plates.", floor.plates.len())
    });
    let readings = summary.readings.as_ref().map(|readings| {
        let deepest = readings.deepest.as_ref().map_or_else(String::new, |loss| {
            let (depth, error) = (text::number(loss.depth_mm, 1), text::number(loss.depth_error_mm, 1));
            let [x, y] = [loss.at.x, loss.at.y].map(|m| text::number(m, 2));
            format!("; deepest {depth} ±{error} mm at {x}, {y} m")
        });
        format!("Readings: {}; indications: {}{deepest}.", readings.count, readings.indications)
    });
    let in_doubt = model.live.in_doubt().into_iter().map(|doubt| {
        let at = doubt.at.map_or_else(String::new, |at| format!(", around {}", text::place(at)));
        model.console.keys.spelled(&format!("IN DOUBT: {}{at}. <rescan>: re-scan it.", doubt.floor))
    });
    let notes = in_doubt.chain(of_all_runs(model)).chain(zone).chain(readings).chain(plates);
    notes.chain(again).chain(truth).collect()
}
