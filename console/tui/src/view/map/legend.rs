//! The legend of the map: every mark that is on the map now, beside the floor or in lines below it.

use super::course::{self, Course};
use super::ink::{self, Ink};
use super::pattern::braille;
use super::shade::{self, Shade};
use super::shapes::Window;
use super::{drawn, labels, plates, scan};
use crate::model::{Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::text;
use planner_api::Drawing;
use ratatui::Frame;
use ratatui::layout::Rect;
use std::borrow::Cow;
use world::{Boundary, Point, ZoneKind};

/// Width of a mark, columns.
const MARK: usize = 3;
/// Columns kept free beside the wall: west of it, and east of it, where the names of stations end.
const BESIDE: (f64, f64) = (1.0, 3.0);
/// Rows of the map for each line of the legend below the floor.
const ROWS_PER_LINE: u16 = 5;
/// The entries on each side of the floor fill at most one row in this number of rows.
const SHARE: u16 = 3;
/// The trail of the run with which a replay is compared.
const RUN_B: &str = "run B";
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

/// The places of the entries beside the floor (column, row and index), and the entries that have no place there.
pub(super) struct Placed {
    beside: Vec<(u16, u16, Entry)>,
    /// The entries that do not fit beside the floor.
    pub left_over: Vec<Entry>,
}

impl Placed {
    /// Places the classes of floor in the west and the marks in the east, from the north, where the map is blank.
    pub(super) fn new(look: &Look, window: Window, (floor, marks): &(Vec<Entry>, Vec<Entry>)) -> Self {
        let blanks: Vec<(u16, u16)> = look.run.about.as_ref().map_or_else(Vec::new, |about| {
            (0..window.size.1).map(|row| blank(&about.world.boundary, window, row)).collect()
        });
        let (mut next, mut free) = ([0, 0], [usize::from(window.size.1 / SHARE); 2]);
        let (mut beside, mut left_over) = (Vec::new(), Vec::new());
        let wanted = floor.iter().map(|entry| (0, entry)).chain(marks.iter().map(|entry| (1, entry)));
        for (side, entry) in wanted {
            let room =
                |side: usize, row: usize| usize::from(if side == 0 { blanks[row].0 } else { blanks[row].1 });
            let place = [side, 1 - side].into_iter().filter(|side| free[*side] > 0).find_map(|side| {
                let row = (next[side]..blanks.len()).find(|row| room(side, *row) >= entry.width())?;
                Some((side, row))
            });
            let Some((side, row)) = place else {
                left_over.push(entry.clone());
                continue;
            };
            (next[side], free[side]) = (row + 1, free[side] - 1);
            let column = if side == 0 { 0 } else { window.size.0 - entry.width() as u16 };
            beside.push((column, row as u16, entry.clone()));
        }
        // The marks in the east begin in the same column.
        let east = beside.iter().filter(|(column, ..)| *column > 0).map(|(column, ..)| *column).min();
        for (column, row, entry) in beside.iter_mut().filter(|(column, ..)| *column > 0) {
            let first = window.size.0 - blanks[usize::from(*row)].1;
            *column = east.unwrap_or(*column).max(first).min(window.size.0 - entry.width() as u16);
        }
        Self { beside, left_over }
    }
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

/// The number of lines below the floor for entries that do not fit beside it.
pub(super) fn rows(left_over: &[Entry], area: Rect) -> u16 {
    (lines(left_over, usize::from(area.width)).len() as u16).min(area.height / ROWS_PER_LINE)
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
            Entry { role: Role::Key, mark: look.keys("<help>"), word: format!("{left_out} more").into() };
        let first = left_over.iter().take(left_over.len() - left_out).cloned();
        first.chain([more]).collect::<Vec<_>>()
    };
    (1..=left_over.len()).map(shortened).find(|entries| fits(entries)).unwrap_or_default()
}

/// The whole legend, in lines of a given width.
pub(super) fn in_lines(look: &Look, window: Window, columns: usize) -> Vec<Parts> {
    let (floor, marks) = entries(look, window);
    let entries: Vec<Entry> = floor.into_iter().chain(marks).collect();
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

/// The entries for what the map shows now, the most important first: the classes of floor; and lines and marks.
pub(super) fn entries(look: &Look, window: Window) -> (Vec<Entry>, Vec<Entry>) {
    let entry = |(shade, word): (Shade, &'static str)| Entry {
        role: shade.role(),
        mark: shade_mark(shade),
        word: word.into(),
    };
    let floor = shade::shown(look, window).map(entry).collect();
    let lines = lines_shown(look, window).into_iter();
    let marks = places(look, window).into_iter().chain(marks(look, window)).chain(drawings(look, window));
    (floor, lines.chain(marks).collect())
}

fn shade_mark(shade: Shade) -> String {
    shade.glyph().to_string().repeat(2)
}

/// Whether a kind of line is drawn.
type IsDrawn = fn(&Look, Option<&Course>) -> bool;

/// The kinds of lines, the most important first, each with its legend text.
const LINES: [(Ink, &str, IsDrawn); 11] = [
    (ink::LEG, "this leg", |_, course| course.is_some_and(|course| course.leg.0 < course.leg.1)),
    (ink::PLAN, "plan", |look, course| is_ahead(look, course, ink::PLAN)),
    (ink::AHEAD, "plan", |look, course| is_ahead(look, course, ink::AHEAD)),
    (ink::WAY, "way between", |look, course| {
        course.is_some_and(|course| course::parts(look, course).iter().any(|part| part.1))
    }),
    (ink::OFFER, "better plan", |look, _| course::offer(look).is_some()),
    (ink::OTHER, "compared", |look, _| course::compared(look).is_some()),
    (ink::TETHER, "tether", |look, _| {
        let line = look.run.tether.as_ref().map(|tether| &tether.line);
        line.is_some_and(|line| line.windows(2).any(|pair| pair[0] != pair[1]))
    }),
    (ink::TRAIL, "trail", |look, _| course::shows_trail(look)),
    (ink::OTHER, RUN_B, |look, _| {
        let has_other = look.model.live.replay.as_ref().is_some_and(|replay| replay.other.is_some());
        has_other && look.model.ui.screen == Screen::Mission
    }),
    (ink::SHADOW, "shadow", |look, _| look.run.shown_shadow().is_some()),
    (ink::DRIVEN, "driven", |look, course| {
        look.model.ui.screen == Screen::Plan && course.is_some_and(|course| course.driven.0 < course.driven.1)
    }),
];

/// Whether the plan ahead is drawn, with the given ink.
fn is_ahead(look: &Look, course: Option<&Course>, ink: Ink) -> bool {
    course::plan_ink(look) == ink && course.is_some_and(|course| course.ahead.0 < course.ahead.1)
}

/// The sample of a kind of line.
fn line_mark(ink: Ink, word: &str, has_dots: bool) -> String {
    match labels::Arrow::of(ink) {
        _ if !has_dots => ink.letter.to_string().repeat(2),
        // The trail of a run has no arrows.
        Some(arrow) if word != RUN_B => format!("{}{arrow}", ink.pattern.sample(MARK as u16 - 1)),
        _ => ink.pattern.sample(MARK as u16),
    }
}

fn line_entry(look: &Look, ink: Ink, word: &'static str) -> Entry {
    Entry { role: ink.role, mark: line_mark(ink, word, look.caps.glyphs.has_dots()), word: word.into() }
}

/// The lines that are drawn.
fn lines_shown(look: &Look, window: Window) -> Vec<Entry> {
    let course = course::course(look);
    let every = course::thinnings(look, window)[0].every;
    let lines = LINES.into_iter().filter(|(.., is_drawn)| is_drawn(look, course.as_ref()));
    let entry = |(ink, word, _): (Ink, &'static str, IsDrawn)| {
        let entry = line_entry(look, ink, word);
        let is_thinned = every > 1 && matches!(ink, ink::PLAN | ink::AHEAD);
        if is_thinned { Entry { word: format!("{word}, 1 lane in {every}").into(), ..entry } } else { entry }
    };
    lines.map(entry).collect()
}

/// The planner's drawings that are large enough to be seen in the window.
fn drawings(look: &Look, window: Window) -> Vec<Entry> {
    let is_seen = |drawing: &&Drawing| {
        let points = drawn::points(drawing);
        let is_long = points.iter().any(|point| (point - points[0]).norm() >= window.column_m);
        is_long && points.iter().any(|point| window.cell_of(*point).is_some())
    };
    let seen: Vec<Ink> = drawn::shown(look).iter().filter(is_seen).map(drawn::ink).collect();
    let kinds = drawn::KINDS.into_iter().filter(|(ink, _)| seen.contains(ink));
    kinds.map(|(ink, word)| line_entry(look, ink, word)).collect()
}

/// The samples of areas: a no-go zone and the outline of a plate.
fn fixed_marks(has_dots: bool) -> [(String, &'static str); 2] {
    let hatched = if has_dots { braille(2, |x, y| (x + y).is_multiple_of(4)) } else { "xx".into() };
    let outline = if has_dots { braille(3, |x, y| y == 2 && x.is_multiple_of(2)) } else { "``".into() };
    [(hatched, "no-go zone"), (outline, "plate")]
}

/// The marks that are drawn.
fn marks(look: &Look, window: Window) -> Vec<Entry> {
    let (run, ui) = (look.run, &look.model.ui);
    let Some(about) = &run.about else { return Vec::new() };
    let seen = |at: Point| window.cell_of(at).is_some();
    let [hatched, outline] = fixed_marks(look.caps.glyphs.has_dots()).map(|(mark, _)| mark);
    let obstacle = |known: bool| {
        about.world.obstacles.iter().any(|obstacle| obstacle.known == known && seen(obstacle.shape.center()))
    };
    let no_go = about.world.zones.iter().any(|zone| zone.kind == ZoneKind::NoGo && seen(zone.shape.center()));
    let station = ui.layers.shows(MapLayer::Stations)
        && about.world.stations.iter().any(|station| seen(station.position));
    let target = run.progress.as_ref().is_some_and(|progress| !run.has_ended() && seen(progress.target));
    let wound = labels::wound(look).is_some_and(seen);
    let change_over = course::change_over(look).is_some_and(seen);
    let marks = [
        (no_go, Role::NoGo, hatched, "no-go zone"),
        (obstacle(false), Role::Found, "?".to_owned(), "found"),
        (obstacle(true), Role::Obstacle, "#".into(), "obstacle"),
        (target, Role::Target, "×".into(), "target"),
        (!scan::shown(look).is_empty(), Role::Watch, scan::mark(look), "scan"),
        (wound, Role::Tether, labels::WOUND.into(), "largest wrap"),
        (change_over, Role::Watch, "◇".into(), "change-over"),
        (station, Role::Station, stations(look), "station"),
        (plates::plates(look, window).is_some(), Role::Plate, outline, "plate"),
    ];
    let marks = marks.into_iter().filter(|(shown, ..)| *shown);
    marks.map(|(_, role, mark, word)| Entry { role, mark, word: word.into() }).collect()
}

/// The first and the last name of the stations.
fn stations(look: &Look) -> String {
    let names: Vec<&str> = look.run.stations().iter().map(|station| station.name.as_str()).collect();
    match names.as_slice() {
        [first, .., last] if text::width(first) == 1 && text::width(last) == 1 => format!("{first}-{last}"),
        [first, ..] if text::width(first) <= MARK => (*first).to_owned(),
        _ => "S".into(),
    }
}

/// The places of the estimate, on the plan screen.
fn places(look: &Look, window: Window) -> Vec<Entry> {
    let on_plan = look.model.ui.screen == Screen::Plan;
    let places = look.model.live.promised().into_iter().filter(|_| on_plan).flat_map(labels::worst_places);
    let seen = places.filter(|(_, at)| window.cell_of(*at).is_some());
    let word = |letter: &str| match letter {
        "t" => "longest tether",
        "c" => "smallest gap",
        "e" => "AE error",
        _ => "wrap",
    };
    let entries =
        seen.map(|(letter, _)| Entry { role: Role::Watch, mark: letter.into(), word: word(letter).into() });
    let left_out = look.model.left_out_at().filter(|_| on_plan).map(|_| Entry {
        role: Role::Selected,
        mark: "◎".into(),
        word: "left out".into(),
    });
    let resumption = look.model.live.left_out().filter(|_| on_plan).and_then(|left_out| left_out.resumption);
    let resumes = resumption.map(|_| Entry {
        role: Role::Title,
        mark: labels::RESUMES.into(),
        word: "scan resumes".into(),
    });
    left_out.into_iter().chain(resumes).chain(entries).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::ascii;

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
        let lines = lines.chain(drawn).map(|(ink, word)| (line_mark(ink, word, has_dots), word));
        let marks = fixed_marks(has_dots).map(|(mark, word)| (mark, word));
        let own =
            ["×", labels::WOUND, "◇", "t", "c", "e", labels::RESUMES].map(|mark| (mark.to_owned(), "place"));
        floor.map(|(shade, word)| (shade_mark(shade), word)).chain(lines).chain(marks).chain(own).collect()
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
