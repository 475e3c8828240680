//! Seven bits for terminals that have no more.

use ratatui::buffer::Buffer;

/// Puts a plain character in the place of each one that is not.
pub(super) fn reduce(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if !cell.symbol().is_ascii() {
            let plain = cell.symbol().chars().next().map_or(' ', plain);
            cell.set_char(plain);
        }
    }
}

fn plain(letter: char) -> char {
    match letter {
        '─' => '-',
        '│' => '|',
        '┌' | '┐' | '└' | '┘' | '├' | '┤' => '+',
        '▶' | '→' | '≥' | '↗' => '>',
        '←' | '↙' => '<',
        '↑' | '↖' => '^',
        '↓' | '↘' => 'v',
        '‖' => '=',
        '■' | '█' => '#',
        '✓' => 'v',
        '✗' | '×' => 'x',
        '●' => 'o',
        '◌' => '?',
        '±' => '~',
        'Ø' => 'D',
        '²' => '2',
        '…' | '·' | '▁' | '▂' => '.',
        '▃' | '▄' => '-',
        '▅' | '▆' => '+',
        '▇' => '*',
        '░' => ':',
        '▒' => '%',
        '°' => 'd',
        _ => '?',
    }
}
