//! A run as MCAP with ROS 2 messages, for Foxglove and similar tools.
//!
//! | topic | message | when |
//! |---|---|---|
//! | `/map` | `nav_msgs/OccupancyGrid` | once: floor 0, solid or outside 100 |
//! | `/coverage` | `nav_msgs/OccupancyGrid` | while floor is scanned: to do 0, scanned 100, no floor -1 |
//! | `/plan` | `nav_msgs/Path` | with every plan |
//! | `/pose` | `geometry_msgs/PoseWithCovarianceStamped` | every tick: the estimate |
//! | `/fix` | `geometry_msgs/PoseWithCovarianceStamped` | every position from ranges |
//! | `/truth` | `geometry_msgs/PoseStamped` | every tick of a simulated run |
//! | `/track` | `nav_msgs/Path` | at the end: all estimates |
//! | `/readings` | `sensor_msgs/PointCloud2` | every tick with readings of a simulated instrument: place, thickness, channel |
//! | `/log` | `rcl_interfaces/Log` | every line of the log |
//!
//! All messages use the frame `tank`; time is mission time.

mod cdr;
mod out;
mod ros;
mod summary;

use crate::{error::RecordingError, journal::JournalReader};
use ::mcap::{WriteOptions, Writer, records::MessageHeader};
use account::{Fold, Reading};
use cdr::Cdr;
use mission::{Event, EventKind, Severity, event::RunOpened};
use nalgebra::{Matrix2, Matrix3};
use out::Out;
use ros::{Pose3, Stamp};
use std::{
    collections::{BTreeMap, btree_map::Entry},
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};
use world::{Cell, CoverageGrid, Floor, FloorClass, Point, Pose, Station};

/// Time between two pictures of the scanned floor, seconds.
const COVERAGE_S: f64 = 5.0;
/// Minimum distance between two points of the track, metres.
const TRACK_M: f64 = 0.01;

/// Writes the run of a journal as MCAP. If the journal is cut off, the file extends to that point, and the returned
/// text states what is missing.
///
/// # Errors
/// The journal is missing or damaged, or the file cannot be written; an existing file is never overwritten.
pub fn export_mcap(journal: &Path, file: &Path) -> Result<Option<String>, RecordingError> {
    let mut reader = JournalReader::open(journal)?;
    let out = File::create_new(file)
        .map_err(|error| RecordingError::Create { why: error.to_string(), path: file.into() })?;
    let not_written = |why: String| RecordingError::File { why, path: file.into() };
    let (out, failure) = Out::new(BufWriter::new(out));
    let options = WriteOptions::new().profile("ros2").library("tankops");
    let out = options.create(out).map_err(|error| not_written(error.to_string()))?;
    let mut export = Export { out, channels: BTreeMap::new(), run: None, account: None };
    for event in reader.by_ref() {
        export.take(&event?).map_err(|error| not_written(error.to_string()))?;
        if failure.error().is_some() {
            break;
        }
    }
    export.finish().map_err(|error| not_written(error.to_string()))?;
    failure.error().map_or(Ok(()), |error| Err(not_written(error.to_string())))?;
    summary::sort(file).map_err(|error| not_written(error.to_string()))?;
    Ok(reader.truncated().map(str::to_owned))
}

type Done = Result<(), ::mcap::McapError>;

struct Export {
    out: Writer<Out<BufWriter<File>>>,
    /// Channel and next sequence number of each topic.
    channels: BTreeMap<&'static str, (u16, u32)>,
    run: Option<Run>,
    /// The account of a run whose instrument reads thickness.
    account: Option<Box<Fold>>,
}

/// State of a run that has been opened.
struct Run {
    stations: Vec<Station>,
    coverage: CoverageGrid,
    /// Time at which floor was first scanned after the last picture of the scanned floor; `None` if nothing was scanned
    /// since then.
    changed_since_s: Option<f64>,
    track: Vec<(f64, Pose)>,
    now_s: f64,
}

