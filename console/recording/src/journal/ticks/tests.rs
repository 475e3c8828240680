use super::*;
use mission::{AskId, Outcome, WorkerId};
use planner_api::{Command, Status};

fn event(kind: EventKind) -> Event {
    Event { tick: 3, t_s: 0.3, kind }
}

/// An order and the planner's answer to a step.
fn events() -> Vec<Event> {
    let ask = Some(AskId { worker: WorkerId(1), n: 4 });
    let command = Command::still(Status::Waiting);
    vec![
        event(EventKind::Ordered { order: Order::Hold }),
        event(EventKind::Commanded { ask, command, asked: None }),
    ]
}

fn recorded(events: &[Event], is_cut: bool) -> RecordedTick {
    let line = |event: &Event| (serde_json::to_vec(event).expect("an event can be written"), event.clone());
    RecordedTick { tick: 3, lines: events.iter().map(line).collect(), is_cut }
}

fn difference(recorded: &RecordedTick, computed: &[Event]) -> Option<Difference> {
    recorded.difference(computed).expect("events can be written")
}

#[test]
fn a_tick_that_is_computed_again_has_no_difference_and_gives_its_orders() {
    let tick = recorded(&events(), false);
    assert_eq!(difference(&tick, &events()), None);
    assert_eq!((tick.n_compared(), tick.orders()), (2, vec![Order::Hold]));
}

#[test]
fn white_space_is_a_difference() {
    let mut tick = recorded(&events(), false);
    tick.lines[1].0.push(b' ');
    let found = difference(&tick, &events()).expect("a line differs");
    assert_eq!(found.recorded, format!("{} ", found.computed));
}

#[test]
fn a_line_more_or_less_is_a_difference() {
    let (tick, mut computed) = (recorded(&events(), false), events());
    let last = computed.pop();
    let found = difference(&tick, &computed).expect("a line is missing");
    assert_eq!(found.computed, "nothing more in this tick");
    computed.extend(last);
    computed.push(event(EventKind::Resumed));
    let found = difference(&tick, &computed).expect("a line is too much");
    assert_eq!((found.tick, found.recorded.as_str()), (3, "nothing more in this tick"));
}

#[test]
fn of_a_tick_that_is_cut_off_only_what_comes_before_all_answers_is_compared() {
    let mut computed = events();
    computed.push(event(EventKind::Ended { outcome: Outcome::Aborted, reason: "later".into() }));
    let tick = recorded(&events(), true);
    assert_eq!((tick.n_compared(), difference(&tick, &computed)), (1, None));
    computed[0] = event(EventKind::Ordered { order: Order::Abort });
    assert!(difference(&tick, &computed).is_some());
}
