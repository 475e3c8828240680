//! Writes the changed cells of a frame with few bytes, because the line to the terminal may be slow.
//!
//! The cells with the same attributes are written together, because a sequence for two colours is about five times as long
//! as one that moves the cursor. The cursor moves relative to its column, several attributes share one sequence, and a blank
//! gets only those attributes that are visible on it.

use crate::view::text;
use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};
use std::fmt::Write as _;
use std::io::{self, Write};

/// The modifiers with their codes.
const MODIFIERS: [(Modifier, u8); 9] = [
    (Modifier::BOLD, 1),
    (Modifier::DIM, 2),
    (Modifier::ITALIC, 3),
    (Modifier::UNDERLINED, 4),
    (Modifier::SLOW_BLINK, 5),
    (Modifier::RAPID_BLINK, 6),
    (Modifier::REVERSED, 7),
    (Modifier::HIDDEN, 8),
    (Modifier::CROSSED_OUT, 9),
];
/// The modifiers that are visible on a blank.
const ON_BLANK: Modifier = Modifier::UNDERLINED.union(Modifier::REVERSED).union(Modifier::CROSSED_OUT);

/// The attributes with which the terminal writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Pen {
    fg: Color,
    bg: Color,
    modifier: Modifier,
}

/// A cell with its column and row.
type Placed<'a> = (u16, u16, &'a Cell);

const PLAIN: Pen = Pen { fg: Color::Reset, bg: Color::Reset, modifier: Modifier::empty() };

/// Writes cells at their columns and rows, given the terminal's default attributes, and leaves these in place.
pub(super) fn write<'a>(to: &mut impl Write, cells: impl Iterator<Item = Placed<'a>>) -> io::Result<()> {
    let (mut at, mut pen, mut out) = (None, PLAIN, String::new());
    for (wanted, cells) in by_pen(cells) {
        for (x, y, cell) in cells {
            move_to(&mut out, at, (x, y));
            pen.change(&mut out, wanted);
            pen = wanted;
            out.push_str(cell.symbol());
            // Terminals differ in the width of unusual characters.
            at = (text::width(cell.symbol()) == 1).then_some((x + 1, y));
        }
    }
    pen.change(&mut out, PLAIN);
    to.write_all(out.as_bytes())
}

/// The cells by the attributes with which they are written; those of the first cells come first.
fn by_pen<'a>(cells: impl Iterator<Item = Placed<'a>>) -> Vec<(Pen, Vec<Placed<'a>>)> {
    let mut groups: Vec<(Pen, Vec<Placed<'a>>)> = Vec::new();
    let mut last = 0;
    for (x, y, cell) in cells {
        let fits = |(pen, _): &(Pen, _)| pen.for_cell(cell) == *pen;
        // The attributes of the cell before need no move of the cursor.
        let before = groups.get(last).is_some_and(fits).then_some(last);
        last = before.or_else(|| groups.iter().position(fits)).unwrap_or_else(|| {
            groups.push((PLAIN.for_cell(cell), Vec::new()));
            groups.len() - 1
        });
        groups[last].1.push((x, y, cell));
    }
    groups
}

/// Moves the cursor; `at` is its place if it is known.
fn move_to(out: &mut String, at: Option<(u16, u16)>, (x, y): (u16, u16)) {
    let _ = match at {
        Some(at) if at == (x, y) => Ok(()),
        Some((column, row)) if row == y && column + 1 == x => out.write_str("\x1b[C"),
        Some((column, row)) if row == y && column < x => write!(out, "\x1b[{}C", x - column),
        _ => write!(out, "\x1b[{};{}H", y + 1, x + 1),
    };
}

impl Pen {
    /// The attributes for a cell; on a blank, those that are invisible stay as they are.
    fn for_cell(self, cell: &Cell) -> Self {
        let modifier = cell.modifier;
        if cell.symbol() == " " && !(modifier | self.modifier).intersects(ON_BLANK) {
            return Self { bg: cell.bg, ..self };
        }
        Self { fg: cell.fg, bg: cell.bg, modifier }
    }

    /// Writes the sequence for a change of attributes.
    fn change(self, out: &mut String, to: Self) {
        if self == to {
            return;
        }
        if to == PLAIN {
            out.push_str("\x1b[m");
            return;
        }
        let mut codes: Vec<String> = Vec::new();
        // Modifiers are only removed all together.
        let from = if to.modifier.contains(self.modifier) { self } else { PLAIN };
        if from != self {
            codes.push("0".into());
        }
        let added =
            MODIFIERS.iter().filter(|(modifier, _)| (to.modifier - from.modifier).contains(*modifier));
        codes.extend(added.map(|(_, code)| code.to_string()));
        codes.extend((from.fg != to.fg).then(|| colour(to.fg, 3)));
        codes.extend((from.bg != to.bg).then(|| colour(to.bg, 4)));
        let _ = write!(out, "\x1b[{}m", codes.join(";"));
    }
}

/// The codes of a colour; `layer` is 3 for text and 4 for the background.
fn colour(colour: Color, layer: u8) -> String {
    let index = match colour {
        Color::Reset => return format!("{layer}9"),
        Color::Rgb(red, green, blue) => return format!("{layer}8;2;{red};{green};{blue}"),
        Color::Indexed(index) => index,
        Color::Black => 0,
        Color::Red => 1,
        Color::Green => 2,
        Color::Yellow => 3,
        Color::Blue => 4,
        Color::Magenta => 5,
        Color::Cyan => 6,
        Color::Gray => 7,
        Color::DarkGray => 8,
        Color::LightRed => 9,
        Color::LightGreen => 10,
        Color::LightYellow => 11,
        Color::LightBlue => 12,
        Color::LightMagenta => 13,
        Color::LightCyan => 14,
        Color::White => 15,
    };
    format!("{layer}8;5;{index}")
}

#[cfg(test)]
mod tests;
