//! Parses the lines of a script.

use super::{Condition, Step};
use tui::{
    Key,
    actions::{duration_s, keymap::Keymap},
};

/// The default time limit of a wait, in seconds.
const WITHIN_S: f64 = 60.0;

/// A value with its line number.
type Numbered<T> = (usize, T);

/// Parses a script into its steps with their line numbers.
///
/// # Errors
/// Each invalid line with its number and the problem.
pub(super) fn steps(text: &str, keys: &Keymap) -> Result<Vec<Numbered<Step>>, Vec<Numbered<String>>> {
    // Some editors begin a text with a byte order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (mut steps, mut wrong) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        match step(line, keys) {
            Ok(step) => steps.push((number, step)),
            Err(what) => wrong.push((number, what)),
        }
    }
    if wrong.is_empty() { Ok(steps) } else { Err(wrong) }
}

fn step(line: &str, keys: &Keymap) -> Result<Step, String> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let rest = rest.trim();
    match word {
        "wait" => wait(rest.strip_prefix("until ").ok_or("write `wait until CONDITION [within DURATION]`")?),
        "assert" => Condition::read(rest).map(Step::Assert),
        "key" => Key::named(rest).map(Step::Key).ok_or_else(|| format!("unknown key `{rest}`")),
        "size" => size(rest).map(Step::Size),
        "picture" if rest.is_empty() => Err("write `picture FILE.svg`".into()),
        "picture" => Ok(Step::Picture(rest.into())),
        _ => tui::check_line(keys, line).map(|()| Step::Command(line.to_owned())),
    }
}

/// Parses columns and rows, such as `120x36`.
fn size(text: &str) -> Result<(u16, u16), String> {
    let size =
        text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    let is_screen = |(width, height): &(u16, u16)| (20..=300).contains(width) && (5..=100).contains(height);
    size.filter(is_screen).ok_or_else(|| format!("invalid size `{text}`; write 20x5 to 300x100"))
}

fn wait(text: &str) -> Result<Step, String> {
    let (condition, within_s) = match text.rsplit_once(" within ") {
        Some((condition, duration)) => (condition, duration_s(duration.trim())?),
        None => (text, WITHIN_S),
    };
    Ok(Step::Wait(Condition::read(condition.trim())?, within_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_line_is_read() {
        let text = "# a comment\n\nspeed max\n  key enter\nwait until not phase running within 2m\n\
                    wait until text \"position lost\"\nassert coverage >= 95.5\nassert alarm\nassert screen result\nsize 80x24\npicture a b.svg\n";
        let condition = |text| Condition::read(text).expect("a condition");
        let expected = vec![
            (3, Step::Command("speed max".into())),
            (4, Step::Key(Key::Enter)),
            (5, Step::Wait(condition("not phase running"), 120.0)),
            (6, Step::Wait(condition("text \"position lost\""), WITHIN_S)),
            (7, Step::Assert(condition("coverage >= 95.5"))),
            (8, Step::Assert(condition("alarm"))),
            (9, Step::Assert(condition("screen result"))),
            (10, Step::Size((80, 24))),
            (11, Step::Picture("a b.svg".into())),
        ];
        assert_eq!(steps(text, &Keymap::default()), Ok(expected));
    }

    #[test]
    fn every_wrong_line_is_named() {
        let text = "wait for it\nassert phase walking\nkey hyper\nwait until alarm within soon\nassert coverage 95\nsize 9x9\npicture\n\
                    bogus command\nspeed fast\nset gain\ninject S1 dead\nhold it\n";
        let wrong = steps(text, &Keymap::default()).expect_err("faults");
        let lines: Vec<usize> = wrong.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], "{wrong:?}");
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_the_first_line() {
        let begins = |text| steps(text, &Keymap::default());
        assert_eq!(begins("\u{feff}speed max\n"), Ok(vec![(1, Step::Command("speed max".into()))]));
    }

    #[test]
    fn a_wait_that_no_clock_can_count_is_refused_when_it_is_read() {
        let text = "speed max\nwait until phase ended within 10000000000000000000000s\n";
        let wrong = steps(text, &Keymap::default()).expect_err("too long");
        let line = "duration `10000000000000000000000s` is too long; at most 1000h";
        assert_eq!(wrong, [(2, line.to_owned())]);
        assert!(steps("wait until phase ended within 1000h\n", &Keymap::default()).is_ok());
    }

    #[test]
    fn what_only_the_run_decides_is_left_to_it() {
        let text = "planner mine\nset gain=2\nexclude S9\nopen tank\nverify latest\nshelve 15m noise\nstop\n";
        let mut keys = Keymap::default();
        keys.aliases.insert("stop".to_owned(), "hold".to_owned());
        assert_eq!(steps(text, &keys).map(|steps| steps.len()), Ok(7));
        assert_eq!(steps("stop now\n", &keys).map_err(|wrong| wrong[0].0), Err(1));
    }
}
