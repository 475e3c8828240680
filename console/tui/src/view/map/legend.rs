//! The legend of the map: every mark that is on the map now, beside the floor or in lines below it.

mod lines;
mod marks;

use super::ink;
use super::shade::{self, Shade, Shades};
use super::shapes::Window;
use crate::model::Screen;
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::text;
use ratatui::Frame;
use ratatui::layout::Rect;
use std::borrow::Cow;
use world::Boundary;

/// Width of a mark, columns.
const MARK: usize = 3;
/// Columns kept free beside the wall: west of it, and east of it, where the names of stations end.
const BESIDE: (f64, f64) = (1.0, 3.0);
/// Rows of the map for each line of the legend below the floor.
const ROWS_PER_LINE: u16 = 4;
/// Blanks between entries in a line.
const GAP: &str = "  ";

/// A legend entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entry {
    role: Role,
    mark: String,
    word: Cow<'static, str>,
}

impl Entry {
    fn width(&self) -> usize {
        MARK + 1 + text::width(&self.word)
    }

    fn parts(&self) -> Parts {
        vec![(self.role, text::column(&self.mark, MARK)), (Role::Dim, format!(" {}", self.word))]
    }
}

/// The place of the legend: beside the floor, with the column, the row and the entry, or in lines below it.
pub(super) struct Placed {
    beside: Vec<(u16, u16, Entry)>,
    /// The entries that are written below the floor: all of them, or none.
    pub below: Vec<Entry>,
}

impl Placed {
    /// Places all entries in one column in the west, where the map is blank, or else in the east. If they fit on neither
    /// side, all of them are written below the floor.
    pub(super) fn new(look: &Look, window: Window, entries: Vec<Entry>) -> Self {
        let blanks: Vec<(u16, u16)> = look.run.about.as_ref().map_or_else(Vec::new, |about| {
            (0..window.size.1).map(|row| blank(&about.world.boundary, window, row)).collect()
        });
        let width = entries.iter().map(Entry::width).max().unwrap_or(0) as u16;
        let west: Vec<u16> = blanks.iter().map(|(west, _)| *west).collect();
        let east: Vec<u16> = blanks.iter().map(|(_, east)| *east).collect();
        let sides = [(west, 0), (east, window.size.0.saturating_sub(width))];
        for (room, column) in sides {
            if let Some(rows) = rows_for(&entries, &room) {
                let placed = rows.into_iter().zip(entries);
                return Self {
                    beside: placed.map(|(row, entry)| (column, row, entry)).collect(),
                    below: Vec::new(),
                };
            }
        }
        Self::below(entries)
    }

    /// Places all entries in lines below the floor.
    pub(super) fn below(entries: Vec<Entry>) -> Self {
        Self { beside: Vec::new(), below: entries }
    }
}

/// The rows for the entries in a column, given the blank columns of each row; `None` if they do not all fit.
fn rows_for(entries: &[Entry], room: &[u16]) -> Option<Vec<u16>> {
    let width = entries.iter().map(Entry::width).max().unwrap_or(0);
    // The column is not torn apart: it is in the first rows that follow each other.
    let fits = |first: &usize| {
        let rows = room.get(*first..first + entries.len());
        rows.is_some_and(|rows| rows.iter().all(|room| usize::from(*room) >= width))
    };
    let first = (0..room.len()).find(fits)?;
    Some((first..first + entries.len()).map(|row| row as u16).collect())
}

/// The columns west and east of the wall in which a row of the map is blank.
fn blank(boundary: &Boundary, window: Window, row: u16) -> (u16, u16) {
    let north = window.y[1] - 2.0 * window.column_m * f64::from(row);
    let south = north - 2.0 * window.column_m;
    let (low, high) = boundary.bounds();
    let span = match boundary {
        Boundary::Circle { radius_m } => {
            let off_m = if south <= 0.0 && north >= 0.0 { 0.0 } else { south.abs().min(north.abs()) };
            let half_m = (radius_m * radius_m - off_m * off_m).max(0.0).sqrt();
            (off_m < *radius_m).then_some((-half_m, half_m))
        }
        Boundary::Polygon { .. } => (north >= low.y && south <= high.y).then_some((low.x, high.x)),
    };
    let Some((west, east)) = span else { return (window.size.0 / 2, window.size.0 / 2) };
    let columns =
        |m: f64, beside: f64| (m / window.column_m - beside).clamp(0.0, f64::from(window.size.0)) as u16;
    (columns(west - window.x[0], BESIDE.0), columns(window.x[1] - east, BESIDE.1))
}

