//! The log of a robot process that outlives its adapter: the file that is named in `ROBOT_LOG`.

use crate::address::Address;
use std::{
    fs, io,
    path::PathBuf,
    sync::atomic::{AtomicU64, Ordering},
};
use vehicle::trial::Sample;

/// Maximum number of bytes that are read, from the end of the log.
const READ_BYTES: usize = 1 << 20;

/// A file to which a robot writes its motion: in each period a line with time, speed ahead and turn rate, separated by
/// spaces, on the clock of its stamps. Each start of an adapter has its own file, because the robot of an earlier start
/// may still write.
pub(super) struct RobotLog(PathBuf);

impl RobotLog {
    pub(super) fn new() -> io::Result<Self> {
        static STARTS: AtomicU64 = AtomicU64::new(0);
        let start = STARTS.fetch_add(1, Ordering::Relaxed);
        let name = format!("tankops-robot-{}-{start}.log", std::process::id());
        let path = std::env::temp_dir().join(name);
        fs::write(&path, "")?;
        Ok(Self(path))
    }

    /// The address with a command that receives the name of this file in its environment.
    pub(super) fn named_to(&self, address: &Address) -> Address {
        match address {
            Address::Run(command) => {
                let path = self.0.to_string_lossy().replace('\'', r"'\''");
                Address::Run(format!("export ROBOT_LOG='{path}'; {command}"))
            }
            other => other.clone(),
        }
    }

    /// The motion in the log; lines that are not complete are left out.
    pub(super) fn samples(&self) -> Vec<Sample> {
        let bytes = fs::read(&self.0).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes[bytes.len().saturating_sub(READ_BYTES)..]).into_owned();
        samples(&text)
    }
}

impl Drop for RobotLog {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn samples(text: &str) -> Vec<Sample> {
    let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
    let rows: Vec<[f64; 3]> = whole
        .lines()
        .filter_map(|line| {
            let values: Vec<f64> = line.split(' ').map(str::parse).collect::<Result<_, _>>().ok()?;
            let row: [f64; 3] = values.try_into().ok()?;
            row.iter().all(|value| value.is_finite()).then_some(row)
        })
        .collect();
    let between = |pair: &[[f64; 3]]| {
        let [t_s, v, w] = pair[1];
        let over_s = t_s - pair[0][0];
        Sample { t_s, over_s, way_m: (v * over_s).abs(), turn_rad: w * over_s }
    };
    rows.windows(2).map(between).filter(|sample| sample.over_s > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_lines_become_motion() {
        let found = samples("1.0 0.0 0.0\n1.5 0.4 -0.2\nnonsense\n2.0 nan 0\n1.4 1 1\n2.5 0.2 0\n2.6 0.");
        let [one, two] = found[..] else { panic!("{found:?}") };
        assert_eq!((one.t_s, one.over_s, one.way_m, one.turn_rad), (1.5, 0.5, 0.2, -0.1));
        assert!((two.t_s - 2.5).abs() < 1e-12 && (two.way_m - 0.22).abs() < 1e-12);
        assert!(samples("").is_empty());
    }

    #[test]
    fn only_commands_learn_of_the_log() {
        let log = RobotLog::new().unwrap();
        let of = |text: &str| log.named_to(&text.parse().unwrap()).to_string();
        assert_eq!(of("unix:a"), "unix:a");
        assert!(
            of("run:./adapter").ends_with("'; ./adapter")
                && of("run:x").starts_with("run:export ROBOT_LOG='")
        );
        fs::write(&log.0, "1 0 0\n2 0.5 0\n").unwrap();
        let next = RobotLog::new().unwrap();
        assert_eq!((log.samples().len(), next.samples().len()), (1, 0), "each start has its own log");
    }
}
