//! Folders of the user, by the XDG base directory specification.

use std::env;
use std::path::PathBuf;

/// The folder of tankops in the one that a variable names, or else in this one of the user's home; `None` without either.
pub fn user_folder(variable: &str, otherwise: &str) -> Option<PathBuf> {
    let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // The specification asks to ignore a path that is not absolute.
    let base = set(variable).filter(|path| path.is_absolute());
    base.or_else(|| Some(set("HOME")?.join(otherwise))).map(|base| base.join("tankops"))
}
