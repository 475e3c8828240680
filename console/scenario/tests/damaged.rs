//! Damaged scenarios and maps are read or refused with a message, and never cause a panic.

use mutations::{mutated, mutations};
use proptest::prelude::*;
use scenario::{Scenario, Settings};
use std::{fs, path::Path};

/// Every scenario that is shipped.
fn shipped() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let files = [folder.clone(), folder.join("papers")].into_iter().flat_map(|folder| {
        fs::read_dir(folder).expect("the folder is there").map(|entry| entry.expect("readable").path())
    });
    let mut texts: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| (path.display().to_string(), fs::read_to_string(&path).expect("a text")))
        .collect();
    texts.sort();
    texts
}

const MAP: &str = "image: floor.pgm\nresolution: 0.5\norigin: [-4.0, -4.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n\
                   free_thresh: 0.196\n";

fn image() -> Vec<u8> {
    let inside = |x: i32, y: i32| (2..14).contains(&x) && (2..14).contains(&y);
    let cells = (0..256).map(|i| if inside(i % 16, i / 16) { 254 } else { 0 });
    b"P5\n# a floor\n16 16\n255\n".iter().copied().chain(cells).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_damaged_scenario_is_refused_with_a_place_or_is_read(
        at in any::<prop::sample::Index>(),
        damage in mutations(),
    ) {
        let texts = shipped();
        let (name, text) = at.get(&texts);
        let text = String::from_utf8_lossy(&mutated(text.as_bytes(), &damage)).into_owned();
        if let Err(errors) = Scenario::parse(&text, name) {
            prop_assert!(!errors.problems.is_empty());
            let shown = errors.render();
            prop_assert!(shown.contains(name.as_str()) && shown.len() < 1_000_000, "{}", shown);
        }
    }

    #[test]
    fn a_damaged_map_is_refused_with_its_file_or_is_read(
        in_image in any::<bool>(),
        damage in mutations(),
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut yaml, mut pgm) = (MAP.as_bytes().to_vec(), image());
        let hit = if in_image { &mut pgm } else { &mut yaml };
        *hit = mutated(hit, &damage);
        fs::write(folder.path().join("floor.yaml"), yaml).expect("writable");
        fs::write(folder.path().join("floor.pgm"), pgm).expect("writable");
        let text = SMALL.replace("radius_m = 5.0", "map = \"floor.yaml\"");
        let file = folder.path().join("scenario.toml");
        fs::write(&file, text).expect("writable");
        if let Err(errors) = Scenario::read_with(&file, &Settings::default()) {
            prop_assert!(!errors.problems.is_empty() && !errors.render().is_empty());
        }
    }
}

const SMALL: &str = r#"
name = "small"

[tank]
radius_m = 5.0

[robot]
start_m = [0.0, 0.0]

[ae]
stations = [{ name = "A", at_m = [2.9, 0.0] }, { name = "B", at_m = [0.0, 2.9] }]

[mission]
kind = "goto"
goal_m = [1.0, 0.0]

[planner]
id = "apf"
"#;

#[test]
fn what_is_damaged_above_is_good_before() {
    for (name, text) in shipped().iter().filter(|(_, text)| !text.contains("map =")) {
        Scenario::parse(text, name).unwrap_or_else(|errors| panic!("{}", errors.render()));
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("floor.yaml"), MAP).expect("writable");
    fs::write(folder.path().join("floor.pgm"), image()).expect("writable");
    let file = folder.path().join("scenario.toml");
    fs::write(&file, SMALL.replace("radius_m = 5.0", "map = \"floor.yaml\"")).expect("writable");
    Scenario::read_with(&file, &Settings::default()).unwrap_or_else(|errors| panic!("{}", errors.render()));
}
