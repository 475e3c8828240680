//! Readings of an instrument, simulated or imported: their file, and one set of findings in every output.

use crate::bench::{Bench, scenario};
use account::Reading;
use recording::{READINGS_FILE, each_reading, sha256};
use serde_json::Value;
use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

#[test]
fn readings_are_kept_beside_the_run_and_made_again_from_its_journal() {
    let bench = Bench::new();
    let flown = bench.fly(&scenario("inspect-circle.toml"), &[]);
    assert_eq!(flown.code, Some(0), "{flown:?}");
    let (flown, run) = (flown.json(), bench.runs().pop().unwrap());
    let file = run.join(READINGS_FILE);
    let digest = sha256(&file).unwrap();
    assert_eq!(flown["readings_sha256"], digest.as_str());
    bench.prove(&run);
    let name = run.to_str().unwrap();
    let exported = bench.tankops(&["export", name, "--readings", "again.parquet"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    assert_eq!(sha256(&bench.path().join("again.parquet")).unwrap(), digest);
    let mut damaged = fs::read(&file).unwrap();
    damaged[1000] ^= 1;
    fs::write(&file, damaged).unwrap();
    let report = bench.tankops(&["report", name]);
    assert!(report.out.contains("readings.parquet is not the file written with the run"), "{report:?}");
}

/// The readings of a run as a table with the clock of the instrument, which is an hour behind.
fn table(run: &Path, is_kept: impl Fn(&Reading) -> bool) -> String {
    let mut table = "t_s,channel,thickness_mm\n".to_owned();
    let row = |of: Reading| {
        if is_kept(&of) {
            let clock_s = of.t_s - 3600.0;
            writeln!(table, "{clock_s:.3},{},{:.2}", of.channel, of.thickness_mm).unwrap();
        }
    };
    each_reading(&run.join(READINGS_FILE), row).unwrap();
    table
}

/// A run of two minutes over a floor that is simulated, and the same run over one that is not.
fn simulated_and_real(bench: &Bench) -> (PathBuf, PathBuf) {
    let text = fs::read_to_string(scenario("inspect-circle.toml")).unwrap();
    let wear = text.find("[wear]").unwrap();
    let end = wear + text[wear..].find("[[obstacles]]").unwrap();
    let real = bench
        .file("real.toml", format!("{}{}", &text[..wear], &text[end..]).replace("inspect-circle", "real"));
    bench.fly(&scenario("inspect-circle.toml"), &["--set", "mission.time_limit_s=120"]);
    let simulated = bench.runs().pop().unwrap();
    bench.fly(&real, &["--set", "mission.time_limit_s=120"]);
    let real = bench.runs().into_iter().find(|run| *run != simulated).unwrap();
    (simulated, real)
}

/// The indications in the report on a run: place and depth.
fn losses(bench: &Bench, run: &Path) -> Vec<[f64; 3]> {
    assert_eq!(bench.tankops(&["report", run.to_str().unwrap(), "-o", "r.json", "--force"]).code, Some(0));
    let json = fs::read_to_string(bench.path().join("r.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let loss =
        |loss: &Value| [&loss["at"][0], &loss["at"][1], &loss["depth_mm"]].map(|v| v.as_f64().unwrap());
    json["thickness"]["losses"].as_array().unwrap().iter().map(loss).collect()
}

#[test]
fn readings_of_an_instrument_with_another_clock_give_the_findings_of_the_simulation() {
    let bench = Bench::new();
    let (simulated, real) = simulated_and_real(&bench);
    let (simulated_name, name) = (simulated.to_str().unwrap(), real.to_str().unwrap());
    bench.file("scan.csv", table(&simulated, |_| true));
    let refused = bench.tankops(&["readings", name, "scan.csv"]);
    assert!(refused.code == Some(2) && refused.err.contains("--clock-offset 3600"), "{refused:?}");
    assert!(!real.join(READINGS_FILE).exists(), "nothing is kept of a refused file");
    let on_simulated = bench.tankops(&["readings", simulated_name, "scan.csv", "--force"]);
    assert!(on_simulated.code == Some(2) && on_simulated.err.contains("[wear]"), "{on_simulated:?}");
    let placed = bench.tankops(&["readings", name, "scan.csv", "--mark", "-3600=0", "--json"]);
    assert_eq!(placed.code, Some(0), "{placed:?}");
    let placed = placed.json();
    let (ours, theirs) = (losses(&bench, &real), losses(&bench, &simulated));
    assert!(ours.len() >= 5 && placed["readings"]["indications"] == ours.len(), "{placed}");
    assert_eq!(ours.len(), theirs.len());
    for (ours, theirs) in ours.iter().zip(&theirs) {
        assert!(ours.iter().zip(theirs).all(|(a, b)| (a - b).abs() < 0.011), "{ours:?} {theirs:?}");
    }
    let again = bench.tankops(&["readings", name, "scan.csv", "--mark", "-3600=0"]);
    assert!(again.code == Some(2) && again.err.contains("--force"), "{again:?}");
    fs::copy(simulated.join(READINGS_FILE), real.join(READINGS_FILE)).unwrap();
    let report = bench.tankops(&["report", name]);
    assert!(report.out.contains("imported"), "{report:?}");
    // A package says by itself that the readings were exchanged before it was made.
    let packed = bench.tankops(&["report", name, "--package", "a.zip"]);
    let why = "readings.parquet is not the file that was imported";
    assert!(
        packed.code == Some(0) && packed.out.contains("WARNING") && packed.out.contains(why),
        "{packed:?}"
    );
    let verified = bench.tankops(&["verify", "a.zip"]);
    assert!(verified.code == Some(1) && verified.out.contains(why), "{verified:?}");
    fs::remove_file(real.join("readings.json")).unwrap();
    let report = bench.tankops(&["report", name]);
    assert!(
        report.out.contains("does not belong to this run, because readings.json is missing"),
        "{report:?}"
    );
}

#[test]
fn a_dead_channel_is_named_and_faulty_rows_are_kept_aside() {
    let bench = Bench::new();
    let (simulated, real) = simulated_and_real(&bench);
    let name = real.to_str().unwrap();
    let is_alive = |reading: &Reading| reading.channel != 7 || !(30.0..90.0).contains(&reading.t_s);
    let rows = table(&simulated, is_alive);
    let line = rows.lines().count() + 1;
    bench.file("scan.csv", &(rows + "-3590.0,3,-1.0\n9000.0,3,8.0\n-3590.0,99,8.0\n-3580.0,3,\"7,9\"\n"));
    let arguments = ["readings", name, "scan.csv", "--clock-offset", "3600"];
    let refused = bench.tankops(&arguments);
    assert_eq!(refused.code, Some(2), "{refused:?}");
    for (off, what) in ["not negative", "after the end", "channel 99", "decimal comma"].iter().enumerate() {
        let fault = refused.err.lines().find(|text| text.contains(&format!("line {},", line + off)));
        assert!(fault.is_some_and(|fault| fault.contains(what)), "{what}: {refused:?}");
    }
    let placed = bench.tankops(&[&arguments[..], &["--skip-bad-rows"]].concat());
    assert_eq!(placed.code, Some(0), "{placed:?}");
    assert!(placed.out.contains("channel 7: no readings from 00:00:"), "{placed:?}");
    let aside = fs::read_to_string(real.join("readings-refused.csv")).unwrap();
    assert_eq!(aside.lines().count(), 5, "{aside}");
    losses(&bench, &real);
    let json = fs::read_to_string(bench.path().join("r.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    assert!(json["thickness"]["unread_m2"].as_f64().unwrap() > 0.0);
    assert!(json["thickness"]["imported"][0]["notes"].to_string().contains("channel 7"), "{json}");
    // The floor under the dead channel does not count as scanned, unlike in the run without the import.
    assert!(json.to_string().contains("while channel 7 was dead"), "{json}");
    losses(&bench, &simulated);
    let whole = fs::read_to_string(bench.path().join("r.json")).unwrap();
    assert!(!whole.contains("was dead"), "{whole}");
}

#[test]
fn text_json_csv_html_and_recording_have_the_same_findings() {
    let bench = Bench::new();
    let flown = bench.fly(&scenario("inspect-circle.toml"), &[]).json();
    let run = bench.runs().pop().unwrap();
    let name = run.to_str().unwrap();
    for file in ["r.html", "r.json", "r.csv"] {
        assert_eq!(bench.tankops(&["report", name, "-o", file]).code, Some(0));
    }
    let read = |file: &str| fs::read_to_string(bench.path().join(file)).unwrap();
    let (html, json, plates) = (read("r.html"), read("r.json"), read("r.csv"));
    let json: Value = serde_json::from_str(&json).unwrap();
    let losses = json["thickness"]["losses"].as_array().unwrap();
    let count = losses.len();
    assert!(count >= 10, "{losses:?}");
    assert_eq!(flown["readings"]["indications"], count);
    assert_eq!(json["indications"].as_array().unwrap().len(), count);
    assert_eq!(read("r-indications.csv").lines().count(), 1 + count);
    assert!(html.contains(&format!("{count} with a loss of at least 1.6 mm")), "{count}");
    let text = bench.tankops(&["report", name]).out;
    assert!(text.contains(&format!("beside welds; {count} indications")), "{text}");
    let figures = recording::inspect(&run.join(recording::RECORDING_FILE)).unwrap().figures;
    assert_eq!(figures["indications"].to_bits(), (count as f64).to_bits());
    for plate in json["thickness"]["plates"].as_array().unwrap() {
        let name = plate["plate"].as_str().unwrap();
        let row = plates.lines().find(|line| line.starts_with(&format!("{name},"))).unwrap();
        let of = |key: &str| format!("{:.2}", plate[key].as_f64().unwrap());
        let end = format!(",{},{},{},{}", plate["readings"], of("least_mm"), of("p5_mm"), of("mean_mm"));
        assert!(row.ends_with(&end), "{row} does not end with {end}");
    }
    // Every plate with welds and every indication is followed up once, each from the place before it.
    let places = json["follow_ups"].as_array().unwrap();
    let with_welds = json["floor"]["plates"].as_array().unwrap().iter();
    let with_welds = with_welds.filter(|plate| plate["untestable"].as_f64().unwrap() > 0.0).count();
    let is_unread = |place: &&Value| place["what"] == "no reading, though scanned";
    let unread = places.iter().filter(is_unread).count();
    assert_eq!(places.len(), with_welds + count + unread);
    assert_eq!(read("r-follow-up.csv").lines().count(), 1 + places.len());
    let area_of = |is_in: &dyn Fn(&&Value) -> bool| -> f64 {
        places.iter().filter(is_in).filter_map(|place| place["area_m2"].as_f64()).sum()
    };
    let unread_m2 = json["thickness"]["unread_m2"].as_f64().unwrap();
    assert!((area_of(&is_unread) - unread_m2).abs() < 1e-9 && unread_m2 < 0.1, "{unread_m2}");
    let area_m2 = area_of(&|place| !is_unread(place));
    let whole = &json["floor"]["whole"];
    let untestable_m2 = whole["untestable"].as_f64().unwrap() * whole["area_m2"].as_f64().unwrap();
    assert!((area_m2 - untestable_m2).abs() < 1e-9, "{area_m2} of {untestable_m2} m²");
    // The pit that the scenario places at (-1.1, 0.9) with 5.5 mm.
    let near = |loss: &&Value| {
        let at = |k: usize| loss["at"][k].as_f64().unwrap();
        (at(0) + 1.1).hypot(at(1) - 0.9) < 0.06
    };
    let pit = losses.iter().find(near).unwrap();
    assert!((pit["depth_mm"].as_f64().unwrap() - 5.5).abs() < 1.0, "{pit}");
    // Losses above 40 % of the thickness are found, and nothing is found where no metal is lost.
    let detections = &json["thickness"]["detections"];
    assert_eq!(detections["false_calls"], 0, "{detections}");
    for class in &detections["classes"].as_array().unwrap()[1..] {
        assert_eq!(class["losses"], class["found"], "{detections}");
    }
}

#[test]
fn a_run_without_readings_is_bad_input_and_messages_for_ros_tools_are_the_same_twice() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let name = run.to_str().unwrap();
    let refused = bench.tankops(&["export", name, "--readings", "none.parquet"]);
    assert!(refused.code == Some(2) && refused.err.contains("this run has no readings"), "{refused:?}");
    let [one, other] = ["one.mcap", "other.mcap"].map(|file| {
        let exported = bench.tankops(&["export", name, "--mcap", file]);
        assert_eq!(exported.code, Some(0), "{exported:?}");
        fs::read(bench.path().join(file)).unwrap()
    });
    assert!(one == other, "the same run gives the same bytes");
}
