//! Trouble with a real vehicle: its alarm, what the screen says about it, and when it clears.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use crate::state_line::{hear, link, live, state};
use mission::{EventKind, HoldReason, Resumes};
use tui::model::Cause;
use vehicle::port::{LinkSeen, LinkState, Notice};

fn is_active(screen: &Screen, cause: &Cause) -> bool {
    screen.model.live.run.alarms.get(cause).is_some_and(tui::model::Alarm::is_active)
}

/// The alarm screen at 200x60, which shows cause, effect and message of the first alarm.
fn alarms(screen: &mut Screen) -> String {
    screen.send(tui::Msg::Resize { width: 200, height: 60 });
    screen.type_text("4");
    text(&drawn(&screen.model, RICH, (200, 60)))
}

/// A hold by trouble with the vehicle.
fn held_by(screen: &mut Screen, link: LinkSeen) {
    let message = link.trouble().expect("trouble");
    let held = EventKind::Held { by: HoldReason::Vehicle { message }, resumes: Resumes::Never };
    hear(
        screen,
        [EventKind::Link(link), held, EventKind::Stood { confirmed: true, after_s: 0.2, moved: false }],
    );
}

#[test]
fn another_vehicle_is_named_with_its_differences_and_cannot_be_driven() {
    let mut screen = live();
    let vehicle = Box::new(vehicle::port::VehicleInfo { name: "crawler-2".into(), ..Default::default() });
    let differs = vec!["hull radius 0.20 m instead of 0.25 m".to_owned()];
    hear(&mut screen, [EventKind::Noticed(Notice::OtherVehicle { vehicle, differs: differs.clone() })]);
    let why = differs[0].clone();
    held_by(&mut screen, LinkSeen { state: LinkState::OtherVehicle, why, ..LinkSeen::default() });
    let line = state(&screen);
    assert!(line.starts_with("HELD: another vehicle answers; robot at "), "{line}");
    assert!(line.contains("No resume: only a new run drives it."), "{line}");
    assert!(is_active(&screen, &Cause::Vehicle));
    let shown = alarms(&mut screen);
    assert!(shown.contains("another vehicle, crawler-2, answers on the same connection"), "{shown}");
    assert!(shown.contains("hull radius 0.20 m instead of 0.25 m"), "{shown}");
}

#[test]
fn faulty_messages_stay_an_alarm_until_a_report_of_the_link_counts_no_more_of_them() {
    let mut screen = live();
    let seen = |faulty| EventKind::Link(LinkSeen { faulty, heard: 900, ..LinkSeen::default() });
    let notice = Notice::FaultyMessages {
        count: 3,
        first: "readings.seq: not a number".into(),
        last: "readings.contact: missing".into(),
    };
    hear(&mut screen, [EventKind::Noticed(notice), seen(3)]);
    assert!(is_active(&screen, &Cause::FaultyMessages), "the count has just risen");
    let shown = alarms(&mut screen);
    assert!(
        shown.contains("readings.seq: not a number") && shown.contains("readings.contact: missing"),
        "{shown}"
    );
    hear(&mut screen, [seen(5)]);
    assert!(is_active(&screen, &Cause::FaultyMessages));
    hear(&mut screen, [seen(5)]);
    assert!(!is_active(&screen, &Cause::FaultyMessages));
}

#[test]
fn a_clock_at_a_wrong_rate_is_an_alarm_until_the_rate_is_right() {
    let mut screen = live();
    let rate = |rate, is_off| {
        EventKind::Noticed(Notice::ClockRate { field: "readings.stamp_s".into(), rate, is_off })
    };
    hear(&mut screen, [rate(1.2, true)]);
    assert!(is_active(&screen, &Cause::VehicleClock));
    let shown = alarms(&mut screen);
    assert!(shown.contains("1.200 s in each second") && shown.contains("readings.stamp_s"), "{shown}");
    hear(&mut screen, [rate(1.0, false)]);
    assert!(!is_active(&screen, &Cause::VehicleClock));
}

#[test]
fn a_console_that_was_stopped_holds_the_robot_and_resumes_only_by_order() {
    let mut screen = live();
    let why = "it sent no commands for 4.0 s".to_owned();
    held_by(
        &mut screen,
        LinkSeen { state: LinkState::ConsoleStopped, why, console_stopped_s: 4.0, ..LinkSeen::default() },
    );
    let line = state(&screen);
    assert!(line.starts_with("HELD: console was stopped") && line.contains("Cannot resume yet."), "{line}");
    assert!(is_active(&screen, &Cause::ConsoleStopped));
    assert!(alarms(&mut screen).contains("it sent no commands for 4.0 s"));
    hear(&mut screen, [link(LinkState::Up, "")]);
    assert!(!is_active(&screen, &Cause::ConsoleStopped));
    let line = state(&screen);
    assert!(line.contains("space: resume."), "{line}");
}
