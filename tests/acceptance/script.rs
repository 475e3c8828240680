//! The console without a terminal: scripts, plain sentences, configuration files, completions and manual pages.

use crate::bench::{Bench, Ended, scenario};
use crate::looking_on::Console;

fn scripted(bench: &Bench, script: &str) -> Ended {
    let file = bench.file("mission.txt", script);
    bench.tankops(&["console", "--script", file.to_str().unwrap()])
}

#[test]
fn a_script_flies_a_mission_and_demands_its_result() {
    let bench = Bench::new();
    let ended = scripted(
        &bench,
        "# the demo, held once\nspeed max\nstart\nkey enter\nwait until phase running within 1m\nhold\n\
         wait until phase held\nassert text \"HELD by operator\"\nassert not coverage >= 90\nresume\nkey enter\nspeed max\n\
         wait until screen result within 2m\nassert phase complete\nassert coverage >= 80\nverify latest\n\
         wait until text \" verified: all \" within 2m\n",
    );
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.prove(&bench.runs()[0]);
}

#[test]
fn a_scenario_that_is_opened_by_its_name_is_the_selected_one_on_the_home_screen() {
    let bench = Bench::new();
    let folder = bench.path().join("scenarios");
    std::fs::create_dir(&folder).unwrap();
    for (name, from) in [("first", "cover-circle.toml"), ("tank", "cover-square.toml")] {
        std::fs::copy(scenario(from), folder.join(format!("{name}.toml"))).unwrap();
    }
    let file = bench.file(
        "mission.txt",
        "wait until screen plan within 1m\nkey 1\nwait until text \"cover-circle\" within 1m\nassert text \">cover-square\"\nassert text \"open, \"\n\
         assert not text \"INVALID\"\nassert not text \"not a regular file\"\n",
    );
    let ended = bench.tankops(&["console", "tank", "--script", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

#[test]
fn the_first_line_that_fails_is_named() {
    let cases = [
        (
            "theme dark\nassert phase running\n",
            1,
            "mission.txt:2: assertion failed: phase running; the phase is waiting",
        ),
        ("theme dark\nspeed 900\n", 2, "mission.txt:2: must be 0.25 to 64, or max"),
        ("theme dark\nbogus command\n", 2, "mission.txt:2: unknown command `bogus`"),
        ("exclude S9\n", 1, "mission.txt:1: no station `S9`"),
        ("resume\n", 1, "mission.txt:1: "),
        ("start\nresume\n", 1, "mission.txt:2: a question is open; answer it first"),
        (
            "wait until text nonsense within 0.1s\n",
            1,
            "mission.txt:1: timed out after 0.1 s waiting for: text \"nonsense\"",
        ),
        ("leave\ntheme dark\n", 1, "mission.txt:2: an earlier line closed the console"),
        ("theme dark\nwait a bit\n", 2, "mission.txt:2: write `wait until CONDITION"),
    ];
    for (script, code, line) in cases {
        let ended = scripted(&Bench::new(), script);
        assert!(ended.code == Some(code) && ended.err.contains(line), "{script}: {ended:?}");
    }
}

#[test]
fn nothing_is_run_of_a_script_with_a_line_that_cannot_be_read() {
    let bench = Bench::new();
    let ended =
        scripted(&bench, "speed max\nstart\nkey enter\nwait until phase ended\nbogus command\nspeed\n");
    assert_eq!(ended.code, Some(2), "{ended:?}");
    for line in ["mission.txt:5: unknown command `bogus`", "mission.txt:6: usage: speed"] {
        assert!(ended.err.contains(line), "{line}: {ended:?}");
    }
    assert!(bench.runs().is_empty());
}

#[test]
fn a_mission_that_is_held_is_ended() {
    for end in ["end", "key X"] {
        let bench = Bench::new();
        let script = format!(
            "start\nkey enter\nwait until phase running\nhold\nwait until phase held\n{end}\nkey enter\n\
             wait until phase aborted\n"
        );
        let ended = scripted(&bench, &script);
        assert_eq!(ended.code, Some(0), "{end}: {ended:?}");
        bench.prove(&bench.runs()[0]);
    }
}

#[test]
fn what_is_done_about_alarms_stations_and_presets_is_in_journal_and_report() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("tankops")).unwrap();
    bench.file("tankops/config.toml", "operator = \"lk\"\n");
    let ended = scripted(
        &bench,
        "start\nkey enter\nwait until phase running\ninject C offset=3 60s\nwait until alarm rejected within 2m\n\
         key a\nshelve 15m alarm=\"station C rejected\" reason=pump\nexclude D\ninclude D\nhold\nwait until phase held\n\
         end\nkey enter\nwait until phase aborted\n",
    );
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let run = &bench.runs()[0];
    bench.prove(run);
    let (run, events) = (run.to_str().unwrap(), bench.tankops(&["events", run.to_str().unwrap()]));
    let page = bench.path().join("report.html");
    let written = bench.tankops(&["report", run, "-o", page.to_str().unwrap()]);
    assert_eq!(written.code, Some(0), "{written:?}");
    let page = std::fs::read_to_string(page).unwrap();
    for (order, line) in [
        ("\"acknowledged\":", "alarm acknowledged by lk: "),
        ("\"shelved\":", "alarm shelved by lk for 15 min (pump): "),
        ("\"exclude", "exclude station D by lk"),
    ] {
        assert!(events.out.contains(order), "{order} in the journal");
        assert!(page.contains(line), "{line} on the page");
    }
}

#[test]
fn a_mission_that_takes_long_to_show_starts_when_that_is_confirmed() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    let (name, _) = text.split_once("[tank]").unwrap();
    let (_, robot) = text.split_once("[robot]").unwrap();
    let column = |k: u32| {
        let at_rad = 0.3 * f64::from(k);
        let (x, y) = (10.0 * at_rad.cos(), (4.0 + f64::from(k % 10)) * at_rad.sin());
        format!(
            "[[obstacles]]\nname = \"c{k}\"\nkind = \"circle\"\ncenter_m = [{x:.2}, {y:.2}]\nradius_m = 0.05\n"
        )
    };
    let columns: String = (0..300).map(column).collect();
    let slow = bench.file("slow.toml", format!("{name}[tank]\nradius_m = 20.0\n{columns}[robot]{robot}"));
    let script = bench.file("mission.txt", "start\nkey enter\nwait until not phase waiting\n");
    let words = ["console", slow.to_str().unwrap(), "--planner", "navfn", "--script"];
    let ended = bench.tankops(&[&words[..], &[script.to_str().unwrap()]].concat());
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

#[test]
fn a_command_that_the_mission_refuses_fails_at_its_line() {
    let cases = [
        ("theme dark\nno-go 90,90 95,95\ntheme light\n", "mission.txt:2: the zone lies outside the tank"),
        (
            "speed max\nstart\nkey enter\nwait until phase running\nno-go 90,90 95,95\nwait until phase ended\n",
            "mission.txt:5: the zone lies outside the tank",
        ),
    ];
    for (script, line) in cases {
        let ended = scripted(&Bench::new(), script);
        assert!(ended.code == Some(1) && ended.err.contains(line), "{script}: {ended:?}");
    }
}

#[test]
fn plain_sentences_tell_the_mission_and_commands_come_from_stdin() {
    let bench = Bench::new();
    let mut console = Console::open(bench.command(), &["--speed", "max"]);
    console.hear("Screen 2: Plan.");
    console.hear("Enter `start` to start");
    // The end of stdin closes the console; the commands before it are carried out.
    console.order("speeed 2\nyes\ngoto home\ngoto plan\nstatus\nstart\nno\n");
    console.close();
    for line in [
        "Refused: unknown command `speeed`.",
        "No question is open: `yes` and `no` have no effect.",
        "Screen 1: Home.",
        "Enter `start` to start",
        "demo, planner rpf, T+00:00:00, speed ×max.",
        "No alarms.",
        "`yes`: start, `no`: cancel.",
    ] {
        console.hear(line);
    }
    assert_eq!(console.leave(), Some(0));
    assert_eq!(bench.runs().len(), 0, "nothing was started");
}

#[test]
fn a_configuration_file_is_checked() {
    let bench = Bench::new();
    let keys = bench.file("keys.toml", "[keys]\nzoom-in = [\"f\"]\nredraw = [\"Ctrl-A\"]\n");
    let checked = bench.tankops(&["check", keys.to_str().unwrap()]);
    assert_eq!(checked.code, Some(2), "{checked:?}");
    assert!(checked.err.contains("keys.toml:2:12: \"f\" is already follow"), "{checked:?}");
    let sound = bench.file("config.toml", "[screen]\ntheme = \"light\"\n");
    assert_eq!(bench.tankops(&["check", sound.to_str().unwrap()]).code, Some(0));
}

#[test]
fn what_is_wrong_with_the_configuration_is_on_the_home_screen() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("tankops")).unwrap();
    bench.file("tankops/config.toml", "[screen]\nthem = \"light\"\n");
    bench.file("tankops/keys.toml", "[alias]\nnight = \"theme contrast\"\n");
    let ended = scripted(&bench, "goto home\nassert text \"config.toml:2:1: unknown key\"\nnight\n");
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

