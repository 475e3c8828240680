//! Tests of the life cycle of alarms.

use super::{rule::Rule, *};
use mission::{
    Note, Noted,
    Severity::{self, Crit, Info, Warn, Watch},
};

const CAUSE: Cause = Cause::PositionLost;

fn raised(severity: Severity) -> Alarms {
    let mut alarms = Alarms::default();
    alarms.raise(CAUSE, severity, "position lost".into(), 1.0);
    alarms
}

fn note(what: Noted) -> Note {
    Note { what, by: Some("lk".into()) }
}

/// The operator acknowledges an alarm with its current text.
fn acknowledge_one(alarms: &mut Alarms, cause: &Cause) {
    let text = alarms.get(cause).map(|alarm| alarm.text.clone()).unwrap_or_default();
    alarms.take(&note(Noted::Acknowledged { alarm: cause.key(), text }), 5.0);
}

/// The operator acknowledges the most urgent alarm; returns its text.
fn acknowledge(alarms: &mut Alarms) -> Option<String> {
    let (cause, text) =
        alarms.worst_unacknowledged().map(|alarm| (alarm.cause.clone(), alarm.text.clone()))?;
    acknowledge_one(alarms, &cause);
    Some(text)
}

fn shelve(alarms: &mut Alarms, cause: &Cause) {
    let (text, reason) = (String::new(), "known".into());
    alarms.take(&note(Noted::Shelved { alarm: cause.key(), text, for_s: 55.0, reason }), 5.0);
}

fn unshelve(alarms: &mut Alarms, cause: &Cause) {
    alarms.take(&note(Noted::Unshelved { alarm: cause.key(), text: String::new() }), 5.0);
}

/// What can happen to an alarm.
#[derive(Debug, Clone, Copy)]
enum Step {
    Raise(Severity),
    Clear,
    Acknowledge,
    Shelve,
    Unshelve,
    /// The time for which the alarm is shelved is over.
    Expire,
}

fn take(alarms: &mut Alarms, step: Step) {
    match step {
        Step::Raise(severity) => alarms.raise(CAUSE, severity, "again".into(), 5.0),
        Step::Clear => alarms.clear(&CAUSE, 5.0),
        Step::Acknowledge => acknowledge_one(alarms, &CAUSE),
        Step::Shelve => shelve(alarms, &CAUSE),
        Step::Unshelve => unshelve(alarms, &CAUSE),
        Step::Expire => alarms.expire(60.0),
    }
}

/// State and severity in two letters or three: U A R C, S for shelved with its cause, s without.
fn word(alarms: &Alarms) -> String {
    let alarm = alarms.get(&CAUSE).expect("it was raised");
    let state = match &alarm.state {
        State::Unacknowledged => 'U',
        State::Acknowledged => 'A',
        State::Returned => 'R',
        State::Cleared => 'C',
        State::Shelved(shelf) if shelf.active => 'S',
        State::Shelved(_) => 's',
    };
    let fallen = if alarm.fallen.is_some() { "+" } else { "" };
    format!("{state} {:?}{fallen}", alarm.severity)
}

#[test]
fn every_transition_is_the_one_of_the_table() {
    use Step::{Acknowledge, Clear, Expire, Raise, Shelve, Unshelve};
    let steps = [Raise(Watch), Raise(Warn), Raise(Crit), Clear, Acknowledge, Shelve, Unshelve, Expire];
    let ways: [(Severity, &[Step]); 12] = [
        (Watch, &[]),
        (Warn, &[]),
        (Crit, &[]),
        (Watch, &[Acknowledge]),
        (Warn, &[Acknowledge]),
        (Crit, &[Acknowledge]),
        (Warn, &[Clear]),
        (Crit, &[Clear]),
        (Watch, &[Clear]),
        (Warn, &[Shelve]),
        (Warn, &[Shelve, Clear]),
        (Crit, &[Raise(Warn)]),
    ];
    #[rustfmt::skip]
    let table: [[&str; 9]; 12] = [
        // from       raise WATCH  WARN       CRIT      clear      ackn.      shelve     unshelve   expire
        ["U Watch",   "U Watch",  "U Warn",  "U Crit", "C Watch", "A Watch", "S Watch", "U Watch", "U Watch"],
        ["U Warn",    "U Warn+",  "U Warn",  "U Crit", "R Warn",  "A Warn",  "S Warn",  "U Warn",  "U Warn"],
        ["U Crit",    "U Crit+",  "U Crit+", "U Crit", "R Crit",  "A Crit",  "U Crit",  "U Crit",  "U Crit"],
        ["A Watch",   "A Watch",  "U Warn",  "U Crit", "C Watch", "A Watch", "S Watch", "A Watch", "A Watch"],
        ["A Warn",    "A Watch",  "A Warn",  "U Crit", "C Warn",  "A Warn",  "S Warn",  "A Warn",  "A Warn"],
        ["A Crit",    "A Watch",  "A Warn",  "A Crit", "C Crit",  "A Crit",  "A Crit",  "A Crit",  "A Crit"],
        ["R Warn",    "U Warn+",  "U Warn",  "U Crit", "R Warn",  "C Warn",  "R Warn",  "R Warn",  "R Warn"],
        ["R Crit",    "U Crit+",  "U Crit+", "U Crit", "R Crit",  "C Crit",  "R Crit",  "R Crit",  "R Crit"],
        ["C Watch",   "U Watch",  "U Warn",  "U Crit", "C Watch", "C Watch", "C Watch", "C Watch", "C Watch"],
        ["S Warn",    "S Watch",  "S Warn",  "U Crit", "s Warn",  "S Warn",  "S Warn",  "U Warn",  "U Warn"],
        ["s Warn",    "S Watch",  "S Warn",  "U Crit", "s Warn",  "s Warn",  "s Warn",  "C Warn",  "C Warn"],
        ["U Crit+",   "U Crit+",  "U Crit+", "U Crit", "R Crit+", "U Warn",  "U Crit+", "U Crit+", "U Crit+"],
    ];
    for ((severity, way), row) in ways.into_iter().zip(table) {
        let mut alarms = raised(severity);
        for step in way {
            take(&mut alarms, *step);
        }
        assert_eq!(word(&alarms), row[0], "{severity:?} {way:?}");
        for (step, expected) in steps.into_iter().zip(&row[1..]) {
            let mut alarms = alarms.clone();
            take(&mut alarms, step);
            assert_eq!(word(&alarms), *expected, "{} {step:?}", row[0]);
        }
    }
}

