use super::super::{MAX_LINES, What};
use super::*;
use mission::Severity;

fn texts<'a>(matches: &'a Matches, log: &'a Log) -> Vec<&'a str> {
    matches.newest(log, 0).map(|listed| listed.entry.text.as_str()).collect()
}

/// The matches found all at once, to which a step-by-step refresh must lead, too.
fn fresh(text: &str, log: &Log) -> Matches {
    let mut matches = Matches::default();
    matches.refresh(text, log);
    matches
}

#[test]
fn what_is_critical_cannot_be_filtered_away() {
    let mut log = Log::default();
    log.add(1.0, Severity::Crit, "ae", "position lost".into());
    log.add(2.0, Severity::Info, "plan", "planned".into());
    assert_eq!(texts(&fresh("sev>=warn column", &log), &log), ["position lost"]);
}

fn said(planner: &str, n: usize) -> Entry {
    let (planner, message) = (planner.to_owned(), n.to_string());
    let kind = EventKind::PlannerLogged { planner, level: planner_api::LogLevel::Debug, message };
    let what = What::Event(Box::new(super::super::Occurrence { kind, robot: None, range: None }));
    let (severity, source) = (Severity::Debug, "plan".into());
    Entry { tick: 0, t_s: 1.0, severity, source, text: n.to_string(), count: 1, what }
}

fn warned(planner: &str, message: &str) -> What {
    let (planner, message) = (planner.to_owned(), message.to_owned());
    let kind = EventKind::PlannerLogged { planner, level: planner_api::LogLevel::Warn, message };
    What::Event(Box::new(super::super::Occurrence { kind, robot: None, range: None }))
}

#[test]
fn messages_of_one_planner_that_follow_each_other_are_listed_as_one() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    for n in 0..4 {
        log.push(said("rpf", n));
        matches.refresh("sev>=debug", &log);
    }
    log.push(said("apf", 4));
    log.add(2.0, Severity::Info, "plan", "planned".into());
    matches.refresh("sev>=debug", &log);
    assert_eq!(matches, fresh("sev>=debug", &log));
    let listed: Vec<_> = matches.newest(&log, 0).map(|listed| (listed.number, listed.more)).collect();
    assert_eq!(listed, [(5, 0), (4, 0), (3, 3)]);
    assert_eq!((matches.newer_than(1), matches.newer_than(3)), (2, 2), "a grown group stays selected");
    let also: Vec<&str> = matches.grouped(&log, 3).map(|entry| entry.text.as_str()).collect();
    assert_eq!(also, ["2", "1", "0"]);
    matches.refresh("", &log);
    assert_eq!(matches.len(), 1, "hidden unless asked for");
}

#[test]
fn a_group_of_which_lines_were_dropped_is_counted_again() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    for n in 0..MAX_LINES + 5000 {
        log.push(said("rpf", n));
        if n % 700 == 0 {
            matches.refresh("sev>=debug", &log);
        }
    }
    matches.refresh("sev>=debug", &log);
    assert_eq!(matches, fresh("sev>=debug", &log));
}

#[test]
fn messages_that_are_repeated_join_and_leave_groups_as_in_a_fresh_list() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    // The same words are repeated later, by the same planner or by another one.
    let steps =
        [("rpf", 0), ("rpf", 1), ("rpf", 1), ("rpf", 1), ("apf", 1), ("rpf", 1), ("apf", 2), ("apf", 2)];
    for text in ["sev>=debug", "sev>=debug t>4", "sev>=debug -1"] {
        for (step, (planner, n)) in steps.iter().cycle().take(40).enumerate() {
            log.push(Entry { t_s: step as f64, ..said(planner, *n) });
            for _ in 0..2 {
                matches.refresh(text, &log);
                assert_eq!(matches, fresh(text, &log), "{text} in step {step}");
            }
        }
    }
}

