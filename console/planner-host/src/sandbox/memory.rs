//! Limits the part of a planner's memory that the kernel does not count.
//!
//! The kernel counts private writable memory (`RLIMIT_DATA`), which is nearly all of a planner's memory. There are two
//! gaps: memory that was written and then made read-only is not counted, and neither are the page tables of read-only
//! address space. `RLIMIT_AS` does not help: when this limit is reached, the kernel makes memory writable without
//! counting it. So calls that make memory read-only, or reserve read-only address space, wait for a decision here.

use super::listener::Call;
use super::verdict::Verdict;

/// Maximum amount of memory that may be made read-only in large pieces, bytes: enough for the address tables that
/// libraries fix up.
pub(crate) const MAY_HIDE: u64 = 32 << 20;
/// Smaller pieces are guard pages of threads and are always allowed. Hiding a lot of memory in small pieces takes so
/// long that the supervisor, which measures the memory of the process ([`crate::supervisor`]), notices it.
const SMALL: u64 = 16 << 10;
/// Address space in addition to the planner's memory limit, bytes: thread stacks, and 64 MB that the C library reserves
/// for each thread that allocates.
pub(crate) const MAY_RESERVE: u64 = 1 << 30;

/// The part of a worker's memory that the kernel does not count.
#[derive(Debug, Default)]
pub(crate) struct Uncounted {
    /// The planner's memory limit, bytes.
    limit: u64,
    /// Address space used at the first check, bytes.
    own_space: Option<u64>,
    /// Memory that was made read-only in large pieces, bytes.
    hidden: u64,
}

impl Uncounted {
    /// Starts counting for a planner with this memory limit, bytes.
    pub(crate) fn of(limit: u64) -> Self {
        Self { limit, ..Self::default() }
    }

    /// Decides on a call that concerns uncounted memory; `None` for any other call.
    pub(crate) fn verdict(&mut self, call: &Call) -> Option<Verdict> {
        let [_, length, new_length, flags, ..] = call.arguments;
        match call.number {
            libc::SYS_mprotect => Some(self.hide(length)),
            libc::SYS_mremap if flags & libc::MREMAP_DONTUNMAP as u64 != 0 => {
                Some(self.reserve(call, new_length))
            }
            libc::SYS_mremap => Some(self.reserve(call, new_length.saturating_sub(length))),
            libc::SYS_mmap if flags & SHARED_OR_GROWING != libc::MAP_PRIVATE as u64 => None,
            libc::SYS_mmap if flags & libc::MAP_LOCKED as u64 != 0 => {
                Some(Verdict::Forbid("mmap of locked memory".to_owned()))
            }
            // Huge pages are not counted anywhere. Programs that ask for them work without them.
            libc::SYS_mmap if flags & libc::MAP_HUGETLB as u64 != 0 => Some(Verdict::Refuse(libc::ENOMEM)),
            libc::SYS_mmap => Some(self.reserve(call, length)),
            _ => None,
        }
    }

    fn hide(&mut self, length: u64) -> Verdict {
        let hidden = self.hidden.saturating_add(if length > SMALL { length } else { 0 });
        if hidden > MAY_HIDE {
            return Verdict::Refuse(libc::ENOMEM);
        }
        self.hidden = hidden;
        Verdict::Allow
    }

    fn reserve(&mut self, call: &Call, length: u64) -> Verdict {
        let Some(space) = space_of(call.thread) else { return Verdict::Refuse(libc::ENOMEM) };
        let own = *self.own_space.get_or_insert(space);
        let most = own.saturating_add(self.limit).saturating_add(MAY_RESERVE);
        if space.saturating_add(length) > most { Verdict::Refuse(libc::ENOMEM) } else { Verdict::Allow }
    }
}

const SHARED_OR_GROWING: u64 = (libc::MAP_SHARED | libc::MAP_PRIVATE | libc::MAP_GROWSDOWN) as u64;

/// Returns the address space of a thread's process, bytes.
fn space_of(thread: u32) -> Option<u64> {
    let pages = std::fs::read_to_string(format!("/proc/{thread}/statm")).ok()?;
    let pages: u64 = pages.split_ascii_whitespace().next()?.parse().ok()?;
    Some(pages.saturating_mul(rustix::param::page_size() as u64))
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFUSED: Option<Verdict> = Some(Verdict::Refuse(libc::ENOMEM));
    const ALLOWED: Option<Verdict> = Some(Verdict::Allow);
    const MB: u64 = 1 << 20;

    fn mmap(length: u64, flags: i32) -> Call {
        Call::of(libc::SYS_mmap, [0, length, libc::PROT_NONE as u64, flags as u64, u64::MAX, 0])
    }

    fn mprotect(length: u64) -> Call {
        Call::of(libc::SYS_mprotect, [0, length, libc::PROT_READ as u64, 0, 0, 0])
    }

    const PRIVATE: i32 = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS;

    #[test]
    fn large_pieces_are_hidden_up_to_a_sum_and_guard_pages_for_ever() {
        let mut uncounted = Uncounted::of(256 * MB);
        assert_eq!(uncounted.verdict(&mprotect(MAY_HIDE + 1)), REFUSED, "also at once");
        for _ in 0..32 {
            assert_eq!(uncounted.verdict(&mprotect(MB)), ALLOWED);
        }
        assert_eq!(uncounted.verdict(&mprotect(MB)), REFUSED);
        assert_eq!(uncounted.verdict(&mprotect(u64::MAX)), REFUSED);
        for _ in 0..100_000 {
            assert_eq!(uncounted.verdict(&mprotect(4096)), ALLOWED);
        }
    }

    #[test]
    fn address_space_is_the_memory_and_a_gigabyte() {
        let mut uncounted = Uncounted::of(256 * MB);
        assert_eq!(uncounted.verdict(&mmap(128 * MB, PRIVATE)), ALLOWED);
        // The address space of this process does not change, so the next check has the same result as the first.
        assert_eq!(uncounted.verdict(&mmap(2048 * MB, PRIVATE)), REFUSED);
        let grow = |from, to, flags| Call::of(libc::SYS_mremap, [0, from, to, flags, 0, 0]);
        assert_eq!(uncounted.verdict(&grow(2000 * MB, 2001 * MB, 1)), ALLOWED);
        assert_eq!(uncounted.verdict(&grow(2000 * MB, MB, 1)), ALLOWED, "it shrinks");
        assert_eq!(uncounted.verdict(&grow(4096, 2000 * MB, 1)), REFUSED);
        let twice = libc::MREMAP_DONTUNMAP as u64 | 1;
        assert_eq!(uncounted.verdict(&grow(2000 * MB, 2000 * MB, twice)), REFUSED);
    }

    #[test]
    fn other_kinds_of_memory_are_not_to_be_had() {
        let mut uncounted = Uncounted::of(256 * MB);
        let locked = uncounted.verdict(&mmap(MB, PRIVATE | libc::MAP_LOCKED));
        assert_eq!(locked, Some(Verdict::Forbid("mmap of locked memory".into())));
        assert_eq!(uncounted.verdict(&mmap(MB, PRIVATE | libc::MAP_HUGETLB)), REFUSED);
        assert_eq!(uncounted.verdict(&mmap(MB, libc::MAP_SHARED)), None, "decided elsewhere");
        assert_eq!(uncounted.verdict(&mmap(MB, PRIVATE | libc::MAP_GROWSDOWN)), None);
        assert_eq!(uncounted.verdict(&Call::of(libc::SYS_socket, [0; 6])), None);
    }
}