#[test]
fn a_critical_alarm_stays_until_it_is_acknowledged() {
    let mut alarms = raised(Crit);
    alarms.clear(&CAUSE, 2.0);
    assert_eq!(alarms.count(Crit), 1);
    assert_eq!(acknowledge(&mut alarms).as_deref(), Some("position lost"));
    assert_eq!(alarms.open().count(), 0);
    assert_eq!(alarms.list().len(), 1, "it is listed as cleared");
}

#[test]
fn an_acknowledged_alarm_stays_until_its_cause_is_gone_and_wakes_when_it_comes_back() {
    let mut alarms = raised(Crit);
    acknowledge(&mut alarms);
    assert_eq!((alarms.count(Crit), alarms.unacknowledged(Crit)), (1, 0));
    alarms.clear(&CAUSE, 2.0);
    alarms.raise(CAUSE, Crit, "again".into(), 3.0);
    assert_eq!(alarms.unacknowledged(Crit), 1);
    assert_eq!(alarms.get(&CAUSE).map(|alarm| (alarm.count, alarm.since_s)), Some((2, 3.0)));
}

#[test]
fn the_worst_alarm_is_acknowledged_first_and_all_of_them_at_once() {
    let mut alarms = raised(Watch);
    alarms.raise(Cause::Planner, Crit, "planner failed".into(), 2.0);
    assert_eq!(alarms.worst().map(|alarm| alarm.text.as_str()), Some("planner failed"));
    let mut all = alarms.clone();
    assert_eq!(acknowledge(&mut alarms).as_deref(), Some("planner failed"));
    assert_eq!(acknowledge(&mut alarms).as_deref(), Some("position lost"));
    assert_eq!(acknowledge(&mut alarms), None);
    while acknowledge(&mut all).is_some() {}
    assert_eq!(all.open().count(), 2, "seen, and not over");
}

#[test]
fn what_fell_while_nobody_looked_is_acknowledged_next() {
    for clears in [false, true] {
        let mut alarms = raised(Crit);
        if clears {
            alarms.clear(&CAUSE, 1.5);
        }
        alarms.raise(CAUSE, Warn, "position poor".into(), 2.0);
        assert_eq!(acknowledge(&mut alarms).as_deref(), Some("position lost"));
        assert_eq!((alarms.count(Crit), alarms.unacknowledged(Warn)), (0, 1), "not seen yet");
        assert_eq!(acknowledge(&mut alarms).as_deref(), Some("position poor"));
        alarms.raise(CAUSE, Watch, "position fair".into(), 3.0);
        assert_eq!((alarms.count(Watch), alarms.unacknowledged(Watch)), (1, 0));
    }
    let mut alarms = raised(Crit);
    alarms.raise(CAUSE, Warn, "position poor".into(), 2.0);
    alarms.raise(CAUSE, Crit, "lost again".into(), 3.0);
    assert_eq!(acknowledge(&mut alarms).as_deref(), Some("lost again"));
    assert_eq!(acknowledge(&mut alarms), None, "what it had fallen to is forgotten");
}

