use super::*;
use proptest::prelude::*;

fn decoded(bytes: &[u8]) -> Vec<Input> {
    let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
    decoder.feed(bytes, &mut inputs);
    inputs
}

fn keys(keys: &[Key]) -> Vec<Input> {
    keys.iter().map(|key| Input::Key((*key).into())).collect()
}

/// Whether the decoded inputs stop the robot.
fn stops(inputs: &[Input]) -> bool {
    let space = Input::Key(Key::Char(' ').into());
    inputs.iter().any(|input| *input == space || *input == Input::Stop)
}

#[test]
fn every_key_of_common_terminals_is_known() {
    for (bytes, key) in [
        ("S", Key::Char('S')),
        (" ", Key::Char(' ')),
        ("é", Key::Char('é')),
        ("\u{1f600}", Key::Char('\u{1f600}')),
        ("\r", Key::Enter),
        ("\n", Key::Ctrl('j')),
        ("\t", Key::Tab),
        ("\x7f", Key::Backspace),
        ("\x03", Key::Ctrl('c')),
        ("\x1a", Key::Ctrl('z')),
        ("\x1b[A", Key::Up),
        ("\x1bOB", Key::Down),
        ("\x1b[1;5D", Key::CtrlLeft),
        ("\x1b[1;5C", Key::CtrlRight),
        ("\x1b[1;2C", Key::Right),
        ("\x1b[Z", Key::BackTab),
        ("\x1b[3~", Key::Delete),
        ("\x1b[5~", Key::PageUp),
        ("\x1b[H", Key::Home),
        ("\x1b[4~", Key::End),
        ("\x1bOP", Key::F(1)),
        ("\x1b[[E", Key::F(5)),
        ("\x1b[15~", Key::F(5)),
        ("\x1b[21~", Key::F(10)),
        ("\x1b[24~", Key::F(12)),
        ("\x1b[97;5u", Key::Ctrl('a')),
        ("\x1b[27;5;99~", Key::Ctrl('c')),
    ] {
        assert_eq!(decoded(bytes.as_bytes()), keys(&[key]), "{bytes:?}");
    }
}

#[test]
fn alt_and_a_key_count_as_esc_alone() {
    // Esc followed by a key arrives like this over a slow connection, and must cancel an open question.
    for bytes in ["\x1bS", "\x1bk", "\x1bé", "\x1b\r"] {
        assert_eq!(decoded(bytes.as_bytes()), keys(&[Key::Esc]), "{bytes:?}");
    }
    assert_eq!(decoded(b"\x1bk\r"), keys(&[Key::Esc, Key::Enter]));
    assert!(stops(&decoded(b"\x1b ")));
}

#[test]
fn a_paste_outlasts_a_connection_that_stalls() {
    let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
    decoder.feed(b"\x1b[200~first line", &mut inputs);
    assert!(decoder.patience() >= Some(Duration::from_secs(2)));
}

#[test]
fn releases_and_unknown_keys_are_no_keys() {
    for bytes in ["\x1b[1;3A", "\x1b[97;1:3u", "\x1b[2~", "\x1bOz"] {
        assert_eq!(decoded(bytes.as_bytes()), [Input::OtherKey], "{bytes:?}");
    }
    let repeat = KeyPress { repeat: true, ..Key::Char('a').into() };
    assert_eq!(decoded(b"\x1b[97;1:2u"), [Input::Key(repeat)]);
}

#[test]
fn what_a_terminal_answers_is_swallowed_up_to_the_next_key() {
    for bytes in [
        &b"\x1b]52;c;UyBY\x07"[..],
        b"\x1b]10;rgb:ffff/ffff/ffff\x1b\\",
        b"\x9d10;S\x9c",
        b"\x9d4;\xc3\x9cS\x9c",
        b"\x1bP1$r0m\x1b\\",
        b"\x90>|xterm(390)\x9c",
        b"\x1b_S\x1b\\",
        b"\x1b^S\x1b\\",
        b"\x1bXS\x1b\\",
        b"\x1b[?62;22c",
        b"\x9b?62;22c",
        b"\x1b[?2026;2$y",
        b"\x1b[12;40R",
        b"\x1b[I",
        b"\x1b[O",
        b"\xc2\x9d10;S\x07",
        b"\x80\xff\xfe\xc0",
    ] {
        let mut heard = decoded(&[bytes, b"p"].concat());
        heard.retain(|input| !matches!(input, Input::OtherKey | Input::Kind));
        assert_eq!(heard, keys(&[Key::Char('p')]), "{}", bytes.escape_ascii());
    }
}

#[test]
fn a_sequence_that_breaks_off_ends_when_nothing_follows() {
    for (bytes, left) in [
        (&b"\x1b"[..], keys(&[Key::Esc])),
        (b"\x1b[?", vec![]),
        (b"\x1b[1;5", vec![]),
        (b"\x9d11;rgb:", vec![]),
        (b"\x1bP", vec![]),
        (b"\xe2\x82", vec![]),
        (b"\x1b[200~:set ", vec![Input::Stop, Input::Paste(":set ".into())]),
    ] {
        let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
        decoder.feed(bytes, &mut inputs);
        assert!(decoder.patience().is_some(), "{}", bytes.escape_ascii());
        decoder.give_up(&mut inputs);
        assert_eq!((inputs, decoder.patience()), (left, None), "{}", bytes.escape_ascii());
    }
}

#[test]
fn a_paste_is_one_text_and_neither_its_letters_nor_its_lines_are_keys() {
    let pasted = decoded(b"\x1b[200~S\r\x1b[2Jx\x1b[201~q");
    assert_eq!(pasted, [vec![Input::Paste("S\r\x1b[2Jx".into())], keys(&[Key::Char('q')])].concat());
}

