//! What the console decides about a call that is not free.
//!
//! What a call points at can be changed by another thread while the console looks at it. So a path decides only how a
//! planner is refused, and while its plugin is loaded, when Landlock decides what can be read.

use super::files::{LIBRARIES, LIBRARY_CACHE};
use super::listener::Call;
use std::fs::File;
use std::os::unix::fs::FileExt;

/// Threads of a worker, its own two among them.
const MOST_THREADS: usize = 64;
/// Longest path that is looked at, bytes.
const LONGEST_PATH: usize = 256;
/// What libraries read on the way to other things, and do without: processors, memory, time zone, language. The C library
/// asks for `overcommit_memory` when it gives memory back.
const CURIOUS: [&str; 10] = [
    "/proc/self/",
    "/proc/sys/vm/",
    "/proc/meminfo",
    "/proc/cpuinfo",
    "/proc/stat",
    "/sys/fs/cgroup/",
    "/sys/devices/system/",
    "/usr/share/zoneinfo/",
    "/usr/share/locale/",
    "/etc/localtime",
];

/// A decision about a call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It may be made.
    Allow,
    /// It fails with this error of the system, and the planner goes on.
    Refuse(i32),
    /// It is never made, and the process is killed; what was tried.
    Forbid(String),
}

/// Decides about a call, before and after its plugin is loaded.
pub(crate) fn verdict(call: &Call, is_loading: bool) -> Verdict {
    let Call { number, arguments, .. } = *call;
    match number {
        libc::SYS_clone => on_clone(call),
        libc::SYS_openat if arguments[2] as i32 & !READING != 0 => written(call, 1),
        libc::SYS_openat => on_path(call, 1, is_loading && arguments[2] as i32 == LOADER_FLAGS),
        libc::SYS_newfstatat | libc::SYS_statx | libc::SYS_readlinkat | libc::SYS_faccessat => {
            on_path(call, 1, is_loading && number == libc::SYS_newfstatat)
        }
        #[cfg(target_arch = "x86_64")]
        libc::SYS_open if arguments[1] as i32 & !READING != 0 => written(call, 0),
        #[cfg(target_arch = "x86_64")]
        libc::SYS_open | libc::SYS_stat | libc::SYS_access | libc::SYS_readlink => on_path(call, 0, false),
        // Terminals are asked for their size and kind by libraries that print.
        libc::SYS_ioctl if arguments[1] == libc::TCGETS => Verdict::Refuse(libc::ENOTTY),
        libc::SYS_landlock_restrict_self if is_loading => Verdict::Allow,
        number => Verdict::Forbid(name(number)),
    }
}

/// How the loader opens a library.
const LOADER_FLAGS: i32 = libc::O_RDONLY | libc::O_CLOEXEC;
/// How files are opened that are only read.
const READING: i32 = LOADER_FLAGS | libc::O_DIRECTORY | libc::O_NONBLOCK | libc::O_NOCTTY | libc::O_LARGEFILE;

/// Whether this is the call by which a worker ends the loading of its plugin.
pub(crate) fn ends_loading(call: &Call) -> bool {
    call.number == libc::SYS_landlock_restrict_self
}

/// A thread is a process that shares everything with its maker.
fn on_clone(call: &Call) -> Verdict {
    const THREAD: u64 = (libc::CLONE_VM | libc::CLONE_FS | libc::CLONE_FILES) as u64
        | (libc::CLONE_SIGHAND | libc::CLONE_THREAD | libc::CLONE_SYSVSEM) as u64;
    const MAY: u64 = (libc::CLONE_SETTLS | libc::CLONE_PARENT_SETTID | libc::CLONE_CHILD_CLEARTID) as u64
        | (libc::CLONE_CHILD_SETTID | libc::CLONE_DETACHED) as u64;
    let flags = call.arguments[0];
    if flags & THREAD != THREAD || flags & !(THREAD | MAY) != 0 {
        return Verdict::Forbid("fork".to_owned());
    }
    let threads = std::fs::read_dir(format!("/proc/{}/task", call.thread));
    if threads.map_or(0, Iterator::count) < MOST_THREADS {
        Verdict::Allow
    } else {
        Verdict::Refuse(libc::EAGAIN)
    }
}

fn on_path(call: &Call, index: usize, may_load: bool) -> Verdict {
    let Some(path) = path_at(call.thread, call.arguments[index]) else {
        return Verdict::Forbid(name(call.number));
    };
    let is_library = LIBRARIES.iter().any(|folder| is_below(folder, &path)) || path == LIBRARY_CACHE;
    let is_own = path.is_empty() || path.starts_with("/proc/self/fd/");
    if may_load && (is_library || is_own) {
        Verdict::Allow
    } else if path.is_empty() || is_library || CURIOUS.iter().any(|known| path.starts_with(known)) {
        Verdict::Refuse(libc::EACCES)
    } else if may_load && is_library_name(&path) {
        // The loader tries where a library was when the plugin was built.
        Verdict::Refuse(libc::ENOENT)
    } else {
        of_path(call, &path)
    }
}

/// A file that is opened to be changed is forbidden whatever it is.
fn written(call: &Call, index: usize) -> Verdict {
    path_at(call.thread, call.arguments[index])
        .map_or_else(|| Verdict::Forbid(name(call.number)), |path| of_path(call, &path))
}

