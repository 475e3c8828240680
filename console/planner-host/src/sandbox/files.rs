//! Landlock: at first the process can read only libraries, then nothing at all.

use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, PathBeneath, PathFd, Ruleset,
    RulesetAttr, RulesetCreatedAttr, RulesetError, RulesetStatus, Scope,
};

/// The folders in which the loader searches for libraries.
pub(super) const LIBRARIES: [&str; 4] = ["/lib", "/lib64", "/usr/lib", "/usr/lib64"];
/// The index in which the loader looks up the folder of a library.
pub(super) const LIBRARY_CACHE: &str = "/etc/ld.so.cache";
/// The newest rules in use. Older kernels enforce the rules that they support, and seccomp blocks the calls that the
/// other rules would cover.
const RULES: ABI = ABI::V6;

/// Removes all access except for reading libraries, from this thread and from those that it starts.
pub(super) fn only_libraries() -> Result<(), String> {
    enforced(restrict(&LIBRARIES, &[LIBRARY_CACHE]))
}

/// Removes access to libraries, too.
pub(crate) fn nothing() -> Result<(), String> {
    enforced(restrict(&[], &[]))
}

fn enforced(status: Result<RulesetStatus, RulesetError>) -> Result<(), String> {
    match status {
        Ok(RulesetStatus::NotEnforced) => Err("not supported by this kernel, or disabled".to_owned()),
        Ok(_) => Ok(()),
        Err(error) => Err(error.to_string()),
    }
}

fn restrict(folders: &[&str], files: &[&str]) -> Result<RulesetStatus, RulesetError> {
    let mut rules = Ruleset::default()
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(RULES))?
        .handle_access(AccessNet::from_all(RULES))?
        .scope(Scope::from_all(RULES))?
        .create()?;
    let in_folders: BitFlags<AccessFs> = AccessFs::ReadFile | AccessFs::ReadDir | AccessFs::Execute;
    let folders = folders.iter().map(|folder| (folder, in_folders));
    let files = files.iter().map(|file| (file, AccessFs::ReadFile.into()));
    for (path, access) in folders.chain(files) {
        // A path that does not exist needs no rule.
        if let Ok(path) = PathFd::new(path) {
            rules = rules.add_rule(PathBeneath::new(path, access))?;
        }
    }
    Ok(rules.restrict_self()?.ruleset)
}
