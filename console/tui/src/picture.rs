//! Renders a screen as an SVG drawing for documents.

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use std::fmt::Write;

/// Width and height of a cell, pixels.
const CELL: (f64, f64) = (8.4, 18.0);
/// The height of the text baseline above the bottom of the cell, pixels.
const FOOT: f64 = 5.0;
/// Text and background colours of a dark terminal.
const TEXT: &str = "#d8dee4";
const GROUND: &str = "#14181d";
/// The sixteen terminal colours as most terminals show them on a dark background.
const SIXTEEN: [&str; 16] = [
    "#14181d", "#e06c6c", "#6cc070", "#e0b040", "#5c9bd8", "#c678c8", "#5cc8d8", "#d8dee4", "#8b98a5",
    "#ff8a80", "#8fe08f", "#ffd75f", "#82cdeb", "#f0a0f0", "#8fe8f0", "#ffffff",
];

/// The look of a run of cells.
#[derive(Debug, Clone, PartialEq)]
struct Look {
    text: String,
    ground: String,
    bold: bool,
    dim: bool,
}

/// Renders the screen as an SVG document, which takes about 100 bytes for each word and for each run of cells that
/// look alike.
pub fn svg(screen: &Buffer) -> String {
    let (width, height) = (f64::from(screen.area.width) * CELL.0, f64::from(screen.area.height) * CELL.1);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" font-family=\"'DejaVu Sans Mono', \
         Menlo, Consolas, monospace\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"{GROUND}\"/>\n"
    );
    for (row, cells) in screen.content.chunks(usize::from(screen.area.width).max(1)).enumerate() {
        let mut column = 0;
        for run in cells.chunk_by(|one, other| look(one) == look(other)) {
            draw(&mut svg, run, (column, row));
            column += run.len();
        }
    }
    svg.push_str("</svg>\n");
    svg
}

fn draw(svg: &mut String, run: &[Cell], (column, row): (usize, usize)) {
    let look = look(&run[0]);
    let (x, y, width) = (column as f64 * CELL.0, row as f64 * CELL.1, run.len() as f64 * CELL.0);
    // Writing to a String cannot fail.
    if look.ground != GROUND {
        let Look { ground, .. } = &look;
        let _ = writeln!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{:.1}\" fill=\"{ground}\"/>",
            CELL.1
        );
    }
    let weight = if look.bold { " font-weight=\"bold\"" } else { "" };
    let opacity = if look.dim { " opacity=\"0.65\"" } else { "" };
    let y = y + CELL.1 - FOOT;
    let mut column = column;
    // Draw word by word: a viewer that stretches text to a given length stretches spaces and letters differently.
    for word in run.chunk_by(|one, other| is_blank(one) == is_blank(other)) {
        let (x, width) = (column as f64 * CELL.0, word.len() as f64 * CELL.0);
        column += word.len();
        if is_blank(&word[0]) {
            continue;
        }
        let text: String = word.iter().map(Cell::symbol).collect();
        let _ = writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" textLength=\"{width:.1}\" lengthAdjust=\"spacingAndGlyphs\" \
             fill=\"{}\"{weight}{opacity}>{}</text>",
            look.text,
            foreign::markup(&text)
        );
    }
}

fn is_blank(cell: &Cell) -> bool {
    cell.symbol().trim().is_empty()
}

fn look(cell: &Cell) -> Look {
    let (mut text, mut ground) = (colour(cell.fg, TEXT), colour(cell.bg, GROUND));
    if cell.modifier.contains(Modifier::REVERSED) {
        std::mem::swap(&mut text, &mut ground);
    }
    let has = |modifier| cell.modifier.contains(modifier);
    Look { text, ground, bold: has(Modifier::BOLD), dim: has(Modifier::DIM) }
}

fn colour(colour: Color, unset: &str) -> String {
    let named = |index: usize| SIXTEEN[index].to_owned();
    match colour {
        Color::Reset => unset.to_owned(),
        Color::Rgb(red, green, blue) => format!("#{red:02x}{green:02x}{blue:02x}"),
        Color::Indexed(index) => indexed(index),
        Color::Black => named(0),
        Color::Red => named(1),
        Color::Green => named(2),
        Color::Yellow => named(3),
        Color::Blue => named(4),
        Color::Magenta => named(5),
        Color::Cyan => named(6),
        Color::Gray => named(7),
        Color::DarkGray => named(8),
        Color::LightRed => named(9),
        Color::LightGreen => named(10),
        Color::LightYellow => named(11),
        Color::LightBlue => named(12),
        Color::LightMagenta => named(13),
        Color::LightCyan => named(14),
        Color::White => named(15),
    }
}

/// A colour of the 256-colour palette: sixteen terminal colours, a 6x6x6 cube, and 24 greys.
fn indexed(index: u8) -> String {
    let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * u32::from(step) };
    match index {
        0..16 => SIXTEEN[usize::from(index)].to_owned(),
        16..232 => {
            let cube = index - 16;
            format!("#{:02x}{:02x}{:02x}", level(cube / 36), level(cube / 6 % 6), level(cube % 6))
        }
        grey => {
            let level = 8 + 10 * u32::from(grey - 232);
            format!("#{level:02x}{level:02x}{level:02x}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::{layout::Rect, style::Style};

    #[test]
    fn each_word_is_a_piece_of_text_at_its_place_and_what_is_markup_is_escaped() {
        let mut screen = Buffer::empty(Rect::new(0, 0, 8, 2));
        screen.set_string(0, 0, "a < b", Style::new());
        screen.set_string(0, 1, "CRIT", Style::new().fg(Color::Red).add_modifier(Modifier::REVERSED));
        let svg = svg(&screen);
        assert!(svg.contains("<text x=\"16.8\"") && svg.contains(">&lt;</text>"), "{svg}");
        assert!(svg.contains("fill=\"#e06c6c\"/>") && svg.contains(">CRIT</text>"), "{svg}");
        assert_eq!(svg.matches("<text").count(), 4);
    }

    #[test]
    fn the_palette_of_256_has_its_corners() {
        let corners = [16, 231, 232, 255, 196].map(indexed);
        assert_eq!(corners, ["#000000", "#ffffff", "#080808", "#eeeeee", "#ff0000"]);
    }
}