#[test]
fn the_first_of_a_burst_is_marked_as_long_as_it_is_not_alone() {
    let first = |alarms: &Alarms| -> Vec<Cause> {
        let marked = alarms.list().iter().filter(|alarm| alarms.is_first_out(alarm));
        marked.map(|alarm| alarm.cause.clone()).collect()
    };
    let mut alarms = Alarms::default();
    alarms.raise(Cause::NoFix, Watch, "no fix".into(), 1.0);
    assert_eq!(first(&alarms), []);
    alarms.raise(CAUSE, Crit, "position lost".into(), 8.0);
    alarms.clear(&Cause::NoFix, 9.0);
    alarms.raise(Cause::NoFix, Watch, "no fix".into(), 10.0);
    assert_eq!(first(&alarms), [Cause::NoFix], "also after it came back");
    alarms.raise(Cause::Stuck, Warn, "stuck".into(), 30.0);
    alarms.raise(Cause::Planner, Crit, "planner failed".into(), 31.0);
    assert_eq!(first(&alarms), [Cause::NoFix, Cause::Stuck]);
}

#[test]
fn the_first_of_a_burst_is_the_alarm_whose_cause_began_first() {
    let mut alarms = Alarms::default();
    let rule = Rule { severity: Crit, on_delay_s: 1.0, off_delay_s: 0.0 };
    alarms.occurred(CAUSE, rule, "position lost".into(), 10.0);
    alarms.raise(Cause::Vehicle, Warn, "vehicle".into(), 10.5);
    alarms.expire(11.5);
    let marked: Vec<_> = alarms.list().iter().filter(|alarm| alarms.is_first_out(alarm)).collect();
    assert_eq!(marked.len(), 1);
    assert_eq!((&marked[0].cause, marked[0].since_s), (&CAUSE, 10.0));
    alarms.raise(Cause::Stuck, Warn, "stuck".into(), 20.3);
    let burst = |cause: &Cause| alarms.get(cause).map(|alarm| alarm.burst);
    assert_eq!(burst(&Cause::Stuck), burst(&CAUSE), "10 s count from the newest cause");
}

#[test]
fn delays_end_with_the_run() {
    let mut alarms = raised(Crit);
    let rule = Rule { severity: Warn, on_delay_s: 5.0, off_delay_s: 5.0 };
    alarms.passed(&CAUSE, 5.0, 10.0);
    alarms.occurred(Cause::Stuck, rule, "stuck".into(), 10.0);
    alarms.conclude(11.0);
    let is_active = |cause: &Cause| alarms.get(cause).map(Alarm::is_active);
    assert_eq!((is_active(&CAUSE), is_active(&Cause::Stuck)), (Some(false), Some(true)));
}

#[test]
fn the_table_shows_what_matters_most_first() {
    let mut alarms = Alarms::default();
    for (cause, severity) in [
        (Cause::NoFix, Watch),
        (Cause::Map, Info),
        (Cause::Stuck, Warn),
        (Cause::Disk, Warn),
        (Cause::Planner, Crit),
        (Cause::PositionLost, Crit),
    ] {
        alarms.raise(cause, severity, String::new(), 1.0);
    }
    acknowledge_one(&mut alarms, &Cause::Planner);
    shelve(&mut alarms, &Cause::Disk);
    alarms.clear(&Cause::Map, 2.0);
    let causes: Vec<Cause> = alarms.table().into_iter().map(|alarm| alarm.cause.clone()).collect();
    let expected = [Cause::PositionLost, Cause::Stuck, Cause::NoFix, Cause::Planner, Cause::Disk, Cause::Map];
    assert_eq!(causes, expected);
}

#[test]
fn there_are_never_too_many_and_what_is_open_is_not_lost() {
    let mut alarms = raised(Crit);
    for id in 0..200 {
        let station = Cause::Station(world::StationId(id));
        alarms.raise(station.clone(), Watch, String::new(), 2.0);
        alarms.clear(&station, 2.0);
        alarms.note(&station, u64::from(id), None);
    }
    assert_eq!((alarms.list().len(), alarms.count(Crit)), (64, 1));
}

#[test]
fn words_that_were_not_seen_are_not_acknowledged() {
    let mut alarms = raised(Warn);
    let seen = Noted::Acknowledged { alarm: CAUSE.key(), text: "position lost".into() };
    alarms.raise(CAUSE, Crit, "position lost for good".into(), 2.0);
    alarms.take(&note(seen), 2.0);
    assert_eq!(alarms.unacknowledged(Crit), 1, "it became worse in the tick before");
    acknowledge_one(&mut alarms, &CAUSE);
    assert_eq!(alarms.unacknowledged(Crit), 0);
    // An alarm that the run does not have, as in the journal of a console that was slow.
    alarms.take(&note(Noted::Acknowledged { alarm: "response".into(), text: String::new() }), 2.0);
    assert_eq!(alarms.list().len(), 1);
}

#[test]
fn every_cause_has_a_name_of_its_own() {
    let mut keys: Vec<String> = Cause::every().iter().map(Cause::key).collect();
    let n = keys.len();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), n);
}