fn of_path(call: &Call, path: &str) -> Verdict {
    Verdict::Forbid(format!("{} of {}", name(call.number), for_people(path)))
}

/// What a thread's memory holds at an address, up to its first zero.
fn path_at(thread: u32, address: u64) -> Option<String> {
    let mut bytes = [0; LONGEST_PATH];
    let read = File::open(format!("/proc/{thread}/mem")).and_then(|mem| mem.read_at(&mut bytes, address));
    let bytes = &bytes[..read.ok()?];
    let length = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    Some(String::from_utf8_lossy(&bytes[..length]).into_owned())
}

fn is_below(folder: &str, path: &str) -> bool {
    path.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'))
}

fn is_library_name(path: &str) -> bool {
    path.rsplit('/').next().is_some_and(|name| name.contains(".so"))
}

/// A path without what moves a cursor, and without numbers of processes, which differ from run to run.
fn for_people(path: &str) -> String {
    let plain = path.replace(char::is_control, "?");
    match plain.strip_prefix("/proc/").and_then(|rest| rest.split_once('/')) {
        Some((process, rest)) if process.bytes().all(|byte| byte.is_ascii_digit()) => {
            format!("/proc/PID/{rest}")
        }
        _ => plain,
    }
}

fn name(number: i64) -> String {
    syscalls::Sysno::new(number as usize)
        .map_or_else(|| format!("call {number}"), |known| known.name().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_path(number: i64, path: &str, flags: i32, is_loading: bool) -> Verdict {
        let path = format!("{path}\0");
        verdict(&Call::of(number, [0, path.as_ptr() as u64, flags as u64, 0, 0, 0]), is_loading)
    }

    fn open(path: &str, flags: i32, is_loading: bool) -> Verdict {
        with_path(libc::SYS_openat, path, flags, is_loading)
    }

    #[test]
    fn libraries_are_read_only_while_the_plugin_is_loaded() {
        let library = "/usr/lib/x86_64-linux-gnu/libm.so.6";
        assert_eq!(open(library, LOADER_FLAGS, true), Verdict::Allow);
        assert_eq!(open(library, LOADER_FLAGS, false), Verdict::Refuse(libc::EACCES));
        assert_eq!(open("/home/author/target/libm.so.6", LOADER_FLAGS, true), Verdict::Refuse(libc::ENOENT));
    }

    #[test]
    fn what_is_opened_is_named() {
        let forbidden = |what: &str| Verdict::Forbid(what.to_owned());
        for is_loading in [true, false] {
            assert_eq!(open("/etc/shadow", LOADER_FLAGS, is_loading), forbidden("openat of /etc/shadow"));
            assert_eq!(open("/dev/tty", libc::O_RDWR, is_loading), forbidden("openat of /dev/tty"));
            let memory = open("/proc/4711/mem", libc::O_RDWR, is_loading);
            assert_eq!(
                memory,
                forbidden("openat of /proc/PID/mem"),
                "no process id: it goes into the journal"
            );
        }
        assert_eq!(open("/a/\u{1b}[2J", libc::O_RDWR, false), forbidden("openat of /a/?[2J"));
        assert_eq!(verdict(&Call::of(libc::SYS_openat, [0; 6]), false), forbidden("openat"));
        assert_eq!(verdict(&Call::of(libc::SYS_socket, [0; 6]), true), forbidden("socket"));
        assert_eq!(verdict(&Call::of(9999, [0; 6]), true), forbidden("call 9999"));
    }

    #[test]
    fn what_libraries_ask_for_on_the_way_is_refused_and_survived() {
        for path in ["/proc/self/cgroup", "/proc/sys/vm/overcommit_memory"] {
            assert_eq!(open(path, LOADER_FLAGS, false), Verdict::Refuse(libc::EACCES));
        }
        let memory = open("/proc/self/mem", libc::O_RDWR, false);
        assert_eq!(memory, Verdict::Forbid("openat of /proc/self/mem".into()), "nothing is written");
        assert_eq!(with_path(libc::SYS_newfstatat, "", 0x1000, false), Verdict::Refuse(libc::EACCES));
        let terminal = Call::of(libc::SYS_ioctl, [1, libc::TCGETS, 0, 0, 0, 0]);
        assert_eq!(verdict(&terminal, false), Verdict::Refuse(libc::ENOTTY));
        let typed = Call::of(libc::SYS_ioctl, [0, libc::TIOCSTI, 0, 0, 0, 0]);
        assert_eq!(verdict(&typed, false), Verdict::Forbid("ioctl".into()));
    }

    #[test]
    fn threads_are_no_processes() {
        let clone = |flags| verdict(&Call::of(libc::SYS_clone, [flags, 0, 0, 0, 0, 0]), false);
        assert_eq!(clone(0x003d_0f00), Verdict::Allow, "as the C library starts a thread");
        assert_eq!(clone(libc::SIGCHLD as u64), Verdict::Forbid("fork".into()));
        let with_namespace = 0x003d_0f00 | libc::CLONE_NEWUSER as u64;
        assert_eq!(clone(with_namespace), Verdict::Forbid("fork".into()));
    }
}
