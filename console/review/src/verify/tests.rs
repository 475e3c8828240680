use super::*;
use std::fmt::Write;

fn equal() -> Findings {
    let planners = Some(Asked { same: 40, ..Asked::default() });
    Findings { is_reported: true, planners, events: 1200, last_tick: 99, ..Findings::default() }
}

fn shown(findings: &Findings) -> String {
    let mut text = format!("{}:\n", if findings.are_equal() { "exit 0" } else { "exit 1" });
    for line in lines(findings, &PluginDirs::of(Vec::new())) {
        writeln!(text, "{line}").expect("a String takes everything");
    }
    text
}

#[test]
fn every_finding_has_a_line_and_only_an_equal_run_is_equal() {
    let asked = |change: fn(&mut Asked)| {
        let mut asked = Asked { same: 40, ..Asked::default() };
        change(&mut asked);
        Findings { planners: Some(asked), ..equal() }
    };
    let difference = Difference { tick: 7, recorded: "{\"t\":1}".into(), computed: "{\"t\":2}".into() };
    let recovered = Recovered { by: "A. Berg".into(), at: "2026-11-22 04:01".into(), missing: Vec::new() };
    let cases = [
        ("equal", equal()),
        ("from the journal", Findings { planners: None, ..equal() }),
        ("refused answers", asked(|asked| asked.not_comparable = 2)),
        ("failed earlier", asked(|asked| asked.too_early = 3)),
        ("external fault", asked(|asked| asked.external = [("apf".to_owned(), 2)].into())),
        ("not proven", asked(|asked| asked.unproven = Some("tick 8: planner apf hung".into()))),
        ("other answer", asked(|asked| asked.difference = Some("tick 8: planner apf answers".into()))),
        ("difference", Findings { difference: Some(difference), ..equal() }),
        ("earlier build", Findings { unrecorded: ["tethered.measured".to_owned()].into(), ..equal() }),
        ("doubt", Findings { doubt: Some("events.jsonl.zst was changed".into()), ..equal() }),
        ("no report", Findings { is_reported: false, ..equal() }),
        ("killed", Findings { no_end: Some("the last line is cut".into()), ..equal() }),
        ("recovered", Findings { recovered: Some(recovered), ..equal() }),
        ("signed", Findings { signed: vec!["signed: revision A by A. Berg".into()], ..equal() }),
        ("not as signed", Findings { not_as_signed: vec!["revision A names another run".into()], ..equal() }),
    ];
    let shown: Vec<String> = cases
        .iter()
        .map(|(name, findings)| {
            format!(
                "# {name}
{}
",
                shown(findings)
            )
        })
        .collect();
    insta::assert_snapshot!(shown.concat());
}

#[test]
fn an_unproven_answer_is_not_named_where_another_one_differs() {
    let asked = Asked {
        unproven: Some("tick 8".into()),
        difference: Some("tick 7: planner apf answers".into()),
        ..Asked::default()
    };
    let text = shown(&Findings { planners: Some(asked), ..equal() });
    assert!(!text.contains("not proven") && text.contains("different: tick 7"), "{text}");
}
