//! The console in a pseudo terminal: the operator's view, and the restored terminal afterwards.

use crate::bench::{journal, of_kind, scenario};
use crate::session::Session;
use std::path::Path;

fn goto() -> String {
    format!("console {}", scenario("goto-single-obstacle.toml").display())
}

fn kinds(run: &Path) -> Vec<String> {
    journal(run).iter().map(|event| event["event"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn a_mission_is_flown_held_swapped_and_finished_by_hand() {
    let mut session = Session::open("console --planner apf", 120, 36);
    session.see("IDLE");
    session.start();
    session.see("▶ RUN");
    session.hold();
    session.change_planner("rpf");
    session.until("the swap in the journal", |session| {
        kinds(&session.run()).iter().filter(|kind| *kind == "planner_chosen").count() == 2
    });
    session.resume();
    session.finish();
    let listed = session.bench.tankops(&["runs", "--json"]).json();
    assert_eq!(listed[0]["end"], "complete", "{listed}");
    let verified = session.bench.tankops(&["verify", session.run().to_str().unwrap()]);
    assert_eq!(verified.code, Some(0), "{verified:?}");
}

#[test]
fn a_terminated_console_holds_closes_the_run_and_gives_the_terminal_back() {
    let mut session = Session::open(&goto(), 80, 24);
    session.start();
    session.see("RUN");
    session.signal_console(rustix::process::Signal::TERM);
    assert_eq!(session.back_in_the_shell(), "code=143");
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

#[test]
fn whatever_signal_ends_the_console_holds_closes_the_run_and_gives_the_terminal_back() {
    use rustix::process::Signal;
    for signal in [Signal::QUIT, Signal::USR1, Signal::USR2, Signal::ALARM, Signal::XCPU, Signal::POWER] {
        let mut session = Session::open(&goto(), 80, 24);
        session.start();
        session.see("RUN");
        session.signal_console(signal);
        assert_eq!(session.back_in_the_shell(), format!("code={}", 128 + signal.as_raw()), "{signal:?}");
        assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"), "{signal:?}");
        session.bench.prove(&session.run());
    }
}

#[test]
fn a_held_key_moves_nothing() {
    let mut session = Session::open(&goto(), 120, 36);
    session.start();
    session.see("RUN");
    session.hold();
    session.press(".");
    session.see("Step?");
    // The key repeats as on a keyboard: after half a second, then many times a second.
    std::thread::sleep(std::time::Duration::from_millis(500));
    for _ in 0..40 {
        session.press(".");
        std::thread::sleep(std::time::Duration::from_millis(33));
    }
    std::thread::sleep(std::time::Duration::from_millis(700));
    let steps = |session: &Session| {
        let events = journal(&session.run());
        of_kind(&events, "ordered").iter().filter(|event| event["order"] == "step").count()
    };
    assert_eq!(steps(&session), 0);
    session.agree_until("the step", |session| steps(session) == 1);
    session.press("\x1b");
    session.until("the closed line", |session| !session.text().contains("Step?"));
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=1");
}

#[test]
fn a_panic_of_the_screen_gives_the_terminal_back_and_closes_the_run() {
    let mut session = Session::open(&format!("{} --drill panic-screen", goto()), 80, 24);
    session.start();
    assert_eq!(session.back_in_the_shell(), "code=3");
    assert!(session.text().contains("the run was closed"), "{}", session.text());
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

#[test]
fn a_terminal_that_another_process_has_taken_is_taken_back_and_the_key_is_heard() {
    // A separate job, as any other process of the session might be.
    let thief = "set -m; (until [ -e steal ]; do sleep 0.1; done; trap '' TTOU; $TANKOPS take-terminal && touch stolen; \
                 sleep 100) & set +m;";
    let mut session = Session::open_after(thief, &goto(), 80, 24);
    session.start();
    session.see("RUN");
    session.bench.file("steal", "");
    session.until("the terminal to be stolen", |session| session.bench.path().join("stolen").exists());
    session.hold();
    session.press("1q");
    session.see("Enter");
    session.agree();
    assert_eq!(session.back_in_the_shell(), "code=1");
}

#[test]
fn a_closed_terminal_ends_the_console_and_closes_the_run() {
    let mut session = Session::open(&goto(), 80, 24);
    session.start();
    session.see("RUN");
    let console = session.console_pid();
    session.hang_up();
    session.until("the console to end", |_| {
        !Path::new(&format!("/proc/{console}")).exists() || is_in_state(console, 'Z')
    });
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

/// Whether a process is in the state with this letter, as in `/proc/PID/stat`.
fn is_in_state(pid: i32, state: char) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat"));
    stat.is_ok_and(|stat| stat.contains(&format!(") {state} ")))
}

#[test]
fn a_suspended_console_has_written_the_hold_before_it_stops() {
    let mut session = Session::open(&goto(), 80, 24);
    session.start();
    session.see("RUN");
    let console = session.console_pid();
    session.press("\x1a");
    session.until("the console to stop", |_| is_in_state(console, 'T'));
    let written = kinds(&session.run());
    assert!(written.iter().any(|kind| kind == "held"), "{written:?}");
    session.signal_console(rustix::process::Signal::CONT);
    session.see("HELD by operator");
    session.press("1q");
    session.see("Enter");
    session.agree();
    assert_eq!(session.back_in_the_shell(), "code=1");
}

#[test]
fn a_small_terminal_keeps_the_controls() {
    let mut session = Session::open(&goto(), 44, 10);
    session.see("Press S to start");
    session.press("S");
    // The question takes two lines here.
    session.see("Enter: start, Esc:");
    session.agree();
    session.see("RUN");
    session.press(" ");
    session.see("HOLD");
    session.press("1q");
    session.see("Enter");
    session.agree();
    assert_eq!(session.back_in_the_shell(), "code=1");
}

#[test]
fn quitting_before_the_start_leaves_no_run() {
    let mut session = Session::open("console", 100, 30);
    session.see("IDLE");
    session.press("qq");
    assert_eq!(session.back_in_the_shell(), "code=0");
    assert!(session.bench.runs().is_empty());
}

#[test]
fn keys_typed_ahead_of_a_question_do_not_answer_it() {
    let mut session = Session::open(&goto(), 120, 36);
    session.see("Press S to start");
    session.press("S\r");
    session.see("The question has just appeared; press Enter again");
    session.see("Enter: start, Esc: cancel.");
    assert!(session.bench.runs().is_empty());
    session.agree();
    session.see("▶ RUN");
    session.until("the closed notice", |session| !session.text().contains("The question has just appeared"));
    session.press("X\r");
    session.see("The question has just appeared; press Enter again");
    session.see("‖ HOLD");
    session.see("End the mission?");
    session.press("\x1b");
    session.until("the closed question", |session| !session.text().contains("End the mission?"));
    session.until("the closed notice", |session| !session.text().contains("The question has just appeared"));
    session.press(" \r");
    session.see("The question has just appeared; press Enter again");
    session.see("Resume?");
    let moved =
        |session: &Session| kinds(&session.run()).iter().any(|kind| kind == "resumed" || kind == "ended");
    assert!(!moved(&session));
    session.agree();
    session.until("the robot to move again", moved);
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=1");
}

#[test]
fn hold_is_heard_behind_whatever_the_terminal_sends() {
    let mut session = Session::open(&goto(), 120, 36);
    session.start();
    for rubbish in [
        &b"\x9d11;rgb:1234"[..],
        b"\x1b[?",
        b"\x1bP1$r",
        b"\x1b_",
        b"\xe2\x82",
        b"\xff\xfe\x80",
        b"\x1b[<0;3",
        b"\x1b[200~S\r",
    ] {
        session.see("▶ RUN");
        session.send(&[rubbish, b" "].concat());
        session.see("‖ HOLD");
        assert!(!session.text().contains("Resume?"), "{}", rubbish.escape_ascii());
        if rubbish.starts_with(b"\x1b[200~") {
            // Spaces belong to a paste until it ends.
            session.send(b"\x1b[201~");
        }
        // A space counts as a key again only after the incomplete sequence has timed out.
        session.press_until(" ", "Resume?");
        session.agree();
    }
    session.see("▶ RUN");
    session.send(b"\x1b[200~pasted \x03 text\x1b[201~");
    session.see("‖ HOLD");
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=1");
}

#[test]
fn a_command_with_a_space_in_one_burst_is_text_and_a_space_after_it_holds() {
    let mut session = Session::open(&goto(), 120, 36);
    session.start();
    session.see("▶ RUN");
    for speed in ["2", "0.5", "4", "1"] {
        session.send(format!(":speed {speed}\r").as_bytes());
        session.see(&format!("×{speed}"));
    }
    let is_held = |session: &Session| kinds(&session.run()).iter().any(|kind| kind == "held");
    assert!(!is_held(&session) && session.text().contains("▶ RUN"), "{}", session.text());
    session.send(b":speed 0.5\r ");
    session.see("‖ HOLD");
    session.until("the hold in the journal", is_held);
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=1");
}

#[test]
fn a_light_background_gets_the_light_theme_and_a_late_answer_is_no_key() {
    let answer = b"\x1b]11;rgb:fdfd/f6f6/e3e3\x1b\\";
    // The colour of text, alone or after other attributes.
    let light = b"38;2;31;35;40";
    let has =
        |session: &Session, bytes: &[u8]| session.written().windows(bytes.len()).any(|part| part == bytes);
    let mut session = Session::open(&format!("{} --colour true", goto()), 120, 36);
    // The answer waits for the question.
    session.send(answer);
    session.see("Press S to start");
    assert!(has(&session, b"\x1b]11;?") && has(&session, light), "{}", session.text());
    session.send(answer);
    session.press("4");
    session.see("No open alarms");
    session.press("1q");
    assert_eq!(session.back_in_the_shell(), "code=0");
}

#[test]
fn leaving_a_mission_prints_a_few_lines() {
    let mut session = Session::open(&goto(), 100, 36);
    session.start();
    session.see("▶ RUN");
    session.hold();
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=1");
    let text = session.text();
    let printed =
        text.lines().take_while(|line| !line.contains("SHELL-AGAIN")).filter(|line| !line.trim().is_empty());
    assert!((4..=12).contains(&printed.count()), "{text}");
    assert!(text.contains("Full report: tankops report 20"), "{text}");
}

#[test]
fn a_terminal_that_cannot_draw_is_told_what_can_be_used() {
    let bench = crate::bench::Bench::new();
    let ended = bench.tankops(&["console"]);
    assert!(ended.code == Some(2) && ended.err.contains("--plain"), "{ended:?}");
}
