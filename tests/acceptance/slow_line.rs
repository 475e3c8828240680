//! A line to the terminal that takes 2 kB/s, without any sign that it is slow.

use crate::{bench::scenario, session::Session};

/// What the line takes in a second, bytes.
const SECOND: usize = 2_000;
/// Bytes after which the console has noticed that the line is slow and has emptied the queue in front of it.
const SETTLED: usize = 60_000;

#[test]
fn hold_is_seen_after_less_than_a_second_of_bytes_on_a_slow_line() {
    let path = scenario("cover-circle.toml");
    let mut session = Session::open(&format!("console {}", path.display()), 120, 36);
    session.start();
    session.see("▶ RUN");
    session.press(">>");
    session.slow_down();
    let from = session.written().len();
    session.until("60 kB", |session| session.written().len() > from + SETTLED);
    let before = session.written().len();
    session.press(" ");
    session.see("‖ HOLD");
    let bytes = session.written().len() - before;
    assert!(bytes < SECOND, "HOLD was seen after {bytes} bytes");
}
