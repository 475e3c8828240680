//! Floors imported from files of other programs.

use crate::bench::{Bench, scenario};

/// A drawing in millimetres with layer names in a different language: a shell, and four columns as a block with its
/// hatch.
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
        imported.out.contains("round tank of 6.000 m radius, 4 obstacles, 0 no-go zones"),
        "{imported:?}"
    );
    assert!(imported.out.contains("note: not used: layer Text: TEXT (1)"), "{imported:?}");
    let svg = std::fs::read_to_string(bench.path().join("floor.svg")).unwrap();
    assert!(svg.matches("<circle").count() >= 5, "shell and columns: {svg}");
    let flown = bench.tankops(&["run", "floor.toml", "--no-record", "--json"]);
    assert_eq!((&flown.json()["outcome"], flown.code), (&"complete".into(), Some(0)), "{flown:?}");

    let wrong = bench.tankops(&["import", "floor.dxf", "-o", "other.toml", "--layer", "POSTS=Stuetzen"]);
    assert!(wrong.code == Some(2) && wrong.err.contains("for example COLUMNS=Posts"), "{wrong:?}");
}

/// A round tank with plates drawn by their seams: a ring with four joints, and a cross inside.
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
    assert!(shown.code == Some(0) && shown.out.contains("on the safe side"), "{shown:?}");
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

#[test]
fn the_drawing_of_a_report_is_read_back_with_its_plates_and_obstacles() {
    let bench = Bench::new();
    bench.fly(&scenario("cover-circle.toml"), &[]);
    let run = bench.runs().pop().unwrap().to_str().unwrap().to_owned();
    for file in ["r.dxf", "r.json"] {
        assert_eq!(bench.tankops(&["report", &run, "-o", file]).code, Some(0));
    }
    let imported = bench.tankops(&["import", "r.dxf", "-o", "back.toml"]);
    assert_eq!(imported.code, Some(0), "{imported:?}");
    let read = |name: &str| std::fs::read_to_string(bench.path().join(name)).unwrap();
    let report: serde_json::Value = serde_json::from_str(&read("r.json")).unwrap();
    let name = |plate: &serde_json::Value| plate["name"].as_str().unwrap().to_owned();
    let mut drawn: Vec<String> = report["floor"]["plates"].as_array().unwrap().iter().map(name).collect();
    drawn.sort();
    let back: toml::Table = read("back.toml").parse().unwrap();
    let outlines = back["plates"]["outlines"].as_array().unwrap();
    let mut names: Vec<&str> = outlines.iter().map(|plate| plate["name"].as_str().unwrap()).collect();
    names.sort_unstable();
    assert_eq!(names, drawn);
    let first: toml::Table = std::fs::read_to_string(scenario("cover-circle.toml")).unwrap().parse().unwrap();
    let count = |text: &toml::Table| text["obstacles"].as_array().unwrap().len();
    assert_eq!(count(&back), count(&first));
    assert_eq!(back["planner"]["id"].as_str(), Some("tether-safe"));
}

#[test]
fn the_standard_input_is_a_scenario_a_drawing_or_a_list() {
    let bench = Bench::new();
    let piped = |arguments: &[&str], text: &[u8]| {
        use std::{io::Write, process::Stdio};
        let mut child = bench
            .command()
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(text).unwrap();
        let output = child.wait_with_output().unwrap();
        let told =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), told)
    };
    let goto = std::fs::read(scenario("goto-single-obstacle.toml")).unwrap();
    assert_eq!(piped(&["check", "-"], &goto).0, Some(0));
    assert_eq!(piped(&["run", "-", "--no-record"], &goto).0, Some(0));
    assert_eq!(piped(&["plan", "-"], &goto).0, Some(0));
    let (code, told) = piped(&["check", "-"], b"nonsense");
    assert!(code == Some(2) && told.contains("error: standard input:1:"), "{told}");
    let (code, told) = piped(&["import", "-", "-o", "d.toml"], plated().as_bytes());
    assert!(code == Some(0) && told.contains(", 8 plates"), "{told}");
    let list = b"x_m;y_m;radius_m\n1;2;0,3\n";
    let (code, told) = piped(&["import", "-", "-o", "l.toml", "--tank-radius", "6"], list);
    assert!(code == Some(0) && told.contains("1 obstacle, "), "{told}");
    let (code, told) = piped(&["import", "-", "-o", "none.toml", "--tank-radius", "6"], b"");
    assert!(code == Some(2) && told.contains("standard input: is empty"), "{told}");
}

#[test]
fn a_scenario_in_another_encoding_is_named_with_line_and_remedy() {
    let bench = Bench::new();
    let text = "# A tank\nname = \"Öl\"\n";
    bench.file("latin.toml", text.chars().map(|letter| letter as u8).collect::<Vec<u8>>());
    let wide: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    bench.file("wide.toml", &wide);
    bench.file("bare.toml", &wide[2..]);
    for (file, told) in [
        (
            "latin.toml",
            "ISO-8859-1 instead of UTF-8, judging by line 2\nhelp: save it as UTF-8: `iconv -f ISO-8859-1 -t UTF-8 FILE > NEW`",
        ),
        (
            "wide.toml",
            "UTF-16 instead of UTF-8, judging by the first line\nhelp: save it as UTF-8: `iconv -f UTF-16 -t",
        ),
        ("bare.toml", "UTF-16LE instead of UTF-8, judging by the first line\nhelp:"),
    ] {
        let checked = bench.tankops(&["check", file]);
        assert!(checked.code == Some(2) && checked.err.contains(told), "{checked:?}");
    }
}

#[test]
fn a_planner_that_proves_that_no_way_exists_has_not_failed() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    // A ring of straight walls around the goal.
    let mut table: toml::Table = text.parse().unwrap();
    let goal = table["mission"]["goal_m"].clone();
    let [x, y] = [0, 1].map(|k| goal[k].as_float().or(goal[k].as_integer().map(|v| v as f64)).unwrap());
    let ring = format!(
        "name = \"ring\"\nkind = \"polyline\"\nwidth_m = 0.1\npoints_m = [[{}, {}], [{}, {}], [{}, {}], [{}, {}], [{}, {}]]",
        x - 0.8,
        y - 0.8,
        x + 0.8,
        y - 0.8,
        x + 0.8,
        y + 0.8,
        x - 0.8,
        y + 0.8,
        x - 0.8,
        y - 0.8
    );
    let ring: toml::Table = ring.parse().unwrap();
    let obstacles = table.entry("obstacles").or_insert_with(|| toml::Value::Array(Vec::new()));
    obstacles.as_array_mut().unwrap().push(ring.into());
    table.remove("expect");
    bench.file("shut.toml", table.to_string());
    for planner in ["navfn", "shortest"] {
        let flown = bench.tankops(&["run", "shut.toml", "--no-record", "--json", "--planner", planner]);
        let report = flown.json();
        assert_eq!(
            (&report["outcome"], &report["planner_faults"]),
            (&"stuck".into(), &0.into()),
            "{flown:?}"
        );
        assert!(flown.code == Some(1) && report["reason"].as_str().unwrap().contains("proved"), "{flown:?}");
    }
}
