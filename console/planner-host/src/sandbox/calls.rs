//! The seccomp filter: the system calls that a planner may make without asking the console.

use super::listener;
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
    apply_filter,
};
use std::collections::BTreeMap;
use std::os::fd::OwnedFd;

type Rules = BTreeMap<i64, Vec<SeccompRule>>;

/// A placeholder for "ask the console", which the filter compiler does not support.
const ASK: u32 = 0x7a5c;

/// Calls for computing, waiting, memory, existing threads and descriptors that are already open.
const FREE: &[i64] = &[
    libc::SYS_read,
    libc::SYS_write,
    libc::SYS_readv,
    libc::SYS_writev,
    libc::SYS_recvfrom,
    libc::SYS_sendto,
    libc::SYS_sendmsg,
    libc::SYS_ppoll,
    libc::SYS_close,
    libc::SYS_fstat,
    libc::SYS_lseek,
    libc::SYS_pread64,
    libc::SYS_munmap,
    libc::SYS_brk,
    libc::SYS_futex,
    libc::SYS_set_robust_list,
    libc::SYS_rseq,
    libc::SYS_membarrier,
    libc::SYS_sched_yield,
    libc::SYS_sched_getaffinity,
    libc::SYS_getcpu,
    libc::SYS_clock_gettime,
    libc::SYS_clock_getres,
    libc::SYS_clock_nanosleep,
    libc::SYS_nanosleep,
    libc::SYS_gettimeofday,
    libc::SYS_getitimer,
    libc::SYS_getrandom,
    libc::SYS_getrusage,
    libc::SYS_sysinfo,
    libc::SYS_uname,
    libc::SYS_getpid,
    libc::SYS_getppid,
    libc::SYS_gettid,
    libc::SYS_rt_sigaction,
    libc::SYS_rt_sigprocmask,
    libc::SYS_rt_sigreturn,
    libc::SYS_sigaltstack,
    libc::SYS_restart_syscall,
    // Creates rules that have no effect until `landlock_restrict_self` is called.
    libc::SYS_landlock_create_ruleset,
    libc::SYS_exit,
    libc::SYS_exit_group,
];

#[cfg(target_arch = "x86_64")]
const OLD_FREE: &[i64] = &[libc::SYS_poll, libc::SYS_time, libc::SYS_alarm];
/// Empty, because newer processor architectures do not have the older calls.
#[cfg(not(target_arch = "x86_64"))]
const OLD_FREE: &[i64] = &[];

/// Installs the filter. Returns the descriptor through which the console receives the calls that the filter does not
/// allow.
pub(super) fn install() -> Result<OwnedFd, String> {
    // The C library starts threads with `clone3`, whose flags no filter can see. Without it, the library falls back to
    // `clone`.
    let no_clone3 = [(libc::SYS_clone3, Vec::new())].into();
    let no_clone3 = compile(no_clone3, SeccompAction::Allow, SeccompAction::Errno(libc::ENOSYS as u32))?;
    apply_filter(&no_clone3).map_err(|error| error.to_string())?;
    let mut filter = compile(rules()?, SeccompAction::Trace(ASK), SeccompAction::Allow)?;
    let ask = u32::from(SeccompAction::Trace(ASK));
    for instruction in &mut filter {
        if instruction.k == ask {
            instruction.k = libc::SECCOMP_RET_USER_NOTIF;
        }
    }
    listener::install(&filter).map_err(|error| error.to_string())
}

fn compile(rules: Rules, otherwise: SeccompAction, on_match: SeccompAction) -> Result<BpfProgram, String> {
    let arch = std::env::consts::ARCH.try_into().map_err(|error| format!("{error}"))?;
    let filter = SeccompFilter::new(rules, otherwise, on_match, arch);
    filter.and_then(BpfProgram::try_from).map_err(|error| error.to_string())
}

fn rules() -> Result<Rules, String> {
    let own = u64::from(std::process::id());
    let free = FREE.iter().chain(OLD_FREE).map(|number| (*number, Vec::new()));
    let mut rules: Rules = free.collect();
    let argument = |index, operation, value| {
        SeccompCondition::new(index, SeccompCmpArgLen::Qword, operation, value)
            .map_err(|error| error.to_string())
    };
    let rule = |conditions: Vec<SeccompCondition>| SeccompRule::new(conditions).map_err(|e| e.to_string());
    let is = SeccompCmpOp::Eq;
    let only = |index, values: &[u64]| -> Result<Vec<SeccompRule>, String> {
        values.iter().map(|value| rule(vec![argument(index, is.clone(), *value)?])).collect()
    };
    // The process may send signals to itself.
    for call in [libc::SYS_kill, libc::SYS_tgkill] {
        rules.insert(call, only(0, &[own])?);
    }
    let names = [libc::PR_SET_NAME, libc::PR_GET_NAME, libc::PR_SET_VMA, libc::PR_SET_NO_NEW_PRIVS];
    rules.insert(libc::SYS_prctl, only(0, &names.map(|name| name as u64))?);
    let flags = [libc::F_GETFD, libc::F_SETFD, libc::F_GETFL];
    rules.insert(libc::SYS_fcntl, only(1, &flags.map(|flag| flag as u64))?);
    // Memory that counts towards the memory limit: private, writable, and not growing automatically.
    let kinds = (libc::MAP_SHARED | libc::MAP_PRIVATE | libc::MAP_GROWSDOWN) as u64
        | (libc::MAP_LOCKED | libc::MAP_HUGETLB) as u64;
    let private = argument(3, SeccompCmpOp::MaskedEq(kinds), libc::MAP_PRIVATE as u64)?;
    let writable = || {
        let write = libc::PROT_WRITE as u64;
        argument(2, SeccompCmpOp::MaskedEq(write), write)
    };
    rules.insert(libc::SYS_mmap, vec![rule(vec![private, writable()?])?]);
    rules.insert(libc::SYS_mprotect, vec![rule(vec![writable()?])?]);
    // All kinds of `madvise` except those that take the machine's memory pages out of use, which a privileged process
    // could do.
    let harmless = argument(2, SeccompCmpOp::Lt, libc::MADV_HWPOISON as u64)?;
    rules.insert(libc::SYS_madvise, vec![rule(vec![harmless])?]);
    // `nice` reads its own priority before it tries to change it.
    rules.insert(
        libc::SYS_getpriority,
        vec![rule(vec![argument(0, is.clone(), 0)?, argument(1, is.clone(), 0)?])?],
    );
    // Limits can be read but not set.
    rules.insert(libc::SYS_prlimit64, vec![rule(vec![argument(0, is.clone(), 0)?, argument(2, is, 0)?])?]);
    Ok(rules)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_free_is_asked_for() {
        let filter = compile(rules().expect("rules"), SeccompAction::Trace(ASK), SeccompAction::Allow);
        let filter = filter.expect("a filter");
        assert!(filter.iter().any(|instruction| instruction.k == u32::from(SeccompAction::Trace(ASK))));
        let free = rules().expect("rules");
        for call in [libc::SYS_openat, libc::SYS_socket, libc::SYS_clone, libc::SYS_execve, libc::SYS_ptrace]
        {
            assert!(!free.contains_key(&call), "{call}");
        }
    }
}
