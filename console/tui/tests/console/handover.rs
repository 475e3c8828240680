//! The page for the next operator, and the answer to `status`.

use crate::fixture::Screen;
use mission::{EventKind, Outcome, Severity};
use tui::model::Cause;
use tui::{Effect, Key, RunMsg, handover::page, plain};

/// A held mission with a zone, an alarm that is shelved and one that is acknowledged.
fn held() -> Screen {
    let mut screen = Screen::held();
    screen.model.console.preferences.operator = Some("lk".into());
    let event = screen.mission.zone_drawn();
    screen.hear(RunMsg::Events(vec![event]));
    screen.type_text(":shelve 15m \"pump <b>noise\" alarm=\"station S4 rejected\"");
    screen.press([Key::Enter]);
    screen.type_text(":acknowledge-all");
    screen.press([Key::Enter]);
    screen
}

#[test]
fn the_page_tells_what_goes_on_why_and_who_decided_what() {
    insta::assert_snapshot!(page(&held().model));
}

#[test]
fn the_page_is_asked_for_by_a_command_and_replaced_only_on_demand() {
    let mut screen = held();
    let page = page(&screen.model);
    for (line, overwrite) in [(":handover shift.md", false), (":handover shift.md overwrite", true)] {
        screen.type_text(line);
        let written = Effect::HandOver { file: "shift.md".into(), page: page.clone(), overwrite };
        assert_eq!(screen.press([Key::Enter]), [written]);
    }
    screen.type_text(":handover shift.md please");
    assert_eq!(screen.press([Key::Enter]), []);
    let said = screen.model.notice().unwrap().text.clone();
    assert!(said.contains("write `overwrite` after the file"), "{said}");
}

#[test]
fn what_was_acknowledged_after_the_end_is_a_decision_and_no_alarm_is_named_twice() {
    let mut screen = held();
    let (t_s, text) = (screen.model.live.run.clock.t_s, "STOP NOT CONFIRMED: odometry is missing");
    screen.model.live.run.alarms.raise(Cause::StopNotConfirmed, Severity::Crit, text.into(), t_s);
    let ended = screen.mission.ended(Outcome::Aborted, "ended by the operator");
    screen.hear(RunMsg::Events(vec![ended]));
    assert_eq!(screen.type_text("4a"), [], "nothing is recorded after the end");
    let page = page(&screen.model);
    assert!(
        page.contains("- After the end: acknowledged by lk: STOP NOT CONFIRMED: odometry is missing"),
        "{page}"
    );
    let alarm = "CRIT STOP NOT CONFIRMED, since T+00:16:07, acknowledged: odometry is missing";
    assert!(page.contains(alarm), "{page}");
}

#[test]
fn no_name_breaks_out_of_its_line() {
    let mut screen = held();
    let name = "# x\n<script>\u{1b}[31m".to_owned();
    screen.model.live.run.about.as_mut().unwrap().scenario = name;
    let page = page(&screen.model);
    assert!(!page.contains("\n<script>") && !page.contains('\u{1b}'), "{page}");
    assert!(page.contains("\\<script\\>"), "{page}");
}

#[test]
fn status_tells_state_alarms_and_the_open_question_with_commands() {
    let mut screen = held();
    screen.model.console.keys.spells_commands = true;
    screen.press([Key::Char(' ')]);
    let lines = plain::status(&screen.model);
    assert!(lines[0].starts_with("HELD by operator. `resume`: resume."), "{lines:#?}");
    assert!(lines[1].starts_with("tank-07, planner rpf, T+00:16:07, speed ×1."), "{lines:#?}");
    assert!(lines.iter().any(|line| line.starts_with("WATCH: obstacle at ")), "{lines:#?}");
    assert!(
        lines.last().unwrap().starts_with("Resume? The robot will move. `yes`: resume, `no`: cancel."),
        "{lines:#?}"
    );
    assert!(lines.iter().any(|line| line.starts_with("Position: -0.78, 7.40 m, heading ")), "{lines:#?}");
    assert_eq!(plain::no_question(&screen.model), None);
    assert!(plain::no_question(&Screen::running().model).is_some());
}

#[test]
fn a_mission_without_alarms_says_so() {
    let screen = Screen::idle();
    assert!(plain::status(&screen.model).contains(&"No alarms.".to_owned()));
    let mut ended = Screen::running();
    let event = ended.mission.ended(Outcome::Aborted, "ended by operator");
    assert!(matches!(event.kind, EventKind::Ended { .. }));
    ended.hear(RunMsg::Events(vec![event]));
    assert!(page(&ended.model).contains("ended by operator"));
}

#[test]
fn the_next_steps_of_a_held_robot_are_all_its_ways_on() {
    let page = page(&held().model);
    let next = page.split("\n## ").find(|part| part.starts_with("Next steps")).unwrap_or_default();
    for way in [
        "- Resume the task (`resume`)",
        "- Drive back and end there (`return`)",
        "- End the mission here (`end`)",
    ] {
        assert!(next.contains(way), "{way}\n{next}");
    }
    assert!(!next.contains("`resume`: resume."), "{next}");
}

#[test]
fn a_drive_back_is_listed_as_such_and_not_as_resumed() {
    let mut screen = held();
    let events = screen.mission.obeyed(mission::Order::DriveBack);
    screen.hear(RunMsg::Events(events));
    let page = page(&screen.model);
    assert!(page.contains("drive back") && !page.contains("resumed"), "{page}");
}

#[test]
fn the_page_tells_how_the_tether_lies_and_its_next_steps_are_steps() {
    let mut screen = Screen::tethered();
    let events = vec![
        screen.mission.cable(),
        screen.mission.held(mission::HoldReason::Stuck { message: "no progress".into() }),
    ];
    screen.hear(RunMsg::Events(events));
    let text = page(&screen.model);
    let section =
        |title: &str| text.split("\n## ").find(|part| part.starts_with(title)).unwrap_or_default().to_owned();
    let tether = section("Tether");
    assert!(tether.contains("- Out: ") && tether.contains("left on the reel"), "{text}");
    assert!(tether.contains("- Wrap: ") && tether.contains("- Way back along the tether: "), "{text}");
    let next = section("Next steps");
    let steps = next.lines().filter(|line| line.starts_with("- "));
    assert!(steps.clone().count() > 0 && steps.clone().all(|line| line.contains('`')), "{next}");
    assert!(section("State").contains("No progress"), "{text}");
    let torn =
        mission::event::TetherAlarm::Broken { paid_out_m: 1.6, needed_m: 5.2, by_encoder_alone: false };
    let torn = screen.mission.now(EventKind::TetherAlarmRaised { alarm: torn, reached: true });
    screen.hear(RunMsg::Events(vec![torn]));
    assert!(page(&screen.model).contains("- TORN: "), "{}", page(&screen.model));
    assert!(!page(&held().model).contains("## Tether"), "a robot without a tether has no section about it");
}
