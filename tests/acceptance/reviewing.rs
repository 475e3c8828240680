//! Past runs in the console: playback, notes, comparison.

use crate::bench::{Bench, change_journal, journal_text, scenario};
use std::path::Path;

/// Runs a short mission and returns its folder.
fn flown(bench: &Bench, seed: &str) -> std::path::PathBuf {
    let ended = bench.fly(&scenario("goto-single-obstacle.toml"), &["--seed", seed]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.runs().into_iter().find(|run| run.to_string_lossy().ends_with(&format!("-{seed}"))).unwrap()
}

fn replayed(bench: &Bench, arguments: &[&str], script: &str) -> crate::bench::Ended {
    let file = bench.file("review.txt", script);
    bench.tankops(&[&["replay"][..], arguments, &["--script", file.to_str().unwrap()]].concat())
}

fn name(run: &Path) -> &str {
    run.file_name().unwrap().to_str().unwrap()
}

#[test]
fn a_mission_is_flown_then_reviewed_in_one_session_and_its_journal_stays_as_it_is() {
    let bench = Bench::new();
    let script = "speed max\nstart\nkey enter\nwait until phase running within 1m\nwait until screen result within 2m\nreplay latest\n\
                  wait until text \"all loaded\" within 30s\nassert text REPLAY\nassert text \"T+00:00:00\"\n\
                  key space\nwait until text \"T+00:00:02\" within 20s\nkey space\nassert text \"‖ PAUSE\"\n\
                  seek 00:30\nwait until text \"T+00:00:30\" within 5s\nbookmark \"pump noise\"\n\
                  remark \"first pass\"\nkey $\nwait until phase complete within 5s\nassert coverage >= 80\n\
                  key ^\nwait until text \"T+00:00:00\" within 5s\nkey n\nwait until text \"pump noise\" within 5s\n\
                  key ]\nkey 7\nassert screen result\nreview\nwait until text \"first pass\" within 10s\n";
    let file = bench.file("mission.txt", script);
    let ended = bench.tankops(&["console", "--script", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let run = &bench.runs()[0];
    bench.prove(run);
    let notes = std::fs::read_to_string(run.join("notes.json")).unwrap();
    assert!(notes.contains("pump noise") && notes.contains("first pass"), "{notes}");
    let listed = bench.tankops(&["runs"]);
    assert!(listed.out.contains("[first pass; 1 bookmark]"), "{listed:?}");
}

#[test]
fn a_replay_takes_no_orders_and_leaves_faulty_notes_alone() {
    let bench = Bench::new();
    let run = flown(&bench, "3");
    std::fs::write(run.join("notes.json"), "{ \"remark\": 3 }").unwrap();
    let refused = replayed(&bench, &[name(&run)], "wait until text \"all loaded\" within 30s\nstart\n");
    assert!(refused.err.contains("replay, no robot connected"), "{refused:?}");
    let refused = replayed(&bench, &["latest"], "wait until text \"all loaded\" within 30s\nremark \"x\"\n");
    assert!(refused.err.contains("notes.json:1:13: invalid type"), "{refused:?}");
    assert_eq!(std::fs::read_to_string(run.join("notes.json")).unwrap(), "{ \"remark\": 3 }");
}

#[test]
fn a_script_that_waits_in_a_paused_replay_is_told_to_play_it() {
    let bench = Bench::new();
    let run = flown(&bench, "3");
    let paused = replayed(&bench, &[name(&run)], "wait until phase ended within 1s\n");
    assert!(paused.code == Some(1) && paused.err.contains("write `play` before this line"), "{paused:?}");
    let played = replayed(&bench, &[name(&run)], "speed max\nplay\nwait until phase ended\n");
    assert_eq!(played.code, Some(0), "{played:?}");
}

#[test]
fn two_runs_are_compared_from_the_command_line() {
    let bench = Bench::new();
    let (one, other) = (flown(&bench, "3"), flown(&bench, "4"));
    let script = "wait until text \"aligned by time\" within 30s\nkey T\nwait until text \"path share\" within 5s\n\
                  key D\nreview\nwait until text \"same scenario, different seed, same planner\" within 30s\nassert text \"A-B\"\n";
    let ended = replayed(&bench, &[name(&one), "--compare", name(&other)], script);
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

#[test]
fn a_journal_that_is_cut_off_plays_up_to_its_last_event_and_a_run_that_is_not_there_is_named() {
    let bench = Bench::new();
    let run = flown(&bench, "3");
    let text = journal_text(&run);
    change_journal(&run, &text[..text.len() / 2]);
    let script = "wait until text \"is cut off after\" within 30s\nkey $\nassert text REPLAY\n";
    let ended = replayed(&bench, &[name(&run)], script);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let ended = replayed(&bench, &["nothing"], "theme dark\n");
    assert!(ended.code == Some(2) && ended.err.contains("nothing"), "{ended:?}");
}