impl Export {
    fn take(&mut self, event: &Event) -> Done {
        if let (EventKind::RunOpened(opened), None) = (&event.kind, &self.run) {
            self.open(opened, event.t_s)?;
            let has_readings = opened.mission.instrument.as_ref().is_some_and(|of| of.sampling.is_some());
            self.account = (has_readings && opened.wear.is_some()).then(Box::default);
        }
        if let Some(mut account) = self.account.take() {
            account.apply(event);
            if let (EventKind::Estimated { .. }, Some(survey)) = (&event.kind, account.survey()) {
                self.readings(event.t_s, survey.latest())?;
            }
            self.account = Some(account);
        }
        let Some(mut run) = self.run.take() else { return Ok(()) };
        run.now_s = event.t_s;
        let done = self.write(&mut run, event);
        self.run = Some(run);
        done
    }

    fn open(&mut self, opened: &RunOpened, t_s: f64) -> Done {
        let floor = &opened.floor;
        self.grid("/map", t_s, floor, |index| if floor.kind(index) == Cell::Outside { 100 } else { 0 })?;
        self.run = Some(Run {
            stations: opened.world.stations.clone(),
            coverage: CoverageGrid::new(floor.clone()),
            changed_since_s: None,
            track: Vec::new(),
            now_s: t_s,
        });
        Ok(())
    }

    fn write(&mut self, run: &mut Run, event: &Event) -> Done {
        let t_s = event.t_s;
        match &event.kind {
            EventKind::Estimated { pose } => {
                let here = Pose { position: pose.position, heading_rad: pose.heading_rad };
                if run.track.last().is_none_or(|(_, last)| (last.position - here.position).norm() > TRACK_M) {
                    run.track.push((t_s, here));
                }
                self.located("/pose", t_s, here, &pose.covariance)?;
            }
            EventKind::Fixed { fix } => {
                let here = Pose { position: fix.position, heading_rad: 0.0 };
                self.located("/fix", t_s, here, &position_only(&fix.covariance))?;
            }
            EventKind::Truth { pose, .. } => {
                let message = Cdr::new().stamp(Stamp::of(t_s)).pose(Pose3::of(*pose));
                self.message("/truth", ros::POSE, t_s, &message)?;
            }
            EventKind::Planned { path, .. } => {
                let poses: Vec<(f64, Pose)> = headed(path).map(|pose| (t_s, pose)).collect();
                self.path("/plan", t_s, &poses)?;
            }
            EventKind::Covered { runs } => {
                run.coverage.apply(runs);
                run.changed_since_s.get_or_insert(t_s);
            }
            EventKind::FloorChanged { changes } => run.coverage.change(changes),
            _ => {}
        }
        if run.changed_since_s.is_some_and(|since_s| t_s - since_s >= COVERAGE_S) {
            self.coverage(run)?;
        }
        self.log(run, event)
    }

    fn log(&mut self, run: &Run, event: &Event) -> Done {
        let Some(line) = event.log_line(&run.stations) else { return Ok(()) };
        let level = match line.severity {
            Severity::Debug => 10,
            Severity::Info => 20,
            Severity::Watch | Severity::Warn => 30,
            Severity::Crit => 40,
        };
        let Stamp { sec, nanosec } = Stamp::of(event.t_s);
        let message = Cdr::new()
            .i32(sec)
            .u32(nanosec)
            .u8(level)
            .text(line.source)
            .text(&line.text)
            .text("")
            .text("")
            .u32(0);
        self.message("/log", ros::LOG, event.t_s, &message)
    }

    fn coverage(&mut self, run: &mut Run) -> Done {
        run.changed_since_s = None;
        let (grid, floor) = (&run.coverage, run.coverage.floor());
        let class = |index| FloorClass::of(floor.kind(index), u32::from(grid.is_covered(index)));
        self.grid("/coverage", run.now_s, floor, |index| match class(index) {
            FloorClass::Outside => -1,
            class if class.is_scanned() => 100,
            _ => 0,
        })
    }

    fn grid(&mut self, topic: &'static str, t_s: f64, floor: &Floor, cell: impl Fn(usize) -> i8) -> Done {
        let origin = Pose3::of(Pose { position: floor.origin, heading_rad: 0.0 });
        let (width, height) = (floor.width as u32, floor.height as u32);
        let Stamp { sec, nanosec } = Stamp::of(t_s);
        let message = Cdr::new()
            .stamp(Stamp::of(t_s))
            .i32(sec)
            .u32(nanosec)
            .f32(floor.cell_m as f32)
            .u32(width)
            .u32(height)
            .pose(origin)
            .u32(width * height);
        let message = (0..floor.len()).fold(message, |message, index| message.i8(cell(index)));
        self.message(topic, ros::GRID, t_s, &message)
    }