#[test]
fn ctrl_c_within_a_paste_or_an_answer_is_still_a_key() {
    for bytes in
        [&b"\x1b[200~ab\x03cd\x1b[201~"[..], b"\x1b]11;\x03", b"\x1b[?\x03", b"\xe2\x03", b"\x1b\x03"]
    {
        assert!(decoded(bytes).contains(&Input::Key(Key::Ctrl('c').into())), "{}", bytes.escape_ascii());
    }
}

#[test]
fn the_mouse_is_read_in_any_size() {
    let at = |gesture| vec![Input::Mouse(Pointed { column: 299, row: 0, gesture })];
    assert_eq!(decoded(b"\x1b[<0;300;1M"), at(Gesture::Down));
    assert_eq!(decoded(b"\x1b[<32;300;1M"), at(Gesture::Drag));
    assert_eq!(decoded(b"\x1b[<0;300;1m"), at(Gesture::Up));
    assert_eq!(decoded(b"\x1b[<64;300;1M"), at(Gesture::Wheel { up: true }));
    assert_eq!(decoded(b"\x1b[<65;300;1M"), at(Gesture::Wheel { up: false }));
    for other in [&b"\x1b[<2;3;1M"[..], b"\x1b[<0;0;0M", b"\x1b[<0;99999;1M", b"\x1b[<0;3M"] {
        assert_eq!(decoded(other), [], "{}", other.escape_ascii());
    }
    assert_eq!(decoded(b"\x1b[M!!!q"), keys(&[Key::Char('q')]), "a report of the old kind");
}

#[test]
fn the_background_is_read_from_every_form_of_the_answer() {
    for (answer, colour) in [
        ("\x1b]11;rgb:ffff/8080/0000\x1b\\", Some([255, 128, 0])),
        ("\x1b]11;rgb:ff/80/00\x07", Some([255, 128, 0])),
        ("\x1b]11;rgba:ffff/ffff/ffff/ffff\x07", Some([255; 3])),
        ("\x1b]11;#1e1e2e\x07", Some([0x1e, 0x1e, 0x2e])),
        ("\x1b]10;rgb:ff/80/00\x07", None),
        ("\x1b]11;rgb:ff/80\x07", None),
        ("\x1b]11;rgb:fffff/0/0\x07", None),
        ("\x1bP11;rgb:ff/80/00\x1b\\", None),
    ] {
        let inputs = decoded(answer.as_bytes());
        assert_eq!(inputs, colour.map(Input::Background).into_iter().collect::<Vec<_>>(), "{answer:?}");
    }
}

/// Bytes with many beginnings and ends of sequences.
fn hostile() -> impl Strategy<Value = Vec<u8>> {
    let part = prop_oneof![
        any::<u8>().prop_map(|byte| vec![byte]),
        prop::sample::select(vec![
            "\x1b",
            "\x1b[",
            "\x1b[?",
            "\x1b[<",
            "\x1b[M",
            "\x1b]11;",
            "\x1bP",
            "\x1bO",
            "\x1b[200~",
            "\x1b[201~",
            "\x1b\\",
            "\x07",
            "\x03",
            "é",
            "\u{9d}",
            " ",
            ";",
            "0",
            "~"
        ])
        .prop_map(|text| text.as_bytes().to_vec()),
    ];
    prop::collection::vec(part, 0..60).prop_map(|parts| parts.concat())
}

proptest! {
    #[test]
    fn a_space_stops_the_robot_whatever_came_before(bytes in hostile()) {
        let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
        decoder.feed(&bytes, &mut inputs);
        let mut after = Vec::new();
        decoder.feed(b" ", &mut after);
        prop_assert!(stops(&after), "{inputs:?} {after:?}");
        decoder.feed(&bytes, &mut inputs);
        decoder.give_up(&mut inputs);
        let mut key = Vec::new();
        decoder.feed(b" ", &mut key);
        prop_assert_eq!(key, keys(&[Key::Char(' ')]), "once a sequence has broken off, a space is a key again");
    }

    #[test]
    fn ctrl_c_is_a_key_whatever_came_before(bytes in hostile()) {
        let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
        decoder.feed(&bytes, &mut inputs);
        inputs.clear();
        decoder.feed(b"\x03", &mut inputs);
        prop_assert_eq!(inputs, keys(&[Key::Ctrl('c')]));
    }

    #[test]
    fn the_division_of_the_stream_does_not_matter(bytes in hostile(), at in any::<prop::sample::Index>()) {
        let (mut decoder, mut inputs) = (Decoder::default(), Vec::new());
        let (one, other) = bytes.split_at(at.index(bytes.len() + 1));
        decoder.feed(one, &mut inputs);
        decoder.feed(other, &mut inputs);
        prop_assert_eq!(inputs, decoded(&bytes));
    }

    #[test]
    fn nothing_is_kept_without_a_limit(
        begin in prop::sample::select(vec![&b"\x1b]"[..], b"\x1b[", b"\x1b[200~", b"\x1bP", b"\x9b?"]),
        filler in prop::sample::select(vec![b'1', b';', b'/']),
    ) {
        let mut decoder = Decoder::default();
        let mut inputs = Vec::new();
        decoder.feed(begin, &mut inputs);
        decoder.feed(&vec![filler; 2 * LONGEST_PASTE], &mut inputs);
        let kept = match &decoder.state {
            State::Paste { text, .. } => text.len(),
            State::String(string) => string.kept(),
            State::Csi(csi) => csi.kept(),
            other => panic!("the sequence has ended: {other:?}"),
        };
        prop_assert!(kept <= LONGEST_PASTE && inputs.is_empty(), "{kept} {inputs:?}");
    }
}
