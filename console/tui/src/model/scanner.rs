//! The scanner: its last scan, and whether its scans can be used.

use super::Run;
use mission::{Event, EventKind};
use serde::{Deserialize, Serialize};
use world::{Point, Pose, Scan};

/// The scanner as its events describe it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Scanner {
    /// The last scan.
    pub scan: Option<SeenScan>,
    /// Why the scans cannot be used, as a clause; `None` if they can.
    pub trouble: Option<String>,
    /// Whether the scans correct the estimated position.
    #[serde(default)]
    pub aids: bool,
}

/// A scan that has arrived.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeenScan {
    /// Mission time, seconds.
    pub t_s: f64,
    /// Number of rays.
    pub rays: usize,
    /// The scanned points in the tank, according to the estimated pose of that tick, metres; in the robot frame until
    /// that pose is known.
    pub points: Vec<Point>,
    is_placed: bool,
}

impl SeenScan {
    /// The points, once they are placed in the tank.
    pub fn placed(&self) -> &[Point] {
        if self.is_placed { &self.points } else { &[] }
    }

    fn place(&mut self, pose: &Pose) {
        let tank_from_robot = pose.tank_from_robot();
        self.points.iter_mut().for_each(|point| *point = tank_from_robot * *point);
        self.is_placed = true;
    }
}

impl Run {
    /// Folds in what an event says about the scanner.
    pub(super) fn scanned(&mut self, event: &Event) {
        let scan: &Scan = match &event.kind {
            EventKind::Scanned { scan } => scan,
            EventKind::Sensed { readings, .. } => match &readings.scan {
                Some(scan) => scan,
                None => return,
            },
            EventKind::ScannerJudged { trouble } => {
                self.scanner.trouble.clone_from(trouble);
                return;
            }
            EventKind::ScanAided { trouble } => {
                self.scanner.aids = trouble.is_none();
                return;
            }
            // The pose is estimated from the readings of the same tick.
            EventKind::Estimated { pose } => {
                let at = Pose { position: pose.position, heading_rad: pose.heading_rad };
                if let Some(scan) = self.scanner.scan.as_mut().filter(|scan| !scan.is_placed) {
                    scan.place(&at);
                }
                return;
            }
            _ => return,
        };
        let (rays, points) = (scan.ranges_mm.0.len(), scan.points().collect());
        self.scanner.scan = Some(SeenScan { t_s: event.t_s, rays, points, is_placed: false });
    }
}
