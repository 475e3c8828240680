//! The papers' tables and the tuning of parameters, across the plugin boundary.

use crate::bench::Bench;
use serde_json::Value;

fn rows(bench: &Bench, arguments: &[&str]) -> Vec<Value> {
    let answer = bench.tankops(&[&["reproduce"], arguments, &["--json"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    answer.json().as_array().unwrap().clone()
}

fn without_times(rows: Vec<Value>) -> Vec<Value> {
    rows.into_iter().filter(|row| !row["metric"].as_str().unwrap().contains("time")).collect()
}

#[test]
fn a_table_does_not_depend_on_the_number_of_threads() {
    let bench = Bench::new();
    let asked = ["wang-table1", "--layouts", "3", "--first-seed", "70", "--case", "d3/disk", "--threads"];
    let one = without_times(rows(&bench, &[&asked[..], &["1"]].concat()));
    let three = without_times(rows(&bench, &[&asked[..], &["3"]].concat()));
    assert!(one.len() > 100);
    assert_eq!(one, three);
    let printed =
        one.iter().find(|row| row["method"] == "rpf/gated+ir" && row["metric"] == "precision").unwrap();
    assert_eq!(printed["paper"], 0.9506);
}

#[test]
fn our_followers_keep_clear_on_layouts_that_nobody_chose() {
    let rows = rows(&Bench::new(), &["spiral-followers", "--layouts", "8", "--first-seed", "4242"]);
    let of = |metric: &str| rows.iter().filter(|row| row["metric"] == metric).collect::<Vec<_>>();
    for row in of("collisions").into_iter().chain(of("wall_exits")) {
        assert_eq!(row["ours"], 0.0, "{row}");
    }
    assert_eq!(of("ok_rate").len(), 18);
}

#[test]
fn names_and_cases_that_do_not_exist_are_answered_with_what_does() {
    let bench = Bench::new();
    let listed = bench.tankops(&["reproduce", "--list", "--json"]).json();
    assert!(listed.as_array().unwrap().iter().any(|study| study["name"] == "wang-table2"));
    let misspelt = bench.tankops(&["reproduce", "wang-tabel1"]);
    assert!(misspelt.code == Some(2) && misspelt.err.contains("wang-table1"), "{misspelt:?}");
    let no_case = bench.tankops(&["reproduce", "wang-table1", "--case", "d9"]);
    assert!(no_case.code == Some(2) && no_case.err.contains("--case"), "{no_case:?}");
}

#[test]
fn every_coverage_planner_has_every_figure_of_its_tether_and_is_drawn() {
    let bench = Bench::new();
    let folder = bench.path().join("plans");
    let asked = ["pan-maps", "--layouts", "1", "--first-seed", "31", "--case", "E3", "--svg", "plans"];
    let rows = rows(&bench, &asked);
    assert!(rows.iter().all(|row| row["case"] == "E3-square-18" && row["n"] == 1), "{rows:?}");
    let of = |method: &str, metric: &str| {
        let row = rows.iter().find(|row| row["method"] == method && row["metric"] == metric).unwrap();
        row["ours"].as_f64().unwrap()
    };
    assert!(of("boustrophedon", "end_length_m") > 20.0 && of("boustrophedon", "hook_share") > 0.02);
    for method in ["hull-partition/tree", "tether-safe", "tether-safe/alpha-0"] {
        assert!(of(method, "reeled_in_rate") > 0.99 && of(method, "certified_rate") > 0.99, "{method}");
    }
    assert!(of("tether-safe", "coverage_goal_rate") > 0.99 && of("tether-safe", "max_excess_m") < 4.0);
    let drawn = std::fs::read_to_string(folder.join("E3-square-18-31-tether-safe.svg")).unwrap();
    for class in ["swath", "connector", "cut", "cable", "anchor"] {
        assert!(drawn.contains(&format!(r#"class="{class}""#)), "{class}");
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 6);
    let none = bench.tankops(&["reproduce", "pan-maps", "--case", "nope"]);
    assert!(none.code == Some(2) && none.err.contains("known: E1-circle-14"), "{none:?}");
    let nothing = bench.tankops(&["reproduce", "wang-table3", "--svg", "plans"]);
    assert!(nothing.code == Some(2) && nothing.err.contains("coverage-suite"), "{nothing:?}");
}

#[test]
fn tuning_repeats_and_is_evaluated_on_other_layouts() {
    let bench = Bench::new();
    let asked = "tune --planner rpf --on wang-d3 --tune k_rep --tune rho_0_m --set wall_gain=0 --layouts 3 \
                 --test-layouts 4 --generations 2 --json";
    let asked: Vec<&str> = asked.split_whitespace().collect();
    let tuned = bench.tankops(&asked).json();
    assert_eq!(tuned["parameters"], bench.tankops(&asked).json()["parameters"]);
    let loss = &tuned["training_loss"];
    assert!(loss["tuned"].as_f64() <= loss["start"].as_f64(), "{loss}");
    assert!(
        tuned["rows"].as_array().unwrap().iter().any(|row| row["method"] == "rpf/tuned" && row["n"] == 4)
    );
    let overlap = bench.tankops(&[&asked[..], &["--test-first-seed", "2"]].concat());
    assert!(overlap.code == Some(2) && overlap.err.contains("overlap"), "{overlap:?}");
}

#[test]
fn a_study_with_a_folder_resumes_and_is_shared_by_several_processes() {
    let bench = Bench::new();
    let arguments =
        ["reproduce", "trap-suite", "--layouts", "3", "--case", "u", "--method", "shortest", "--json"];
    let alone = bench.tankops(&arguments);
    let shared = [&arguments[..], &["--out", "study"]].concat();
    let both = std::thread::scope(|scope| {
        let other = scope.spawn(|| bench.tankops(&shared));
        [bench.tankops(&shared), other.join().unwrap()]
    });
    assert!(both.iter().all(|answer| answer.code == Some(0)), "{both:?}");
    assert_eq!(both[0].out, both[1].out, "times, too: each layout was computed once");
    let rows = |answer: &str| without_times(serde_json::from_str(answer).unwrap());
    assert_eq!(rows(&both[0].out), rows(&alone.out));

    let parts = || std::fs::read_dir(bench.path().join("study/parts")).unwrap().flatten();
    let part = parts().next().unwrap().path();
    std::fs::remove_file(&part).unwrap();
    assert_eq!(rows(&bench.tankops(&shared).out), rows(&alone.out));
    assert!(part.exists() && std::fs::read_dir(bench.path().join("study/claims")).unwrap().next().is_none());

    std::fs::write(&part, b"half").unwrap();
    let damaged = bench.tankops(&shared);
    assert!(damaged.code == Some(0) && damaged.err.contains(".cbor is damaged: "), "{damaged:?}");
    assert!(damaged.err.contains("study/parts/part-"), "{damaged:?}");
    assert_eq!(rows(&damaged.out), rows(&alone.out), "it is computed again");
    std::fs::remove_file(&part).unwrap();
    let made = std::process::Command::new("mkfifo").arg(&part).status().unwrap();
    let pipe = bench.tankops(&shared);
    assert!(made.success() && pipe.code == Some(2) && pipe.err.contains("not a regular file"), "{pipe:?}");
    let other = bench.tankops(&[&shared[..], &["--first-seed", "9"]].concat());
    assert!(other.code == Some(2) && other.err.contains("computed with different arguments"), "{other:?}");
    std::fs::write(bench.path().join("study/study.json"), b"{half").unwrap();
    let broken = bench.tankops(&shared);
    assert!(broken.code == Some(2) && broken.err.contains("study.json: "), "{broken:?}");
    assert!(!broken.err.contains("different arguments"), "{broken:?}");
}

#[test]
fn a_search_with_a_folder_gives_what_one_without_gives_and_computes_nothing_twice() {
    let bench = Bench::new();
    let layouts =
        ["--on", "wang-d1", "--layouts", "4", "--test-layouts", "4", "--generations", "2", "--json"];
    let arguments = [&["tune", "--planner", "rpf"], &layouts[..]].concat();
    let alone = bench.tankops(&arguments).json();
    let shared = [&arguments[..], &["--out", "search"]].concat();
    let [first, again] = [bench.tankops(&shared), bench.tankops(&shared)];
    assert_eq!(first.out, again.out, "with its times");
    assert_eq!(first.json()["parameters"], alone["parameters"]);
    assert_eq!(first.json()["training_loss"], alone["training_loss"]);
}

#[test]
fn a_tankops_without_the_program_of_the_studies_says_how_to_build_it() {
    let bench = Bench::new();
    let alone = bench.path().join("tankops");
    std::fs::copy(env!("CARGO_BIN_EXE_tankops"), &alone).unwrap();
    for words in [&["reproduce"][..], &["tune", "--planner", "rpf", "--on", "wang-d1"]] {
        let ended = std::process::Command::new(&alone).args(words).output().unwrap();
        let why = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(2), "{ended:?}");
        assert!(
            why.contains("tankops-research") && why.contains("cargo build --release --workspace"),
            "{why}"
        );
    }
}
