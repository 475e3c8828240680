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
    for cell in &mut buffer.content {
        if !cell.symbol().is_ascii() {
            cell.set_char(plain(cell.symbol()));
        }
    }
}

/// The 7-bit character for a character outside ASCII.
pub(super) fn plain(symbol: &str) -> char {
    let plain = PLAIN.iter().find(|(letters, _)| letters.contains(symbol));
    plain.map_or('?', |(_, plain)| *plain)
}
