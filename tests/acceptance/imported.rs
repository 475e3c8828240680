//! Floors from the files of other programs.

use crate::bench::{Bench, scenario};

/// A drawing in millimetres whose layers have the names of another language: shell, four columns as a block and its hatch.
fn drawing() -> String {
    let groups = "0 SECTION,2 HEADER,9 $INSUNITS,70 4,0 ENDSEC,0 SECTION,2 BLOCKS,0 BLOCK,8 0,2 Post,10 0,20 0,\
                  0 CIRCLE,8 0,10 0,20 0,40 250,0 ENDBLK,0 ENDSEC,0 SECTION,2 ENTITIES,\
                  0 CIRCLE,8 Mantel,10 0,20 0,40 6000,\
                  0 INSERT,8 Stuetzen,2 POST,10 -2000,20 -2000,70 2,71 2,44 4000,45 4000,\
                  0 HATCH,8 Stuetzen,10 0,20 0,30 0,2 SOLID,91 1,92 7,72 1,73 1,93 2,10 1750,20 2000,42 1,10 2250,20 2000,42 1,97 0,\
                  0 TEXT,8 Text,10 0,20 0,1 Tank 7,0 ENDSEC,0 EOF";
    groups.split(',').map(|pair| pair.replacen(' ', "\n", 1) + "\n").collect()
}

#[test]
fn a_drawing_with_layers_of_other_names_becomes_a_mission_that_is_flown() {
    let bench = Bench::new();
    bench.file("floor.dxf", drawing());
    let refused = bench.tankops(&["import", "floor.dxf", "-o", "floor.toml"]);
    assert_eq!(refused.code, Some(2), "{refused:?}");
    let layers = "layers: `Mantel` (1 CIRCLE), `Stuetzen` (4 CIRCLE, 1 HATCH), `Text` (1 TEXT)";
    assert!(refused.err.contains("--layer SHELL=0") && refused.err.contains(layers), "{refused:?}");

    let named = ["--layer", "SHELL=Mantel", "--layer", "COLUMNS=Stuetzen", "--svg", "floor.svg"];
    let imported = bench.tankops(&[&["import", "floor.dxf", "-o", "floor.toml"], &named[..]].concat());
    assert_eq!(imported.code, Some(0), "{imported:?}");
    assert!(
        imported.out.contains("round tank of 6.000 m radius, 4 obstacles, 0 no-go areas"),
        "{imported:?}"
    );
    assert!(imported.out.contains("note: not used: layer Text: TEXT, 1 of them"), "{imported:?}");
    let svg = std::fs::read_to_string(bench.path().join("floor.svg")).unwrap();
    assert!(svg.matches("<circle").count() >= 5, "shell and columns: {svg}");
    let flown = bench.tankops(&["run", "floor.toml", "--no-record", "--json"]);
    assert_eq!((&flown.json()["outcome"], flown.code), (&"complete".into(), Some(0)), "{flown:?}");

    let wrong = bench.tankops(&["import", "floor.dxf", "-o", "other.toml", "--layer", "POSTS=Stuetzen"]);
    assert!(wrong.code == Some(2) && wrong.err.contains("as in COLUMNS=Posts"), "{wrong:?}");
}

/// A round tank whose plates are drawn by their seams: a ring with four joints, and a cross within.
fn plated() -> String {
    let groups = "0 SECTION,2 HEADER,9 $INSUNITS,70 6,0 ENDSEC,0 SECTION,2 ENTITIES,\
                  0 CIRCLE,8 SHELL,10 0,20 0,40 3,0 CIRCLE,8 PLATES,10 0,20 0,40 2.4,\
                  0 LINE,8 PLATES,10 -3,20 0,11 3,21 0,0 LINE,8 PLATES,10 0,20 -3,11 0,21 3,\
                  0 TEXT,8 PLATES,10 1,20 1,1 B & C,0 TEXT,8 0,10 -2,20 1.9,1 A-1,0 ENDSEC,0 EOF";
    groups.split(',').map(|pair| pair.trim().replacen(' ', "\n", 1) + "\n").collect()
}

#[test]
fn plates_of_a_drawing_are_accounted_for_one_by_one_in_every_report() {
    let bench = Bench::new();
    bench.file("floor.dxf", plated());
    let imported = bench.tankops(&["import", "floor.dxf", "-o", "floor.toml", "--svg", "floor.svg"]);
    assert!(imported.code == Some(0) && imported.out.contains(", 8 plates"), "{imported:?}");
    let read = |name: &str| std::fs::read_to_string(bench.path().join(name)).unwrap();
    assert!(read("floor.svg").contains("B &amp; C"));
    let scenario = bench.path().join("floor.toml");
    bench.fly(&scenario, &[]);
    let run = bench.runs().pop().unwrap().to_str().unwrap().to_owned();
    for file in ["r.html", "r.json", "r.csv", "r.dxf"] {
        let report = bench.tankops(&["report", &run, "-o", file]);
        assert_eq!(report.code, Some(0), "{report:?}");
    }
    let json: serde_json::Value = serde_json::from_str(&read("r.json")).unwrap();
    let plates = json["floor"]["plates"].as_array().unwrap();
    let names: Vec<&str> = plates.iter().map(|plate| plate["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["A-1", "P-01", "P-02", "P-06", "B & C", "P-03", "P-04", "P-05"], "annular ones first");
    let quarters = [(0..4, 2.545), (4..8, 4.524)];
    for (range, wanted_m2) in quarters {
        for plate in &plates[range] {
            let area_m2 = plate["area_m2"].as_f64().unwrap();
            assert!((area_m2 - wanted_m2).abs() < 0.1, "{plate}");
            assert!(plate["percent"]["scanned"].as_f64().unwrap() > 50.0, "{plate}");
        }
    }
    assert!(read("r.csv").lines().any(|line| line.starts_with("B & C,")), "{}", read("r.csv"));
    assert!(read("r.html").contains("B &amp; C") && !read("r.html").contains("B & C"));
    assert!(read("r.dxf").matches("\n8\nPLATES\n").count() > 8);
}

#[test]
fn a_map_is_shown_with_what_became_of_it() {
    let bench = Bench::new();
    let map = scenario("maps/corridor.yaml");
    let shown = bench.tankops(&["map", map.to_str().unwrap(), "--svg", "map.svg"]);
    assert!(shown.code == Some(0) && shown.out.contains("towards the safe side"), "{shown:?}");
    let svg = std::fs::read_to_string(bench.path().join("map.svg")).unwrap();
    let pieces: usize = shown
        .out
        .lines()
        .find_map(|line| line.strip_prefix("convex pieces"))
        .unwrap()
        .trim()
        .parse()
        .unwrap();
    assert!(pieces > 0 && svg.matches("<polygon").count() >= pieces, "{pieces}");
}