/// The number of lines below the floor for entries.
pub(super) fn rows(below: &[Entry], area: Rect) -> u16 {
    (lines(below, usize::from(area.width)).len() as u16).min(area.height / ROWS_PER_LINE)
}

/// The entries that fit in a number of lines below the floor; if not all of them fit, the last one names the key that
/// shows the others.
pub(super) fn fitting(look: &Look, left_over: &[Entry], (rows, columns): (u16, usize)) -> Vec<Entry> {
    let fits = |entries: &[Entry]| lines(entries, columns).len() <= usize::from(rows);
    if fits(left_over) {
        return left_over.to_vec();
    }
    let shortened = |left_out: usize| {
        let more =
            Entry { role: Role::Key, mark: format!("+{left_out}"), word: look.keys("more (<help>)").into() };
        let first = left_over.iter().take(left_over.len() - left_out).cloned();
        first.chain([more]).collect::<Vec<_>>()
    };
    (1..=left_over.len()).map(shortened).find(|entries| fits(entries)).unwrap_or_default()
}

/// The whole legend, in lines of a given width.
pub(super) fn in_lines(look: &Look, window: Window, columns: usize) -> Vec<Parts> {
    lines(&entries(look, window), columns).into_iter().map(line_parts).collect()
}

/// The legend of a small map, in lines of a given width: the shades of its floor, the trail if it is drawn, and the
/// numbers of missed areas.
pub(in crate::view) fn of_floor(
    look: &Look,
    shades: Option<Shades>,
    (has_trail, n_missed): (bool, usize),
    columns: usize,
) -> Vec<Parts> {
    let floor =
        shades.into_iter().flat_map(shade::occurring).map(|(shade, word)| of_shade(shade, word.into()));
    let trail = has_trail.then(|| lines::entry(look, ink::TRAIL, "trail"));
    let numbers = (n_missed > 0).then(|| Entry {
        role: Role::Missed,
        mark: if n_missed == 1 { "1".into() } else { format!("1-{n_missed}") },
        word: "missed area".into(),
    });
    let entries: Vec<Entry> = floor.chain(trail).chain(numbers).collect();
    lines(&entries, columns).into_iter().map(line_parts).collect()
}

/// The parts of a line of entries.
fn line_parts(entries: Vec<&Entry>) -> Parts {
    let gap = || (Role::Text, GAP.to_owned());
    entries.into_iter().flat_map(|entry| entry.parts().into_iter().chain([gap()])).collect()
}

