//! Receives system calls that wait for a decision, as reported by the kernel.
//!
//! No safe crate offers the kernel calls that this needs: installing a filter with a listener, receiving a report,
//! checking whether the reported call is still waiting, and answering it. Each of these four only passes a structure to
//! the kernel. A fifth call closes inherited descriptors.
#![expect(unsafe_code, reason = "kernel calls that no safe crate offers")]

use super::Verdict;
use super::about::About;
use seccompiler::BpfProgram;
use std::fs::File;
use std::io;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, FromRawFd, OwnedFd};
use std::os::unix::fs::FileExt;

/// Installs a filter in this process; threads that it starts later inherit the filter. Calls that the filter does not
/// decide are reported through the returned descriptor.
pub(super) fn install(filter: &BpfProgram) -> io::Result<OwnedFd> {
    let program = libc::sock_fprog {
        len: filter.len() as u16,
        // The kernel only reads the filter, and both types are the same kernel structure.
        filter: filter.as_ptr().cast_mut().cast(),
    };
    // SAFETY: `program` and the filter that it points to outlive the call, which copies them.
    let descriptor = unsafe {
        libc::syscall(
            libc::SYS_seccomp,
            libc::SECCOMP_SET_MODE_FILTER,
            libc::SECCOMP_FILTER_FLAG_NEW_LISTENER,
            &raw const program,
        )
    };
    if descriptor < 0 {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: the kernel has just created this descriptor, and it has no other owner.
    Ok(unsafe { OwnedFd::from_raw_fd(descriptor as i32) })
}

/// Closes every descriptor of this process except the standard descriptors and this one.
pub(crate) fn close_all_but(kept: BorrowedFd<'_>) {
    let kept = kept.as_raw_fd().cast_unsigned();
    for (first, last) in [(3, kept - 1), (kept + 1, u32::MAX)] {
        // SAFETY: when a worker starts, only `kept` has an owner. Kernels before Linux 5.9 do not have this call; with
        // them, descriptors inherited from the console stay open.
        unsafe { libc::syscall(libc::SYS_close_range, first, last, 0) };
    }
}

/// A system call that is waiting for a decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Call {
    id: u64,
    /// The thread that made the call.
    pub(super) thread: u32,
    pub(super) number: i64,
    pub(super) arguments: [u64; 6],
}

#[cfg(test)]
impl Call {
    /// Creates a call as if this process had made it.
    pub(super) fn of(number: i64, arguments: [u64; 6]) -> Self {
        Self { id: 0, thread: std::process::id(), number, arguments }
    }
}

/// The descriptor through which a worker's calls are reported.
#[derive(Debug)]
pub(crate) struct Listener(OwnedFd);

/// `_IOWR('!', number, size)` in the kernel's header.
const fn request(number: u64, size: usize) -> u64 {
    3 << 30 | (size as u64) << 16 | (b'!' as u64) << 8 | number
}
const RECEIVE: u64 = request(0, size_of::<libc::seccomp_notif>());
const ANSWER: u64 = request(1, size_of::<libc::seccomp_notif_resp>());
/// `_IOW` in the kernel's header: the caller only writes.
const IS_WAITING: u64 = request(2, size_of::<u64>()) & !(2 << 30);

impl Listener {
    pub(crate) fn new(descriptor: OwnedFd) -> Self {
        Self(descriptor)
    }

    /// Returns the next waiting call, or `None` if the calling thread has ended meanwhile. Use this only when the
    /// descriptor is readable.
    pub(crate) fn next(&self) -> Option<Call> {
        // SAFETY: the kernel requires all zeros, and zero is valid for every field.
        let mut report: libc::seccomp_notif = unsafe { std::mem::zeroed() };
        // SAFETY: the kernel fills in exactly this structure.
        let received = unsafe { libc::ioctl(self.0.as_raw_fd(), RECEIVE as libc::Ioctl, &raw mut report) };
        let libc::seccomp_notif { id, pid, data, .. } = report;
        (received == 0).then(|| Call { id, thread: pid, number: data.nr.into(), arguments: data.args })
    }

    /// Lets a call continue, succeed or fail. A forbidden call gets no answer: the caller must kill its process.
    pub(crate) fn answer(&self, call: &Call, verdict: &Verdict) {
        let (error, flags) = match verdict {
            Verdict::Allow => (0, libc::SECCOMP_USER_NOTIF_FLAG_CONTINUE as u32),
            Verdict::Tell(about) if self.tell(call, about).is_ok() => (0, 0),
            Verdict::Tell(_) => (-libc::EFAULT, 0),
            Verdict::Refuse(error) => (-error, 0),
            Verdict::Forbid(_) => return,
        };
        let mut answer = libc::seccomp_notif_resp { id: call.id, val: 0, error, flags };
        // SAFETY: the kernel reads exactly this structure. It rejects the answer if the thread has ended meanwhile.
        unsafe { libc::ioctl(self.0.as_raw_fd(), ANSWER as libc::Ioctl, &raw mut answer) };
    }
}

impl Listener {
    /// Writes into the memory of the thread that made the call.
    fn tell(&self, call: &Call, about: &About) -> io::Result<()> {
        let memory = File::options().write(true).open(format!("/proc/{}/mem", call.thread))?;
        // While the call is waiting, its thread still exists and the thread's number cannot have been reused, so the
        // opened file is the memory of that thread. SAFETY: the kernel only reads the number.
        if unsafe { libc::ioctl(self.0.as_raw_fd(), IS_WAITING as libc::Ioctl, &raw const call.id) } != 0 {
            return Err(io::Error::last_os_error());
        }
        memory.write_all_at(&about.bytes, about.to)
    }
}

impl AsFd for Listener {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.0.as_fd()
    }
}