#[test]
fn a_warning_of_a_planner_with_other_figures_is_listed_once_where_it_last_occurred() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    let texts = ["0.12 m² out of reach", "gap of 0.3 m", "0.25 m² out of reach", "0.25 m² out of reach"];
    for (plan, text) in texts.iter().cycle().take(12).enumerate() {
        let planned = format!("planned {plan} m");
        log.add(plan as f64, Severity::Info, "plan", planned);
        let what = warned("rpf", text);
        log.push(Entry {
            t_s: plan as f64,
            severity: Severity::Watch,
            text: (*text).into(),
            what,
            ..said("", 0)
        });
        for _ in 0..2 {
            matches.refresh("", &log);
            assert_eq!(matches, fresh("", &log), "plan {plan}");
        }
    }
    let mut listed = matches.newest(&log, 0);
    let Some(newest) = listed.next() else { panic!("nothing is listed") };
    assert_eq!((newest.entry.text.as_str(), newest.times, newest.entry.t_s), (texts[2], 9, 11.0));
    let others: Vec<(&str, u32)> = listed.map(|l| (l.entry.text.as_str(), l.times)).collect();
    assert_eq!(others.len(), 13, "twelve plans and one other warning: {others:?}");
    assert!(others.contains(&(texts[1], 3)));
    let before: Vec<&str> = matches.grouped(&log, newest.number).map(|e| e.text.as_str()).collect();
    assert_eq!((before.len(), before[0], before[1]), (8, texts[2], texts[0]));
    // The same words from another planner are not a repeat.
    let what = warned("apf", texts[1]);
    log.push(Entry { severity: Severity::Watch, text: texts[1].into(), what, ..said("", 0) });
    matches.refresh("", &log);
    assert_eq!(matches.newest(&log, 0).next().map(|listed| listed.times), Some(1));
}

#[test]
fn step_by_step_is_the_same_as_fresh() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    for (step, text) in ["", "a", "ab", "a", "-a", "t>5"].into_iter().cycle().take(60).enumerate() {
        for i in 0..step % 4 {
            log.add(step as f64, Severity::Info, "plan", format!("{}{}", ["a", "ab", "c"][i], step / 7));
        }
        matches.refresh(text, &log);
        assert_eq!(matches, fresh(text, &log), "{text} in step {step}");
    }
    matches.refresh("t>5", &Log::default());
    assert!(matches.is_empty(), "another run has begun");
}

#[test]
fn a_line_that_is_counted_again_is_looked_at_again_and_dropped_lines_are_forgotten() {
    let (mut log, mut matches) = (Log::default(), Matches::default());
    for t_s in [1.0, 9.0] {
        log.add(t_s, Severity::Watch, "ae", "no fix".into());
        matches.refresh("t>5", &log);
    }
    assert_eq!(matches.len(), 1);
    for i in 0..MAX_LINES + 5000 {
        log.add(9.0, Severity::Info, "plan", i.to_string());
    }
    matches.refresh("t>5", &log);
    assert_eq!((matches.len(), matches.number(usize::MAX)), (log.len(), Some(log.oldest())));
}

#[test]
fn places_are_found_by_number_even_of_lines_that_do_not_pass() {
    let mut log = Log::default();
    for i in 0..10 {
        let text = if i % 2 == 0 { "even" } else { "odd" };
        log.add(f64::from(i), Severity::Info, "plan", text.into());
    }
    let even = fresh("even", &log);
    assert_eq!([even.newer_than(8), even.newer_than(7), even.newer_than(0)], [0, 1, 4]);
    assert_eq!([even.number(0), even.number(1), even.number(99)], [Some(8), Some(6), Some(0)]);
    assert!(matches!(log.get(0).map(|entry| &entry.what), Some(What::Console)));
    assert_eq!([false, true].map(|back| even.next_like(&log, 4, back, 9)), [Some(6), Some(2)]);
    assert_eq!([false, true].map(|back| even.next_like(&log, 5, back, 9)), [Some(6), Some(4)]);
    assert_eq!([even.next_like(&log, 8, false, 9), even.next_like(&log, 0, true, 9)], [None, None]);
}
