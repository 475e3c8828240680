//! Memory of a planner that the kernel does not count.
//!
//! The kernel counts the private memory that can be written (`RLIMIT_DATA`), and that is nearly all of it. Who writes to
//! memory and then gives up the right to write keeps it uncounted, and address space that can only be read costs tables of
//! pages. `RLIMIT_AS` does not help: where it is reached, the kernel makes memory writable without counting it. So the calls that
//! withdraw the right to write, or take address space without it, wait for a decision here.

use super::listener::Call;
use super::verdict::Verdict;

/// Memory that may be made read-only in large pieces, bytes: tables of addresses that libraries fix up, and to spare.
pub(crate) const MAY_HIDE: u64 = 32 << 20;
/// Smaller pieces are the guard pages of threads, however many are started; who hides much in them takes so long that the
/// supervisor sees it, which weighs the process ([`crate::supervisor`]).
const SMALL: u64 = 16 << 10;
/// Address space in addition to the memory of the planner, bytes: stacks of threads, and 64 MB that the C library reserves for each
/// thread that allocates.
pub(crate) const MAY_RESERVE: u64 = 1 << 30;

/// What a worker has of such memory.
#[derive(Debug, Default)]
pub(crate) struct Uncounted {
    /// Memory of the planner, bytes.
    limit: u64,
    /// Address space when it was first looked at, bytes.
    own_space: Option<u64>,
    /// Memory that was made read-only in large pieces, bytes.
    hidden: u64,
}

impl Uncounted {
    /// For a planner with this limit of memory, bytes.
    pub(crate) fn of(limit: u64) -> Self {
        Self { limit, ..Self::default() }
    }

    /// Decides about a call, if it is one of these.
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
            // Pages of a kind of their own, which are counted nowhere; whoever wants them does without.
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

/// Address space of a thread's process, bytes.
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
        // Of this process nothing changes, so that the next look finds what the first one found.
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
