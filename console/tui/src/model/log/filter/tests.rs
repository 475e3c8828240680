//! Tests of filters: the terms that they accept, and the reasons for refused terms.

use super::super::{Entry, Log, Occurrence, What};
use super::*;
use mission::EventKind;
use planner_api::LogLevel;

fn entry(t_s: f64, severity: Severity, source: &'static str, text: &str) -> Entry {
    Entry { tick: 0, t_s, severity, source: source.into(), text: text.into(), count: 1, what: What::Console }
}

fn lines() -> Vec<Entry> {
    vec![
        entry(10.0, Severity::Info, "plan", "rpf planned 31.4 m"),
        entry(56.0, Severity::Watch, "ae", "station C rejected: residual +0.25 m"),
        entry(338.0, Severity::Info, "ae", "station C2 back in use"),
        entry(400.0, Severity::Warn, "tether", "near limit: 24.1 m of tether out"),
        entry(500.0, Severity::Crit, "ae", "position lost: 95 % error 0.49 m"),
    ]
}

/// The indices of the lines that pass a filter.
fn passing(text: &str) -> Vec<usize> {
    let filter = Filter::parse(text);
    assert_eq!(filter.problems, [], "{text}");
    passed(&filter)
}

fn passed(filter: &Filter) -> Vec<usize> {
    let mut log = Log::default();
    for line in lines() {
        log.push(line);
    }
    log.passing(filter, 0).map(|number| number as usize).collect()
}

#[test]
fn every_kind_of_term_selects_what_it_says_and_what_is_critical_always_passes() {
    let table: [(&str, &[usize]); 22] = [
        ("", &[0, 1, 2, 3, 4]),
        ("STATION", &[1, 2, 4]),
        ("station c", &[1, 2, 4]),
        ("\"station c\" rejected", &[1, 4]),
        ("\"position lost\"", &[4]),
        ("-ae", &[0, 3, 4]),
        ("-\"station c\"", &[0, 3, 4]),
        ("sev>=watch", &[1, 3, 4]),
        ("sev:warn", &[3, 4]),
        ("severity<watch", &[0, 2, 4]),
        ("-sev>=warn", &[0, 1, 2, 4]),
        ("source=ae", &[1, 2, 4]),
        ("source:tether,plan", &[0, 3, 4]),
        ("station=C", &[1, 4]),
        ("station=c,C2", &[1, 2, 4]),
        ("t>00:05", &[2, 3, 4]),
        ("t>=00:05:38 t<400", &[2, 4]),
        ("t<=56s", &[0, 1, 4]),
        ("sev>=watch source=ae \"residual +\"", &[1, 4]),
        ("sev>=c", &[4]),
        ("0.25", &[1, 4]),
        ("\"near limit:\" \"unclosed", &[4]),
    ];
    for (text, expected) in table {
        assert_eq!(passing(text), expected, "{text}");
    }
}

#[test]
fn what_is_not_understood_is_marked_and_explained_and_filters_nothing() {
    let table = [
        ("sevv>=watch", "unknown field `sevv`"),
        ("sev>=w", "info, watch, warn or crit"),
        ("sev=", "info, watch, warn or crit"),
        ("source=", "source=ae,tether"),
        ("source>ae", "source takes only ="),
        ("t=5", "t takes only < <= > >="),
        ("t>soon", "hh:mm"),
        ("t>1:2:3:4", "hh:mm"),
        ("t>inf", "hh:mm"),
    ];
    for (term, why) in table {
        let text = format!("ae {term} -plan");
        let filter = Filter::parse(&text);
        let [problem] = &filter.problems[..] else { panic!("{text}: {:?}", filter.problems) };
        assert_eq!((&text[problem.at.clone()], problem.why.contains(why)), (term, true), "{}", problem.why);
        assert_eq!(passed(&filter), passing("ae -plan"));
    }
    assert_eq!(Filter::parse("\"a=b\" source=\"ae\" 12:30").problems, []);
}

#[test]
fn the_least_severity_can_be_changed_without_touching_the_rest() {
    let text = "source=ae sev>=watch \"position lost\"";
    assert_eq!(Filter::parse(text).least(), Severity::Watch);
    assert_eq!(with_least(text, Severity::Crit), "sev>=crit source=ae \"position lost\"");
    assert_eq!(with_least(text, Severity::Info), "source=ae \"position lost\"");
    assert_eq!(with_least("", Severity::Warn), "sev>=warn");
    assert_eq!(without_least("-sev>=warn sev=info a"), "-sev>=warn sev=info a");
    assert_eq!(with_debug(text), "sev>=debug source=ae \"position lost\"");
    assert_eq!(with_least(&with_debug("a"), Severity::Info), "a");
}

#[test]
fn messages_of_planners_about_their_own_work_pass_only_if_a_term_asks_for_them() {
    let said = |level, severity| {
        let kind = EventKind::PlannerLogged { planner: "rpf".into(), level, message: "11 candidates".into() };
        let what = What::Event(Box::new(Occurrence { kind, robot: None, range: None }));
        Entry { what, ..entry(600.0, severity, "plan", "rpf: 11 candidates") }
    };
    let mut log = Log::default();
    log.push(said(LogLevel::Debug, Severity::Debug));
    log.push(said(LogLevel::Warn, Severity::Watch));
    let passing = |text: &str| log.passing(&Filter::parse(text), 0).collect::<Vec<u64>>();
    assert_eq!([passing(""), passing("rpf"), passing("sev>=info")], [[1], [1], [1]]);
    assert_eq!(
        (passing("sev>=debug"), passing("sev=debug"), passing("-sev>=debug")),
        (vec![0, 1], vec![0], vec![])
    );
}
