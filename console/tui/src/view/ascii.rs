//! Reduces the screen to 7-bit characters, for terminals that have no others.

use ratatui::buffer::Buffer;

/// The replacements.
const PLAIN: &[(&str, char)] = &[
    ("│┊", '|'),
    ("┌┐└┘├┤┼●▅▆", '+'),
    ("─▃▄", '-'),
    ("▶▸→↗", '>'),
    ("←↙", '<'),
    ("↑↖", '^'),
    ("↓↘✓", 'v'),
    ("‖", '='),
    ("■█", '#'),
    ("✗×", 'x'),
    ("±", '~'),
    ("Ø", 'D'),
    ("²", '2'),
    ("…·▁▂", '.'),
    ("◦", '"'),
    ("⋅", ')'),
    ("◇", '@'),
    ("▇◎", '*'),
    ("░", ':'),
    ("▒", '%'),
    ("▚", '&'),
    ("▓", '!'),
    ("╌", '-'),
    ("◌", '~'),
    ("°", 'd'),
];

/// Replaces every character outside ASCII; a question mark where there is no better replacement.
pub(super) fn reduce(buffer: &mut Buffer) {
    lengthen_ellipses(buffer);
    lengthen_errors(buffer);
    for cell in &mut buffer.content {
        if !cell.symbol().is_ascii() {
            cell.set_char(plain(cell.symbol()));
        }
    }
}

/// Writes an ellipsis as two full stops where there is room: one would look like the end of a sentence.
fn lengthen_ellipses(buffer: &mut Buffer) {
    let width = usize::from(buffer.area.width);
    for next in (1..buffer.content.len()).filter(|next| next % width.max(1) != 0) {
        if buffer.content[next - 1].symbol() == "…" && buffer.content[next].symbol() == " " {
            let style = buffer.content[next - 1].style();
            buffer.content[next].set_char('.').set_style(style);
        }
    }
}

/// Writes a plus-minus sign as two characters where a blank is before it: one would look like the word "about" or like the
/// tether.
fn lengthen_errors(buffer: &mut Buffer) {
    let width = usize::from(buffer.area.width);
    for at in (1..buffer.content.len()).filter(|at| at % width.max(1) != 0) {
        if buffer.content[at].symbol() == "±" && buffer.content[at - 1].symbol() == " " {
            let style = buffer.content[at].style();
            buffer.content[at - 1].set_char('+').set_style(style);
            buffer.content[at].set_char('-');
        }
    }
}

/// The 7-bit character for a character outside ASCII.
pub(super) fn plain(symbol: &str) -> char {
    let plain = PLAIN.iter().find(|(letters, _)| letters.contains(symbol));
    plain.map_or('?', |(_, plain)| *plain)
}
