//! What a machine must grant before anything begins; what it does not is named, instead of a process that ends by itself.

use anyhow::anyhow;
use rustix::process::{Resource, getrlimit};

/// Address space that a console with its threads asks for, bytes; most of it is never used.
const ADDRESS_SPACE: u64 = 1 << 30;
/// Stack of the first thread, bytes.
const STACK: u64 = 1 << 20;

/// Makes sure that the machine leaves room for the stack; to be asked before the command line is read, which takes stack, too.
///
/// # Errors
/// It does not; the sentence names the limit.
pub fn check_stack() -> anyhow::Result<()> {
    enough(getrlimit(Resource::Stack).current, STACK, "stack", 's').map_err(|why| anyhow!(why))
}

/// Makes sure that the machine leaves address space for a command.
///
/// # Errors
/// It does not; the sentence names the limit.
pub fn check() -> anyhow::Result<()> {
    enough(getrlimit(Resource::As).current, ADDRESS_SPACE, "address space", 'v').map_err(|why| anyhow!(why))
}

fn enough(limit: Option<u64>, needed: u64, of_what: &str, option: char) -> Result<(), String> {
    match limit {
        Some(limit) if limit < needed => Err(format!(
            "tankops needs {} kB of {of_what}, and the system grants {} kB: `ulimit -{option} {}`",
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
        let why = "tankops needs 1024 kB of stack, and the system grants 64 kB: `ulimit -s 1024`";
        assert_eq!(enough(Some(64 << 10), 1 << 20, "stack", 's'), Err(why.to_owned()));
    }
}