#[test]
fn completions_and_manual_pages_are_printed() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish"] {
        let printed = bench.tankops(&["completions", shell]);
        assert!(printed.code == Some(0) && printed.out.contains("script"), "{shell}: {printed:?}");
    }
    let page = bench.tankops(&["man", "console"]);
    assert!(page.code == Some(0) && page.out.contains(".TH tankops-console 1"), "{page:?}");
    assert_eq!(bench.tankops(&["man", "worker"]).code, Some(2));
}

#[test]
fn a_script_waits_for_the_way_back_before_it_answers() {
    let bench = Bench::new();
    let ended = scripted(
        &bench,
        "start\nkey enter\nwait until phase running\nhold\nreturn\nkey enter\n\
         wait until phase aborted within 10m\n",
    );
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.prove(&bench.runs()[0]);
}

#[test]
fn a_coverage_planner_takes_a_new_slow_zone_under_way() {
    let bench = Bench::new();
    let script = "start\nkey enter\nwait until phase running within 10m\nset slow_m=0.6\nkey enter\nhold\n\
                  wait until phase held\nassert not alarm planner\nend\nkey enter\nwait until phase aborted\n";
    let file = bench.file("mission.txt", script);
    let cover = scenario("cover-circle.toml");
    let ended = bench.tankops(&["console", cover.to_str().unwrap(), "--script", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let run = bench.runs().remove(0);
    let events = crate::bench::journal(&run);
    let changed = crate::bench::of_kind(&events, "parameters_changed");
    assert_eq!(changed[0]["choice"]["parameters"]["slow_m"], 0.6, "{changed:?}");
    bench.prove(&run);
}
