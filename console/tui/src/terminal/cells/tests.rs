use super::*;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

const SIZE: (u16, u16) = (12, 4);

/// What a terminal shows after the bytes: for each cell, the symbol and the codes in force.
fn shown(bytes: &str) -> Vec<(char, Vec<String>)> {
    let columns = usize::from(SIZE.0);
    let mut cells = vec![(' ', Vec::new()); columns * usize::from(SIZE.1)];
    let (mut at, mut codes, mut rest) = (0, Vec::new(), bytes);
    while let Some(first) = rest.chars().next() {
        let Some(sequence) = rest.strip_prefix("\x1b[") else {
            cells[at] = (first, codes.clone());
            (at, rest) = (at + 1, &rest[first.len_utf8()..]);
            continue;
        };
        let end = sequence.find(|c: char| c.is_ascii_alphabetic()).expect("an end");
        let (arguments, last) = (&sequence[..end], &sequence[end..=end]);
        let numbers: Vec<usize> = arguments.split(';').map(|n| n.parse().unwrap_or(0)).collect();
        match last {
            "H" => at = (numbers[0] - 1) * columns + numbers[1] - 1,
            "C" => at += numbers[0].max(1),
            _ => apply(&mut codes, arguments),
        }
        rest = &sequence[end + 1..];
    }
    assert!(codes.is_empty(), "the default attributes are in place at the end: {codes:?}");
    cells
}

/// Applies the codes of a sequence to those in force.
fn apply(codes: &mut Vec<String>, arguments: &str) {
    let mut numbers = arguments.split(';').peekable();
    while let Some(number) = numbers.next() {
        let layer = number.chars().next().filter(|_| number.len() == 2);
        match number {
            "" | "0" => codes.clear(),
            "38" | "48" => {
                let n = if numbers.peek() == Some(&"2") { 4 } else { 2 };
                let colour: Vec<&str> = numbers.by_ref().take(n).collect();
                codes.retain(|code| !(code.len() > 1 && code.starts_with(&number[..1])));
                codes.push(format!("{number};{}", colour.join(";")));
            }
            "39" | "49" => codes.retain(|code| !(code.len() > 1 && code.chars().next() == layer)),
            modifier => codes.push(modifier.into()),
        }
    }
    codes.sort();
    codes.dedup();
}

/// What a cell should show.
fn expected(cell: &Cell) -> (char, Vec<String>) {
    let modifiers = MODIFIERS.iter().filter(|(modifier, _)| cell.modifier.contains(*modifier));
    let mut codes: Vec<String> = modifiers.map(|(_, code)| code.to_string()).collect();
    codes.extend((cell.fg != Color::Reset).then(|| colour(cell.fg, 3)));
    codes.extend((cell.bg != Color::Reset).then(|| colour(cell.bg, 4)));
    codes.sort();
    (cell.symbol().chars().next().expect("a symbol"), codes)
}

/// The part of the codes that is visible on a blank.
fn visible((symbol, codes): (char, Vec<String>)) -> (char, Vec<String>) {
    let is_plain = !codes.iter().any(|code| ["4", "7", "9"].contains(&code.as_str()));
    let is_background = |code: &String| code.starts_with("48");
    match symbol {
        ' ' if is_plain => (symbol, codes.into_iter().filter(is_background).collect()),
        _ => (symbol, codes),
    }
}

fn cell() -> impl Strategy<Value = Cell> {
    let colours = [Color::Reset, Color::Red, Color::White, Color::Indexed(99), Color::Rgb(1, 2, 3)];
    let colour = prop::sample::select(colours.to_vec());
    let symbol = prop::sample::select(vec![" ", "a", "⠤", "▒"]);
    let modifiers = [
        Modifier::empty(),
        Modifier::BOLD,
        Modifier::DIM,
        Modifier::REVERSED,
        Modifier::BOLD | Modifier::REVERSED,
    ];
    let modifier = prop::sample::select(modifiers.to_vec());
    (symbol, colour.clone(), colour, modifier).prop_map(|(symbol, fg, bg, modifier)| {
        let mut cell = Cell::default();
        cell.set_symbol(symbol).set_style(Style::new().fg(fg).bg(bg).add_modifier(modifier));
        cell
    })
}

fn written<'a>(cells: impl Iterator<Item = (u16, u16, &'a Cell)>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes, cells).expect("memory");
    String::from_utf8(bytes).expect("text")
}

proptest! {
    #[test]
    fn the_terminal_shows_the_cells(cells in prop::collection::vec(prop::option::of(cell()), 48)) {
        let place = |index: usize| (index as u16 % SIZE.0, index as u16 / SIZE.0);
        let changed = cells.iter().enumerate();
        let changed = changed.filter_map(|(index, cell)| Some((place(index).0, place(index).1, cell.as_ref()?)));
        let after = shown(&written(changed));
        for (cell, after) in cells.iter().zip(after).filter_map(|(cell, after)| Some((cell.as_ref()?, after))) {
            prop_assert_eq!(visible(after), visible(expected(cell)));
        }
    }
}

#[test]
fn a_line_with_gaps_and_blanks_costs_few_bytes() {
    let mut buffer = Buffer::empty(Rect::new(0, 0, SIZE.0, SIZE.1));
    let style = Style::new().fg(Color::Rgb(214, 175, 95));
    for (x, symbol) in [(1, "a"), (2, "b"), (5, "c"), (7, "d")] {
        buffer.set_string(x, 2, symbol, style);
    }
    let cells = [1, 2, 3, 5, 7].map(|x| (x, 2, &buffer[(x, 2)]));
    assert_eq!(written(cells.into_iter()), "\x1b[3;2H\x1b[38;2;214;175;95mab \x1b[Cc\x1b[Cd\x1b[m");
}

#[test]
fn each_pair_of_colours_is_named_once_a_frame() {
    let mut buffer = Buffer::empty(Rect::new(0, 0, SIZE.0, SIZE.1));
    let colours = [Color::Rgb(214, 175, 95), Color::Rgb(95, 175, 214)];
    let places: Vec<(u16, u16)> = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))).collect();
    for (x, y) in &places {
        buffer.set_string(*x, *y, "▀", Style::new().fg(colours[usize::from((x + y) % 2)]));
    }
    let bytes = written(places.iter().map(|(x, y)| (*x, *y, &buffer[(*x, *y)])));
    for colour in ["38;2;214;175;95", "38;2;95;175;214"] {
        assert_eq!(bytes.matches(colour).count(), 1, "{bytes:?}");
    }
    let after = shown(&bytes);
    for ((x, y), after) in places.iter().zip(after) {
        assert_eq!(visible(after), visible(expected(&buffer[(*x, *y)])));
    }
}

#[test]
fn a_wide_character_is_followed_by_an_absolute_move() {
    let mut cells = [Cell::default(), Cell::default()];
    cells[0].set_symbol("漢");
    cells[1].set_symbol("a");
    let placed = [(0, 0, &cells[0]), (2, 0, &cells[1])];
    assert_eq!(written(placed.into_iter()), "\x1b[1;1H漢\x1b[1;3Ha");
}
