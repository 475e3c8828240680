//! The console's decisions on system calls that are not always allowed.
//!
//! A second thread can change the data that a call points to while the console is reading it. So a path only decides
//! how a call is refused, never whether a file can be reached: Landlock decides which files can be opened, and the
//! console looks up file status itself.

use super::about::{self, About};
use super::files::{LIBRARIES, LIBRARY_CACHE};
use super::listener::Call;
use super::{PLUGIN, Stage};
use foreign::is_plain;
use std::fs::File;
use std::os::unix::fs::FileExt;

/// The maximum number of threads of a worker, including its own two.
const MOST_THREADS: usize = 64;
/// The maximum length of a path, bytes.
const LONGEST_PATH: usize = 256;
/// Files that libraries try to read but do not need, about processors, memory, time zone and language. The C library
/// reads `overcommit_memory` when it returns memory.
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

/// A decision on a call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The call is made.
    Allow,
    /// The call is not made but succeeds, and returns this file status.
    Tell(About),
    /// The call fails with this system error, and the planner continues.
    Refuse(i32),
    /// The call is never made, and the process is killed; the text states what the planner tried.
    Forbid(String),
}

/// Decides on a call. `sought` is the folder that was last searched for a library.
pub(crate) fn verdict(call: &Call, stage: Stage, sought: &mut String) -> Verdict {
    let Call { number, arguments, .. } = *call;
    match number {
        libc::SYS_clone => on_clone(call),
        libc::SYS_openat if arguments[2] as i32 & !READING != 0 => written(call, 1),
        libc::SYS_openat => opened(call, 1, stage, arguments[2] as i32, sought),
        libc::SYS_newfstatat => asked_about(call, stage, sought),
        libc::SYS_readlinkat | libc::SYS_faccessat => on_path(call, 1),
        #[cfg(target_arch = "x86_64")]
        libc::SYS_open if arguments[1] as i32 & !READING != 0 => written(call, 0),
        #[cfg(target_arch = "x86_64")]
        libc::SYS_open | libc::SYS_stat | libc::SYS_access | libc::SYS_readlink => on_path(call, 0),
        // All users of `statx` fall back to `newfstatat`.
        libc::SYS_statx => Verdict::Refuse(libc::ENOSYS),
        // Libraries that print ask for the size and type of the terminal; a backtrace needs the current folder to
        // shorten its paths.
        libc::SYS_ioctl if arguments[1] == libc::TCGETS => Verdict::Refuse(libc::ENOTTY),
        libc::SYS_getcwd => Verdict::Refuse(libc::ENOENT),
        libc::SYS_mmap => Verdict::Forbid("mmap of shared memory".to_owned()),
        libc::SYS_landlock_restrict_self if stage == Stage::Loading => Verdict::Allow,
        number => Verdict::Forbid(name(number)),
    }
}

/// The flags with which the loader opens a library.
const LOADER_FLAGS: i32 = libc::O_RDONLY | libc::O_CLOEXEC;
/// The flags allowed for files that are only read.
const READING: i32 = LOADER_FLAGS | libc::O_DIRECTORY | libc::O_NONBLOCK | libc::O_NOCTTY | libc::O_LARGEFILE;

/// Whether this is the call that a worker makes once its plugin is loaded.
pub(crate) fn ends_loading(call: &Call) -> bool {
    call.number == libc::SYS_landlock_restrict_self
}

/// Decides on `clone`. Only threads are allowed, which are processes that share everything with their parent.
fn on_clone(call: &Call) -> Verdict {
    const THREAD: u64 = (libc::CLONE_VM | libc::CLONE_FS | libc::CLONE_FILES) as u64
        | (libc::CLONE_SIGHAND | libc::CLONE_THREAD | libc::CLONE_SYSVSEM) as u64;
    const MAY: u64 = (libc::CLONE_SETTLS | libc::CLONE_PARENT_SETTID | libc::CLONE_CHILD_CLEARTID) as u64
        | (libc::CLONE_CHILD_SETTID | libc::CLONE_DETACHED) as u64;
    // The flags with which the C library forks and starts programs.
    const OF_FORK: u64 = (libc::CLONE_CHILD_CLEARTID | libc::CLONE_CHILD_SETTID) as u64
        | (libc::CLONE_VM | libc::CLONE_VFORK) as u64;
    let flags = call.arguments[0];
    if flags & THREAD != THREAD || flags & !(THREAD | MAY) != 0 {
        let is_fork = flags & !OF_FORK == libc::SIGCHLD as u64;
        return Verdict::Forbid(if is_fork { "fork" } else { "clone" }.to_owned());
    }
    let threads = std::fs::read_dir(format!("/proc/{}/task", call.thread));
    if threads.map_or(0, Iterator::count) < MOST_THREADS {
        Verdict::Allow
    } else {
        Verdict::Refuse(libc::EAGAIN)
    }
}

