//! Checks of system limits before any work begins, so that a command reports a limit that is too low instead of
//! crashing.

use anyhow::anyhow;
use rustix::process::{Resource, getrlimit};

/// The address space in bytes that a console with its threads reserves; most of it is never used.
const ADDRESS_SPACE: u64 = 1 << 30;
/// The stack of the first thread in bytes.
const STACK: u64 = 1 << 20;

/// Checks that the stack limit is large enough. Call this before parsing the command line, which itself needs stack.
///
/// # Errors
/// The limit is too low; the message names it.
pub fn check_stack() -> anyhow::Result<()> {
    enough(getrlimit(Resource::Stack).current, STACK, "stack", 's').map_err(|why| anyhow!(why))
}

/// Checks that the address-space limit is large enough for a command.
///
/// # Errors
/// The limit is too low; the message names it.
pub fn check() -> anyhow::Result<()> {
    enough(getrlimit(Resource::As).current, ADDRESS_SPACE, "address space", 'v').map_err(|why| anyhow!(why))
}

fn enough(limit: Option<u64>, needed: u64, of_what: &str, option: char) -> Result<(), String> {
    match limit {
        Some(limit) if limit < needed => Err(format!(
            "tankops needs {} kB of {of_what}, but the system grants only {} kB; try `ulimit -{option} {}`",
            needed >> 10,
            limit >> 10,
            needed >> 10
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_that_is_too_low_is_named() {
        assert_eq!(
            (enough(None, 1 << 20, "stack", 's'), enough(Some(1 << 20), 1 << 20, "stack", 's')),
            (Ok(()), Ok(()))
        );
        let why = "tankops needs 1024 kB of stack, but the system grants only 64 kB; try `ulimit -s 1024`";
        assert_eq!(enough(Some(64 << 10), 1 << 20, "stack", 's'), Err(why.to_owned()));
    }
}
