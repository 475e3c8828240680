//! The user's folders, according to the XDG base directory specification.

use std::env;
use std::path::PathBuf;

/// Returns the folder of tankops, which is inside the folder that an environment variable names or, failing that,
/// inside this folder of the user's home; `None` if there is neither.
pub fn user_folder(variable: &str, otherwise: &str) -> Option<PathBuf> {
    let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // The specification requires paths that are not absolute to be ignored.
    let base = set(variable).filter(|path| path.is_absolute());
    base.or_else(|| Some(set("HOME")?.join(otherwise))).map(|base| base.join("tankops"))
}
