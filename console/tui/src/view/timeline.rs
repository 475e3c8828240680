//! The timeline of a replay: the current moment, and the marks before and after it.

use super::look::Look;
use super::text;
use crate::caps::Glyphs;
use crate::model::replay::{Mark, MarkKind, Other, Reel, Shares};
use crate::model::ui::Arrangement;
use crate::model::{Replay, Run};
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// Width of a clock time and a blank, columns.
const CLOCK: usize = 9;

/// Draws the timeline at the bottom of an area; returns the remaining area.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) -> Rect {
    let Some(replay) = &look.model.live.replay else { return area };
    let is_framed = arrangement == Arrangement::Wide;
    let lines = lines(look, replay, usize::from(area.width) - if is_framed { 2 } else { 0 }, is_framed);
    let rows = lines.len() as u16 + if is_framed { 2 } else { 0 };
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    if is_framed {
        let block = look.block(Role::Border, &format!("Timeline  {}", title(look, replay)), LEGEND);
        super::look::fill(frame, below, block, lines);
    } else {
        frame.render_widget(Paragraph::new(lines), below);
    }
    above
}

const LEGEND: &str = "· event  ▲ hold  ! alarm  ● bookmark  ┃ now";

fn title(look: &Look, replay: &Replay) -> String {
    // A short journal is read completely before its first frame is shown.
    let is_whole = replay.reel.is_whole && !look.model.live.is_opening;
    match (is_whole, &replay.other) {
        (false, _) => format!("loading {} %", percent(&replay.reel)),
        (true, None) => "all loaded".into(),
        (true, Some(other)) if !other.reel.is_whole => {
            format!("B loading {} %", percent(&other.reel))
        }
        (true, Some(_)) => format!("A and B aligned by {}", replay.align.word()),
    }
}

fn percent(reel: &Reel) -> u32 {
    (100.0 * reel.share).floor().clamp(0.0, 99.0) as u32
}

fn lines(look: &Look, replay: &Replay, columns: usize, is_framed: bool) -> Vec<Line<'static>> {
    let bookmarks: Vec<f64> = replay.bookmarks().collect();
    let mut lines = vec![bar(look, ("A", &replay.reel, &look.model.live.run), &bookmarks, columns)];
    if let Some(other) = &replay.other {
        lines.push(bar(look, ("B", &other.reel, &other.run), &[], columns));
        lines.push(beside(look, replay, other, columns));
    }
    if is_framed {
        lines.push(here(look, replay, columns));
    }
    lines
}

/// The bar of a run, from its beginning to the end of what is loaded.
fn bar(
    look: &Look,
    (name, reel, run): (&str, &Reel, &Run),
    bookmarks: &[f64],
    columns: usize,
) -> Line<'static> {
    let room = columns.saturating_sub(3 + 2 * CLOCK + 1);
    let mut cells = vec![(Role::Border, '─'); room];
    let column = |t_s: f64| {
        let share = if reel.until_s > 0.0 { (t_s / reel.until_s).clamp(0.0, 1.0) } else { 0.0 };
        (share * room.saturating_sub(1) as f64).round() as usize
    };
    let mut ranks = vec![0_u8; room];
    let marks = reel.marks.iter().map(|mark| (mark.t_s, rank(mark), shown(mark)));
    let people = bookmarks.iter().map(|t_s| (*t_s, 8, (Role::Title, '●')));
    for (t_s, rank, cell) in marks.chain(people) {
        let at = column(t_s);
        if ranks.get(at).is_some_and(|before| *before < rank) {
            (ranks[at], cells[at]) = (rank, cell);
        }
    }
    let now = column(run.clock.t_s);
    if let Some(cell) = cells.get_mut(now) {
        *cell = (Role::Confirm, if look.caps.glyphs == Glyphs::Ascii { '|' } else { '┃' });
    }
    let mut parts =
        vec![(Role::Title, format!(" {name} ")), (Role::Text, format!("{} ", text::clock(run.clock.t_s)))];
    parts.extend(cells.into_iter().map(|(role, letter)| (role, letter.to_string())));
    parts.push((Role::Dim, format!(" {}", text::clock(reel.until_s))));
    look.line(parts)
}

/// The rank of a mark among those at the same place.
fn rank(mark: &Mark) -> u8 {
    match (mark.kind, mark.severity) {
        (MarkKind::Event, Severity::Info) => 1,
        (MarkKind::Event, _) => 2,
        (MarkKind::Hold, _) => 3,
        (MarkKind::Alarm, severity) => 4 + severity as u8,
    }
}

fn shown(mark: &Mark) -> (Role, char) {
    match mark.kind {
        MarkKind::Event => (Role::Dim, '·'),
        MarkKind::Hold => (Role::Hold, '▲'),
        MarkKind::Alarm => (super::events::role(mark.severity), '!'),
    }
}

/// The difference between the two runs at this moment.
fn beside(look: &Look, replay: &Replay, other: &Other, columns: usize) -> Line<'static> {
    let rasters = look.model.live.run.coverage.as_ref().zip(other.run.coverage.as_ref());
    let Some((a, b)) = rasters else {
        return look.line([(Role::Dim, format!(" B {} is being loaded", other.name))]);
    };
    let Shares { only_a, only_b, both } = look.cache.borrow_mut().shares(a, b);
    let [a, b, both] = [only_a, only_b, both].map(text::percent);
    let (is_wide, align) = (columns >= 100, replay.align.word());
    let (head, foot) = if is_wide {
        (" Scanned up to here, % of reachable floor: ", format!("   (aligned by {align})"))
    } else {
        (" % of reachable: ", format!(" by {align}"))
    };
    // The colours match those on the map; but the colour of floor scanned by both is too dark for
    // text.
    let roles = if replay.shows_difference { [Role::Good, Role::Ghost, Role::Text] } else { [Role::Text; 3] };
    let words = [format!("only A {a}, "), format!("only B {b}, "), format!("both {both}")];
    let parts = roles.into_iter().zip(words);
    look.line([(Role::Dim, head.to_owned())].into_iter().chain(parts).chain([(Role::Dim, foot)]))
}

/// The bookmark at this moment; if there is none, the last log line.
fn here(look: &Look, replay: &Replay, columns: usize) -> Line<'static> {
    let run = &look.model.live.run;
    if let Some(bookmark) = replay.notes.bookmark(run.clock.t_s) {
        let words = format!(" ● {}", bookmark.text);
        return look.line([(Role::Title, text::fit(&words, columns))]);
    }
    let last = run.log.newest().and_then(|number| run.log.get(number));
    let words = last.map_or_else(String::new, |entry| format!(" last event: {}", entry.line()));
    look.line([(Role::Dim, text::fit(&words, columns))])
}