    fn located(&mut self, topic: &'static str, t_s: f64, pose: Pose, covariance: &Matrix3<f64>) -> Done {
        // Rows and columns of x, y, z, roll, pitch, yaw.
        let axes = [0, 1, 5];
        let mut all = [0.0; 36];
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            all[6 * axes[i] + axes[j]] = covariance[(i, j)];
        }
        let message = Cdr::new().stamp(Stamp::of(t_s)).pose(Pose3::of(pose));
        let message = all.iter().fold(message, |message, value| message.f64(*value));
        self.message(topic, ros::POSE_WITH_COVARIANCE, t_s, &message)
    }

    fn readings(&mut self, t_s: f64, readings: &[Reading]) -> Done {
        if readings.is_empty() {
            return Ok(());
        }
        let length = ros::POINT_BYTES * readings.len() as u32;
        let message = Cdr::new().stamp(Stamp::of(t_s)).u32(1).u32(readings.len() as u32);
        let message = message.u32(ros::POINT_FIELDS.len() as u32);
        let message = ros::POINT_FIELDS
            .iter()
            .fold(message, |message, (name, offset, kind)| message.text(name).u32(*offset).u8(*kind).u32(1));
        let message = message.u8(0).u32(ros::POINT_BYTES).u32(length).u32(length);
        let message = readings.iter().fold(message, |message, reading| {
            let [x, y, mm] =
                [reading.at.x, reading.at.y, reading.thickness_mm].map(|v| (v as f32).to_le_bytes());
            let [low, high] = reading.channel.to_le_bytes();
            let rest = [low, high, u8::from(reading.is_testable), 0];
            [x, y, [0; 4], mm, rest].as_flattened().iter().fold(message, |message, byte| message.u8(*byte))
        });
        self.message("/readings", ros::POINTS, t_s, &message.u8(1))
    }

    fn path(&mut self, topic: &'static str, t_s: f64, poses: &[(f64, Pose)]) -> Done {
        let message = Cdr::new().stamp(Stamp::of(t_s)).u32(poses.len() as u32);
        let message = poses.iter().fold(message, |message, (then_s, pose)| {
            message.stamp(Stamp::of(*then_s)).pose(Pose3::of(*pose))
        });
        self.message(topic, ros::PATH, t_s, &message)
    }

    fn message(&mut self, topic: &'static str, schema: ros::Schema, t_s: f64, message: &Cdr) -> Done {
        let channel = match self.channels.entry(topic) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let id = self.out.add_schema(schema.name, "ros2msg", schema.text().as_bytes())?;
                let id = self.out.add_channel(id, topic, "cdr", &BTreeMap::new())?;
                new.insert((id, 0))
            }
        };
        let time = Stamp::of(t_s).nanoseconds();
        let header =
            MessageHeader { channel_id: channel.0, sequence: channel.1, log_time: time, publish_time: time };
        channel.1 += 1;
        self.out.write_to_known_channel(&header, message.bytes())
    }

    fn finish(mut self) -> Done {
        if let Some(mut run) = self.run.take() {
            if run.changed_since_s.is_some() {
                self.coverage(&mut run)?;
            }
            self.path("/track", run.now_s, &run.track)?;
        }
        self.out.finish()?;
        // An error of the last data is kept with the others.
        self.out.into_inner().flush()?;
        Ok(())
    }
}

/// A covariance of x and y; the heading is unknown.
fn position_only(covariance: &Matrix2<f64>) -> Matrix3<f64> {
    let mut whole = Matrix3::zeros();
    whole.fixed_view_mut::<2, 2>(0, 0).copy_from(covariance);
    whole[(2, 2)] = std::f64::consts::PI.powi(2);
    whole
}

/// The points of a path, each with the heading to the next point.
fn headed(path: &[Point]) -> impl Iterator<Item = Pose> {
    path.iter().enumerate().map(|(index, point)| {
        let (from, to) = match path.get(index + 1) {
            Some(next) => (*point, *next),
            None => (path[index.saturating_sub(1)], *point),
        };
        Pose { position: *point, heading_rad: (to.y - from.y).atan2(to.x - from.x) }
    })
}
