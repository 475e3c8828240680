//! The list of all studies. Studies do not depend on the registry.

use crate::{
    account, coverage, fields, own_map, positioning, spiral,
    study::{Gallery, Result, Study, StudyError},
    surveys, tethers, traps,
};
use mission::spelling::nearest;
use std::path::Path;

/// Every study, by subject.
const STUDIES: [&[Study]; 8] = [
    spiral::STUDIES,
    traps::STUDIES,
    fields::STUDIES,
    positioning::STUDIES,
    coverage::STUDIES,
    own_map::STUDIES,
    surveys::STUDIES,
    tethers::STUDIES,
];

/// Every study.
pub fn studies() -> impl Iterator<Item = &'static Study> {
    STUDIES.into_iter().flatten()
}

/// The study with this name.
///
/// # Errors
/// No study has this name; the message suggests the most similar name.
pub fn study(name: &str) -> Result<&'static Study> {
    studies().find(|study| study.name == name).ok_or_else(|| StudyError::Refused(unknown(name)))
}

fn unknown(name: &str) -> String {
    let nearest = nearest(name, studies().map(|study| study.name));
    let hint = nearest.map(|known| format!("; did you mean `{known}`?")).unwrap_or_default();
    format!("unknown study `{name}`{hint}; `tankops reproduce --list` lists all studies")
}

/// The list of all studies and the account of the papers, as human-readable text.
pub fn list() -> String {
    let width = studies().map(|study| study.name.len()).max().unwrap_or_default();
    let line = |study: &Study| format!("{:width$}  {} ({})\n", study.name, study.about, study.layouts);
    let lines: String = studies().map(line).collect();
    format!(
        "{lines}\nIn brackets: number of layouts or draws of each case, unless changed by --layouts.\n\nThe papers, item by item:\n{}",
        account::text()
    )
}

/// A gallery in a folder for the plans or curves of a study.
///
/// # Errors
/// The study has nothing to draw, or the folder cannot be created.
pub fn gallery(study: &Study, folder: &Path) -> Result<Gallery> {
    let without = || {
        let undrawn = [own_map::STUDIES, positioning::STUDIES, surveys::STUDIES, tethers::STUDIES];
        undrawn.into_iter().flatten()
    };
    let draws = |study: &Study| without().all(|other| other.name != study.name);
    if !draws(study) {
        let drawn: Vec<String> =
            studies().filter(|study| draws(study)).map(|drawn| format!("`{}`", drawn.name)).collect();
        let why = format!("--svg draws plans and curves; only these studies have any: {}", drawn.join(", "));
        return Err(StudyError::Refused(format!("{}: {why}", study.name)));
    }
    Gallery::new(folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_study_has_a_name_of_its_own() {
        let names: Vec<&str> = studies().map(|study| study.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        assert!(names.iter().all(|name| study(name).is_ok()));
    }

    #[test]
    fn a_misspelt_name_is_answered_with_the_nearest() {
        assert!(unknown("wang-tabel1").contains("did you mean `wang-table1`"));
        assert!(!unknown("zzz").contains("did you mean"));
    }
}