/// Decides on opening a file for reading. While the plugin is being loaded, libraries can be opened; afterwards, only
/// the plugin's own bytes, which contain the names of its functions. By then, Landlock allows nothing else to be
/// opened, even if the path has changed meanwhile.
fn opened(call: &Call, index: usize, stage: Stage, flags: i32, sought: &mut String) -> Verdict {
    let Some(path) = path_at(call.thread, call.arguments[index]) else {
        return Verdict::Forbid(name(call.number));
    };
    let may_be_opened = flags == LOADER_FLAGS
        && match stage {
            Stage::Loading => is_library(&path) || path == PLUGIN,
            Stage::Loaded { no_file_can_be_opened } => no_file_can_be_opened && path == PLUGIN,
        };
    if may_be_opened {
        Verdict::Allow
    } else if stage == Stage::Loading && is_library_name(&path) {
        // The loader first tries the folder where a library was when the plugin was built, and then checks whether that
        // folder exists.
        path.rsplit_once('/').map_or("", |(folder, _)| folder).clone_into(sought);
        Verdict::Refuse(libc::ENOENT)
    } else {
        of_path(call, &path)
    }
}

/// Decides on a request for file status. It is answered for open files and, while the plugin is being loaded, for
/// libraries.
fn asked_about(call: &Call, stage: Stage, sought: &str) -> Verdict {
    let [descriptor, path, to, flags, ..] = call.arguments;
    let Some(path) = path_at(call.thread, path) else { return Verdict::Forbid(name(call.number)) };
    let about = match path.as_str() {
        "" if flags as i32 & libc::AT_EMPTY_PATH != 0 => about::descriptor(call.thread, descriptor as i32),
        path if stage == Stage::Loading && is_library(path) => about::file(path, flags as i32),
        _ if stage == Stage::Loading && (is_library_name(&path) || is_folder(sought, &path)) => {
            return Verdict::Refuse(libc::ENOENT);
        }
        path => return of_path(call, path),
    };
    match about {
        Ok(bytes) => Verdict::Tell(About { to, bytes }),
        Err(error) => Verdict::Refuse(error),
    }
}

fn on_path(call: &Call, index: usize) -> Verdict {
    path_at(call.thread, call.arguments[index])
        .map_or_else(|| Verdict::Forbid(name(call.number)), |path| of_path(call, &path))
}

/// Decides on opening a file for writing. This is forbidden, except that naming a thread merely fails: the C library
/// tries to do so but does not depend on it.
fn written(call: &Call, index: usize) -> Verdict {
    let Some(path) = path_at(call.thread, call.arguments[index]) else {
        return Verdict::Forbid(name(call.number));
    };
    let is_name = path.starts_with("/proc/self/task/") && path.ends_with("/comm") && !leads_back(&path);
    if is_name { Verdict::Refuse(libc::EACCES) } else { forbidden(call, &path) }
}

/// Refuses paths that ordinary libraries ask for; forbids all other paths.
fn of_path(call: &Call, path: &str) -> Verdict {
    let is_harmless =
        path.is_empty() || is_library(path) || CURIOUS.iter().any(|known| path.starts_with(known));
    if is_harmless && !leads_back(path) { Verdict::Refuse(libc::EACCES) } else { forbidden(call, path) }
}

fn forbidden(call: &Call, path: &str) -> Verdict {
    Verdict::Forbid(format!("{} of {}", name(call.number), for_people(path)))
}

/// Reads the zero-terminated path at an address of a thread's memory; `None` if it cannot be read or is too long.
fn path_at(thread: u32, address: u64) -> Option<String> {
    let mut bytes = [0; LONGEST_PATH];
    let read = File::open(format!("/proc/{thread}/mem")).and_then(|mem| mem.read_at(&mut bytes, address));
    let bytes = &bytes[..read.ok()?];
    let length = bytes.iter().position(|byte| *byte == 0)?;
    Some(String::from_utf8_lossy(&bytes[..length]).into_owned())
}

