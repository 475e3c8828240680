//! Seven bits for terminals that have no more.

use ratatui::buffer::Buffer;

/// What stands for what.
const PLAIN: &[(&str, char)] = &[
    ("│", '|'),
    ("┌┐└┘├┤┼●▅▆", '+'),
    ("─▃▄", '-'),
    ("▶→↗", '>'),
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
    ("▇", '*'),
    ("░", ':'),
    ("▒", '%'),
    ("▚", '&'),
    ("▓", '!'),
    ("╌", '-'),
    ("◌", '~'),
    ("°", 'd'),
];

/// Puts a plain character in the place of each one that is not; a question mark where nothing else fits.
pub(super) fn reduce(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if !cell.symbol().is_ascii() {
            let plain = PLAIN.iter().find(|(letters, _)| letters.contains(cell.symbol()));
            cell.set_char(plain.map_or('?', |(_, plain)| *plain));
        }
    }
}
