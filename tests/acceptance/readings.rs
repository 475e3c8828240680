//! Readings of a simulated instrument: their file, and one set of findings in every output.

use crate::bench::{Bench, scenario};
use recording::{READINGS_FILE, sha256};
use serde_json::Value;
use std::fs;

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
    assert_eq!(places.len(), with_welds + count);
    assert_eq!(read("r-follow-up.csv").lines().count(), 1 + places.len());
    let area_m2: f64 = places.iter().filter_map(|place| place["area_m2"].as_f64()).sum();
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
