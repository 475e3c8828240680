//! The plates with their shares and the accuracy of the position on each, most missed first.

use super::next_page;
use crate::model::{Model, Pane};
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::{table, text};
use account::{Account, PlateAccount};
use ratatui::Frame;
use ratatui::layout::Rect;
use world::beside_limit;

/// Width of the names, columns.
const NAME: usize = 10;

/// A column of the table.
struct Column {
    head: &'static str,
    width: usize,
    /// Narrow tables leave out the columns with the highest ranks.
    rank: u8,
    cell: fn(&PlateAccount) -> String,
    /// Whether a value is marked, given the limit of the 95 % error, metres.
    warns: fn(&PlateAccount, f64) -> bool,
}

const fn column(head: &'static str, width: usize, rank: u8, cell: fn(&PlateAccount) -> String) -> Column {
    Column { head, width, rank, cell, warns: |_, _| false }
}

/// The columns after the name. The last two need the true position.
const COLUMNS: [Column; 7] = [
    column("area", 9, 6, |plate| format!("{} m²", text::number(plate.shares.area_m2, 1))),
    column("scanned", 8, 4, |plate| percent(plate.shares.percent.scanned)),
    Column {
        warns: |plate, _| plate.shares.percent.missed > 0.0,
        ..column("missed", 8, 0, |plate| percent(plate.shares.percent.missed))
    },
    column("error p95", 10, 5, |plate| metres(plate.error_p95_m)),
    Column {
        warns: |plate, limit_m| plate.error_max_m.is_some_and(|m| m > limit_m),
        ..column("err. worst", 11, 3, |plate| metres(plate.error_max_m))
    },
    column(TRUE_P95, 9, 2, |plate| metres(plate.true_error_p95_m)),
    column(TRUE_WORST, 11, 1, |plate| metres(plate.true_error_max_m)),
];
const TRUE_P95: &str = "true p95";
const TRUE_WORST: &str = "true worst";

/// The columns that fit.
fn columns(room: usize, has_truth: bool) -> Vec<&'static Column> {
    let is_known = |column: &&Column| has_truth || ![TRUE_P95, TRUE_WORST].contains(&column.head);
    let mut shown: Vec<&Column> = COLUMNS.iter().filter(is_known).collect();
    let width = |shown: &[&Column]| NAME + shown.iter().map(|column| column.width).sum::<usize>();
    while shown.len() > 1 && width(&shown) > room {
        let last = (0..shown.len()).max_by_key(|index| shown[*index].rank).unwrap_or_default();
        shown.remove(last);
    }
    shown
}

fn percent(percent: f64) -> String {
    format!("{} %", text::number(percent, 1))
}

fn metres(m: Option<f64>) -> String {
    m.map_or_else(|| "-".into(), |m| format!("{} m", text::number(m, 3)))
}

/// The plates of the result; the selected one is marked if the arrow keys apply to the list.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let has_focus = look.model.ui.pane == Pane::Plates;
    let floor = look.model.live.floor();
    let Some(floor) = floor.filter(|floor| !floor.plates.is_empty()) else {
        let why = if floor.is_some() {
            " The scenario has no plates.".to_owned()
        } else {
            format!(" {}", super::floor::no_scan(look.model))
        };
        let block = look.pane(Pane::Plates, "Plates", &next_page(look));
        return fill(frame, area, block, vec![look.line([(Role::Dim, why)])]);
    };
    list(look, frame, area, floor, has_focus.then_some(look.model.ui.plate));
}

/// The plates of a floor, as many as fit.
pub(in crate::view) fn list(
    look: &Look,
    frame: &mut Frame,
    area: Rect,
    floor: &Account,
    selected: Option<usize>,
) {
    let mut plates: Vec<&PlateAccount> = floor.plates.iter().collect();
    plates.sort_by(|one, other| other.shares.missed.total_cmp(&one.shares.missed));
    let selected = selected.map(|index| index.min(plates.len().saturating_sub(1)));
    let inner = look.pane(Pane::Plates, "", "").inner(area);
    let (room, height) = (usize::from(inner.width), usize::from(inner.height).saturating_sub(1));
    let shown = table::window(selected.unwrap_or(0), plates.len(), height);
    let note = next_page(look);
    let counted = format!("Plates  {}", table::counted(&shown, plates.len()));
    let limit = text::number(floor.position_limit_m, 2);
    let titles = [
        format!("{counted}, most missed first; limit of the 95 % error {limit} m"),
        format!("{counted}, most missed first"),
        counted,
    ];
    let taken = text::width(&note) + text::width(&look.pane_key(Pane::Plates)) + 8;
    let title = text::wording(titles, usize::from(area.width).saturating_sub(taken));
    let has_truth = plates.iter().any(|plate| plate.true_error_max_m.is_some());
    let columns = columns(room.saturating_sub(1), has_truth);
    let rows: Vec<Parts> = plates.iter().map(|plate| row(plate, &columns, floor.position_limit_m)).collect();
    let heads = columns.iter().map(|column| format!("{:>width$}", column.head, width = column.width));
    let head = format!(" {}{}", text::column("plate", NAME), heads.collect::<String>());
    let mut lines = vec![look.line([(Role::Dim, head)])];
    lines.extend(table::rows(look, rows, selected, (room, height)));
    fill(frame, area, look.pane(Pane::Plates, &title, &note), lines);
}

/// The plate on which the position was least accurate, in one line; `None` if no plate has a figure.
pub(super) fn worst(model: &Model, columns: usize) -> Option<Parts> {
    let floor = model.live.floor()?;
    let figures = floor.plates.iter().filter_map(|plate| Some((plate.error_max_m?, plate)));
    let (error_m, plate) = figures.max_by(|one, other| one.0.total_cmp(&other.0))?;
    let limit_m = floor.position_limit_m;
    let (role, mark) = if error_m > limit_m { (Role::Warn, "!") } else { (Role::Text, "") };
    let [error, limit] = beside_limit(error_m, limit_m, 2);
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

/// The plate with the largest true error, as the end of a sentence; `None` if no plate has a figure.
pub(super) fn worst_true(model: &Model) -> Option<String> {
    let figures = model
        .live
        .floor()?
        .plates
        .iter()
        .filter_map(|plate| Some((plate.true_error_max_m?, plate.true_error_p95_m?, &plate.name)));
    let (worst_m, p95_m, name) = figures.max_by(|one, other| one.0.total_cmp(&other.0))?;
    let [p95, worst] = [p95_m, worst_m].map(|m| text::number(m, 3));
    Some(format!("largest on plate {name}: p95 {p95}, worst {worst} m"))
}

fn row(plate: &PlateAccount, columns: &[&Column], limit_m: f64) -> Parts {
    let cell = |column: &&Column| {
        let role = if (column.warns)(plate, limit_m) { Role::Warn } else { Role::Text };
        (role, format!("{:>width$}", (column.cell)(plate), width = column.width))
    };
    let name = (Role::Text, text::column(&plate.name, NAME));
    std::iter::once(name).chain(columns.iter().map(cell)).collect()
}
