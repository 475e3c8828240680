//! Tests the program by starting it.

use std::process::Command;

#[test]
fn the_account_is_listed_and_what_is_not_known_is_refused() {
    let research = |words: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_tankops-research")).args(words).output().expect("it is built")
    };
    let listed = research(&["reproduce"]);
    let text = String::from_utf8_lossy(&listed.stdout).into_owned();
    assert!(listed.status.success() && text.contains("wang-table1"), "{listed:?}");
    let unknown = research(&["reproduce", "wang-tabel1"]);
    let why = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(unknown.status.code() == Some(2) && why.contains("did you mean `wang-table1`?"), "{unknown:?}");
}
