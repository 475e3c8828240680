//! Load and memory of a process, read from `/proc`.

use super::clock::Load;
use crate::stats::Memory;
use rustix::process::Pid;
use std::fs::{read_dir, read_to_string};
use std::time::Duration;

/// Reads the load of a process; `None` where there is no `/proc`.
pub(super) fn load_of(pid: Pid) -> Option<Load> {
    let process = format!("/proc/{}", pid.as_raw_pid());
    let ticks = Stat::of(&read_to_string(format!("{process}/stat")).ok()?)?.ticks;
    let threads = read_dir(format!("{process}/task")).ok()?;
    let mut stats = threads.flatten().filter_map(|thread| {
        // A thread may end while it is being read.
        Stat::of(&read_to_string(thread.path().join("stat")).ok()?)
    });
    let cpu = Duration::from_secs(ticks).checked_div(ticks_per_second())?;
    Some(Load { cpu, is_running: stats.any(|stat| matches!(stat.state, 'R' | 'D')) })
}

/// Reads memory and threads of a process; `None` where there is no `/proc`.
pub(super) fn memory_of(pid: Pid) -> Option<Memory> {
    memory_in(&read_to_string(format!("/proc/{}/status", pid.as_raw_pid())).ok()?)
}

/// Reads the private memory of a process, bytes: the pages that it has written to, and its page tables. Files that it
/// shares with others are not included.
pub(super) fn weight_of(pid: Pid) -> Option<u64> {
    weight_in(&read_to_string(format!("/proc/{}/status", pid.as_raw_pid())).ok()?)
}

fn weight_in(status: &str) -> Option<u64> {
    Some(bytes_in(status, "RssAnon:")? + bytes_in(status, "VmPTE:").unwrap_or_default())
}

fn bytes_in(status: &str, key: &str) -> Option<u64> {
    let value = status.lines().find_map(|line| line.strip_prefix(key))?;
    Some(value.strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

fn memory_in(status: &str) -> Option<Memory> {
    let bytes = |key: &str| bytes_in(status, key);
    let threads = status.lines().find_map(|line| line.strip_prefix("Threads:"))?.trim().parse().ok()?;
    Some(Memory { now_bytes: bytes("VmRSS:")?, most_bytes: bytes("VmHWM:")?, threads })
}

fn ticks_per_second() -> u32 {
    u32::try_from(rustix::param::clock_ticks_per_second()).unwrap_or(100)
}

/// State and processor time of a process or thread.
#[derive(Debug, PartialEq, Eq)]
struct Stat {
    state: char,
    /// Processor time in user and system mode, clock ticks.
    ticks: u64,
}

impl Stat {
    /// Parses a line of `/proc/PID/stat`; the name of the program may contain anything.
    fn of(line: &str) -> Option<Self> {
        let (_, fields) = line.rsplit_once(')')?;
        let fields: Vec<&str> = fields.split_ascii_whitespace().collect();
        let ticks = |at: usize| fields.get(at)?.parse::<u64>().ok();
        Some(Self { state: fields.first()?.chars().next()?, ticks: ticks(11)? + ticks(12)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn state_and_time_are_found_behind_any_name() {
        let line = "7 (a) R (b) S 1 7 7 0 -1 4194560 110 0 0 0 30 12 0 0 20 0 3 0 4242 0";
        assert_eq!(Stat::of(line), Some(Stat { state: 'S', ticks: 42 }));
        assert_eq!(Stat::of("7 (cut off"), None);
        assert_eq!(Stat::of("7 (a) R 1 2"), None);
    }

    #[test]
    fn memory_is_found_by_its_names() {
        let status = "Name:\tworker\nVmHWM:\t    5600 kB\nVmRSS:\t    5000 kB\nThreads:\t3\n";
        let memory = Memory { now_bytes: 5000 << 10, most_bytes: 5600 << 10, threads: 3 };
        assert_eq!((memory_in(status), memory_in("Name:\tworker\n")), (Some(memory), None));
    }

    #[test]
    fn what_a_process_alone_has_is_what_it_wrote_and_the_tables_for_it() {
        let status = "VmRSS:\t 9000 kB\nRssAnon:\t  3000 kB\nRssFile:\t 6000 kB\nVmPTE:\t 100 kB\n";
        assert_eq!((weight_in(status), weight_in("VmRSS:\t9 kB\n")), (Some(3100 << 10), None));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_very_process_runs() {
        let load = load_of(rustix::process::getpid()).expect("it is there");
        assert!(load.is_running);
    }
}
