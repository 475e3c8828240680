//! The user's folders, according to the XDG base directory specification.

use std::env;
use std::path::PathBuf;

/// Returns the path of the folder `tankops` inside the folder that the environment variable names. If the variable is
/// not set to an absolute path, uses the folder `otherwise` of the user's home instead. Returns `None` if the home is
/// unknown, too.
pub fn user_folder(variable: &str, otherwise: &str) -> Option<PathBuf> {
    let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // The specification requires paths that are not absolute to be ignored.
    let base = set(variable).filter(|path| path.is_absolute());
    base.or_else(|| Some(set("HOME")?.join(otherwise))).map(|base| base.join("tankops"))
}
