//! Nothing on the screen is cut: a walk through all stored screens.

use std::fs;
use std::path::Path;

/// The titles on a row of the screen, each from the corner of its frame to the opposite corner; not what is seen between
/// two frames.
fn titles(row: &str) -> impl Iterator<Item = &str> {
    let between = row.split('┌').skip(1).filter_map(|rest| Some(rest.split_once('┐')?.0));
    between.filter(|title| !title.contains('│'))
}

#[test]
#[expect(clippy::disallowed_methods, reason = "the stored screens are files")]
fn no_frame_cuts_its_title() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/console/snapshots");
    let mut n_titles = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "snap") {
            continue;
        }
        for row in fs::read_to_string(&path).unwrap().lines() {
            for title in titles(row) {
                n_titles += 1;
                assert!(title.ends_with('─'), "{}: {row}", path.display());
            }
        }
    }
    assert!(n_titles > 500, "{n_titles}");
}