/// Whether this is a system library or the library index.
fn is_library(path: &str) -> bool {
    // The loader also checks whether the folder itself exists.
    let is_there = LIBRARIES.iter().any(|folder| path == *folder || is_below(folder, path));
    path == LIBRARY_CACHE || (is_there && !leads_back(path))
}

/// Whether a path contains `..` and may therefore lead out of its first folder.
fn leads_back(path: &str) -> bool {
    path.split('/').any(|part| part == "..")
}

/// Whether a path is this folder; false if no folder is given.
fn is_folder(folder: &str, path: &str) -> bool {
    !folder.is_empty() && path.trim_end_matches('/') == folder
}

fn is_below(folder: &str, path: &str) -> bool {
    path.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'))
}

fn is_library_name(path: &str) -> bool {
    path.rsplit('/').next().is_some_and(|name| name.contains(".so"))
}

/// Prepares a path for display and for the journal by removing control characters, and process ids, which differ from
/// run to run.
fn for_people(path: &str) -> String {
    let plain = path.replace(|c| !is_plain(c), "?");
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

    const LOADED: Stage = Stage::Loaded { no_file_can_be_opened: true };

    fn open(path: &str, flags: i32, stage: Stage) -> Verdict {
        let path = format!("{path}\0");
        let call = Call::of(libc::SYS_openat, [0, path.as_ptr() as u64, flags as u64, 0, 0, 0]);
        verdict(&call, stage, &mut String::new())
    }

    fn ask_about(path: &str, flags: i32, stage: Stage) -> Verdict {
        let path = format!("{path}\0");
        ask_after(&mut String::new(), &path, flags, stage)
    }

    fn ask_after(sought: &mut String, path: &str, flags: i32, stage: Stage) -> Verdict {
        let call = Call::of(libc::SYS_newfstatat, [1, path.as_ptr() as u64, 0x1000, flags as u64, 0, 0]);
        verdict(&call, stage, sought)
    }

    #[test]
    fn a_folder_is_not_there_in_which_a_library_was_looked_for() {
        let (path, mut sought) = ("/opt/lib/tls/libx.so.1\0", String::new());
        let call = Call::of(libc::SYS_openat, [0, path.as_ptr() as u64, LOADER_FLAGS as u64, 0, 0, 0]);
        assert_eq!(verdict(&call, Stage::Loading, &mut sought), Verdict::Refuse(libc::ENOENT));
        let missing = Verdict::Refuse(libc::ENOENT);
        assert_eq!(ask_after(&mut sought, "/opt/lib/tls/\0", 0, Stage::Loading), missing);
        let other = ask_after(&mut sought, "/opt/lib\0", 0, Stage::Loading);
        assert_eq!(other, forbidden("newfstatat of /opt/lib"));
    }

    fn decide(number: i64, arguments: [u64; 6], stage: Stage) -> Verdict {
        verdict(&Call::of(number, arguments), stage, &mut String::new())
    }

    fn forbidden(what: &str) -> Verdict {
        Verdict::Forbid(what.to_owned())
    }

    #[test]
    fn libraries_are_read_only_while_the_plugin_is_loaded() {
        let library = "/usr/lib/x86_64-linux-gnu/libm.so.6";
        assert_eq!(open(library, LOADER_FLAGS, Stage::Loading), Verdict::Allow);
        assert_eq!(open(library, LOADER_FLAGS, LOADED), Verdict::Refuse(libc::EACCES));
        let elsewhere = open("/home/author/target/libm.so.6", LOADER_FLAGS, Stage::Loading);
        assert_eq!(elsewhere, Verdict::Refuse(libc::ENOENT));
    }

    #[test]
    fn its_own_bytes_are_all_that_a_loaded_plugin_can_open() {
        assert_eq!(open(PLUGIN, LOADER_FLAGS, LOADED), Verdict::Allow);
        assert_eq!(open(PLUGIN, libc::O_RDONLY, LOADED), Verdict::Refuse(libc::EACCES), "not as it is done");
        let without_landlock = Stage::Loaded { no_file_can_be_opened: false };
        assert_eq!(open(PLUGIN, LOADER_FLAGS, without_landlock), Verdict::Refuse(libc::EACCES));
        assert_eq!(open(PLUGIN, libc::O_RDWR, LOADED), forbidden("openat of /proc/self/fd/201"));
    }

    #[test]
    fn what_is_opened_is_named() {
        for stage in [Stage::Loading, LOADED] {
            assert_eq!(open("/etc/shadow", LOADER_FLAGS, stage), forbidden("openat of /etc/shadow"));
            assert_eq!(open("/dev/tty", libc::O_RDWR, stage), forbidden("openat of /dev/tty"));
            let memory = open("/proc/4711/mem", libc::O_RDWR, stage);
            assert_eq!(
                memory,
                forbidden("openat of /proc/PID/mem"),
                "no process id: it goes into the journal"
            );
            let long = open(&format!("/usr/lib/{}", "x/../".repeat(100)), LOADER_FLAGS, stage);
            assert_eq!(long, forbidden("openat"), "its end is not known");
        }
        assert_eq!(open("/a/\u{1b}[2J", libc::O_RDWR, LOADED), forbidden("openat of /a/?[2J"));
        assert_eq!(decide(libc::SYS_openat, [0; 6], LOADED), forbidden("openat"));
        assert_eq!(decide(libc::SYS_socket, [0; 6], Stage::Loading), forbidden("socket"));
        assert_eq!(decide(9999, [0; 6], Stage::Loading), forbidden("call 9999"));
    }

    #[test]
    fn a_way_that_leads_back_is_named_however_it_begins() {
        for path in ["/usr/lib/../../etc/shadow", "/proc/self/../1/mem", "/proc/self/fd/../../../etc/shadow"]
        {
            for stage in [Stage::Loading, LOADED] {
                assert_eq!(open(path, LOADER_FLAGS, stage), forbidden(&format!("openat of {path}")));
                assert_eq!(ask_about(path, 0, stage), forbidden(&format!("newfstatat of {path}")));
            }
        }
    }

    #[test]
    fn what_libraries_ask_for_on_the_way_is_refused_and_survived() {
        for path in ["/proc/self/cgroup", "/proc/sys/vm/overcommit_memory"] {
            assert_eq!(open(path, LOADER_FLAGS, LOADED), Verdict::Refuse(libc::EACCES));
        }
        let memory = open("/proc/self/mem", libc::O_RDWR, LOADED);
        assert_eq!(memory, forbidden("openat of /proc/self/mem"), "nothing is written");
        let terminal = decide(libc::SYS_ioctl, [1, libc::TCGETS, 0, 0, 0, 0], LOADED);
        assert_eq!(terminal, Verdict::Refuse(libc::ENOTTY));
        let typed = decide(libc::SYS_ioctl, [0, libc::TIOCSTI, 0, 0, 0, 0], LOADED);
        assert_eq!(typed, forbidden("ioctl"));
    }

    #[test]
    fn the_status_of_open_files_is_given_and_of_others_is_not() {
        for stage in [Stage::Loading, LOADED] {
            assert!(matches!(ask_about("", libc::AT_EMPTY_PATH, stage), Verdict::Tell(_)));
            assert_eq!(ask_about("/etc/shadow", 0, stage), forbidden("newfstatat of /etc/shadow"));
            assert_eq!(ask_about("", 0, stage), Verdict::Refuse(libc::EACCES));
        }
        assert!(matches!(ask_about("/usr/lib/os-release", 0, Stage::Loading), Verdict::Tell(_)));
        assert_eq!(ask_about("/usr/lib/nothing", 0, Stage::Loading), Verdict::Refuse(libc::ENOENT));
        assert_eq!(ask_about("/usr/lib/os-release", 0, LOADED), Verdict::Refuse(libc::EACCES));
    }

    #[test]
    fn threads_are_no_processes() {
        let clone = |flags| decide(libc::SYS_clone, [flags, 0, 0, 0, 0, 0], LOADED);
        assert_eq!(clone(0x003d_0f00), Verdict::Allow, "as the C library starts a thread");
        assert_eq!(clone(libc::SIGCHLD as u64), Verdict::Forbid("fork".into()));
        let with_namespace = 0x003d_0f00 | libc::CLONE_NEWUSER as u64;
        assert_eq!(clone(with_namespace), Verdict::Forbid("clone".into()));
    }
}
