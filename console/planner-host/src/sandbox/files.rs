//! Landlock: first only libraries can be read, then nothing at all.

use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, PathBeneath, PathFd, Ruleset,
    RulesetAttr, RulesetCreatedAttr, RulesetError, RulesetStatus, Scope,
};

/// Where the loader looks for libraries.
pub(super) const LIBRARIES: [&str; 4] = ["/lib", "/lib64", "/usr/lib", "/usr/lib64"];
/// Where it looks up which of them holds a library.
pub(super) const LIBRARY_CACHE: &str = "/etc/ld.so.cache";
/// The newest rules that are used; older kernels enforce those that they know, and seccomp denies the calls of the others.
const RULES: ABI = ABI::V6;

/// Takes everything but reading libraries from this thread and those that it starts.
pub(super) fn only_libraries() -> Result<(), String> {
    enforced(restrict(&LIBRARIES, &[LIBRARY_CACHE]))
}

/// Takes the libraries, too.
pub(crate) fn nothing() -> Result<(), String> {
    enforced(restrict(&[], &[]))
}

fn enforced(status: Result<RulesetStatus, RulesetError>) -> Result<(), String> {
    match status {
        Ok(RulesetStatus::NotEnforced) => Err("this kernel does not have it, or it is off".to_owned()),
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
        // What does not exist needs no rule.
        if let Ok(path) = PathFd::new(path) {
            rules = rules.add_rule(PathBeneath::new(path, access))?;
        }
    }
    Ok(rules.restrict_self()?.ruleset)
}