/// The entries in lines of the given width.
fn lines(entries: &[Entry], columns: usize) -> Vec<Vec<&Entry>> {
    let mut lines: Vec<(usize, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        let width = entry.width() + GAP.len();
        match lines.last_mut() {
            Some((used, line)) if *used + width <= columns => {
                *used += width;
                line.push(entry);
            }
            _ => lines.push((width, vec![entry])),
        }
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Draws the entries beside the floor.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, placed: &Placed) {
    for (column, row, entry) in &placed.beside {
        let place = Rect { x: area.x + column, y: area.y + row, width: area.width - column, height: 1 };
        frame.render_widget(look.line(entry.parts()), place);
    }
}

/// Draws the entries below the floor.
pub(super) fn draw_lines(look: &Look, frame: &mut Frame, area: Rect, left_over: &[Entry]) {
    for (entries, place) in lines(left_over, usize::from(area.width)).into_iter().zip(area.rows()) {
        frame.render_widget(look.line(line_parts(entries)), place);
    }
}

/// The entries for what the map shows now, the most important first: the classes of floor, then lines and marks.
pub(super) fn entries(look: &Look, window: Window) -> Vec<Entry> {
    let floor = shade::shown(look, window).map(|entry| of_shade(entry.0, shade::word(look, entry)));
    let lines = lines::shown(look, window).into_iter();
    // Before a re-scan, the floor that it is to scan is the blank one.
    let is_before = shade::shown(look, window).any(|(shade, _)| shade == Shade::Before);
    let blank = Entry { role: Role::Dim, mark: String::new(), word: "blank: requested".into() };
    let floor = floor.chain((is_before && look.model.ui.screen == Screen::Plan).then_some(blank));
    let marks = marks::places(look, window)
        .into_iter()
        .chain(marks::shown(look, window))
        .chain(lines::drawings(look, window));
    floor.chain(lines).chain(marks).collect()
}

fn of_shade(shade: Shade, word: Cow<'static, str>) -> Entry {
    Entry { role: shade.role(), mark: shade_mark(shade), word }
}

fn shade_mark(shade: Shade) -> String {
    shade.glyph().to_string().repeat(2)
}

#[cfg(test)]
mod tests {
    use super::lines::{LINES, RUN_B, mark};
    use super::*;
    use crate::view::ascii;
    use crate::view::map::{drawn, labels};
    use world::Point;

    #[test]
    fn a_round_tank_leaves_room_in_the_corners() {
        let window = Window::new(Point::origin(), 0.5, (60, 20));
        let tank = Boundary::Circle { radius_m: 9.0 };
        assert_eq!(blank(&tank, window, 0), (30, 30), "the first row is beyond the wall");
        let (west, east) = blank(&tank, window, 9);
        assert_eq!((west, east), (11, 9));
        assert!(blank(&tank, window, 2).0 > west);
    }

    /// The marks of the legend that can be on one map, without their colours.
    fn marks_together(difference: bool, mission: bool, has_dots: bool) -> Vec<(String, &'static str)> {
        let of_difference = |shade: Shade| matches!(shade, Shade::OnlyA | Shade::OnlyB | Shade::Both);
        let floor = shade::LEGEND.into_iter().filter(|(shade, _)| of_difference(*shade) == difference);
        let of_mission = |ink, word| match word {
            "compared" | "driven" => !mission,
            "trail" | RUN_B => mission,
            // The plan is drawn either as before the start, or as ahead of the robot.
            _ => ink != ink::PLAN,
        };
        let lines = LINES.into_iter().map(|(ink, word, _)| (ink, word));
        let lines = lines.filter(|(ink, word)| of_mission(*ink, *word));
        let drawn = drawn::KINDS.into_iter().filter(|_| mission);
        let lines = lines.chain(drawn).map(|(ink, word)| (mark(ink, word, has_dots), word));
        let fixed = marks::fixed(has_dots).map(|(mark, word)| (mark, word));
        let own =
            ["×", labels::WOUND, "◇", "t", "c", "e", labels::RESUMES].map(|mark| (mark.to_owned(), "place"));
        floor.map(|(shade, word)| (shade_mark(shade), word)).chain(lines).chain(fixed).chain(own).collect()
    }

    fn as_ascii(letter: char) -> char {
        if letter.is_ascii() { letter } else { ascii::plain(&letter.to_string()) }
    }

    #[test]
    fn what_can_be_on_one_map_has_marks_that_differ_without_colours() {
        for (difference, mission, has_dots) in [
            (false, true, true),
            (true, true, true),
            (false, false, true),
            (false, true, false),
            (false, false, false),
        ] {
            let mut all = marks_together(difference, mission, has_dots);
            if !has_dots {
                for (mark, _) in &mut all {
                    *mark = mark.chars().map(as_ascii).collect();
                }
            }
            all.sort_unstable();
            let same = all.windows(2).find(|pair| pair[0].0 == pair[1].0);
            assert_eq!(same, None, "{all:?}");
        }
    }

    #[test]
    fn entries_fill_lines_and_none_is_cut() {
        let entry = |word| Entry { role: Role::Dim, mark: "▒▒".into(), word: Cow::from(word) };
        let entries = ["scanned", "partial", "missed"].map(entry);
        let columns: Vec<usize> = lines(&entries, 30).iter().map(Vec::len).collect();
        assert_eq!(columns, [2, 1]);
    }
}
