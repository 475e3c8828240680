//! Keeps all tracks from scan to scan.

mod points;
mod tracks;

use crate::{
    Drift, Sensor, Trouble,
    check::Agreement,
    drawing::{Buffers, Drawing},
    groups::Group,
    layout::Layout,
    matching::{Matched, matched},
    rays::Rays,
    through::Missing,
    track::Track,
    uncertain::Uncertain,
};
use geometry::{Boundary, Pose, Shape};
use nalgebra::{Isometry2, Matrix3};
use world::{Obstacle, ObstacleId, ObstacleMap, Scan};

/// The first id of obstacles that are found in scans; drawings and the trackers of vehicles use smaller ids.
pub const FIRST_ID: u32 = 2_000_000;
/// Marks a ray that belongs to no track.
const NONE: u16 = u16::MAX;

/// A scan, with the state in which it is processed.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Mission time, seconds.
    pub now_s: f64,
    /// The scan.
    pub scan: &'a Scan,
    /// Estimated pose of the robot at the end of the readings.
    pub pose: Pose,
    /// Covariance of x, y and heading of that pose.
    pub covariance: Matrix3<f64>,
    /// The wall.
    pub boundary: &'a Boundary,
    /// All obstacles on the chart.
    pub charted: &'a [Obstacle],
    /// An index of the drawn obstacles. What scans have shown must not explain later scans: wrong scans could then never
    /// be noticed.
    pub map: &'a ObstacleMap,
    /// Radius of the hull, metres; echoes from inside it are ignored.
    pub hull_m: f64,
    /// Distance from the scanner, metres, within which a track can become an obstacle; farther away, it is only
    /// followed.
    pub reach_m: f64,
}

/// An obstacle that the last scan showed.
#[derive(Debug, Clone)]
pub struct Seen<'a> {
    /// The id, at least [`FIRST_ID`].
    pub id: ObstacleId,
    /// The outline according to all scans, tank frame.
    pub shape: Shape,
    /// The outline in the robot frame, relative to the estimated pose: where the robot sees the obstacle now.
    pub shape_in_robot: Shape,
    /// Standard deviation of the outline, metres.
    pub sigma_m: f64,
    /// The recent positions of the obstacle.
    pub drift: &'a Drift,
}

/// The results of a scan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Looked {
    /// Obstacles that are not at the place where they are drawn or were found, each with the number of scans through
    /// that place.
    pub not_there: Vec<(ObstacleId, u32)>,
}

/// The tracks, with buffers that are reused for the next scan.
#[derive(Debug, Clone)]
pub struct Perception {
    sensor: Sensor,
    tracks: Vec<Track>,
    next_id: u32,
    /// Ids of dropped moving obstacles, to be used again for new obstacles.
    free_ids: Vec<ObstacleId>,
    /// The drawn obstacles through which scans passed.
    missing: Missing,
    agreement: Agreement,
    layout: Layout,
    /// Maximum distance that the scanner can measure, metres, if it is known.
    range_m: Option<f64>,
    trouble: Option<Trouble>,
    /// Time of the last scan that was used, seconds.
    looked_s: Option<f64>,
    /// The correction of the estimated pose, in the robot frame.
    correction: Isometry2<f64>,
    /// The pose according to the last scan, if scans locate the robot.
    matched: Option<Matched>,
    rays: Rays,
    buffers: Buffers,
    explained: Vec<bool>,
    owners: Vec<u16>,
    nearest_m: Vec<f64>,
    left: Vec<usize>,
    groups: Vec<Group>,
    own: Vec<usize>,
    /// For each track, whether it owns a ray.
    owned: Vec<bool>,
    parts: Vec<Group>,
}

impl Perception {
    /// Creates the state before the first scan.
    pub fn new(sensor: Sensor) -> Self {
        Self {
            layout: Layout::default(),
            range_m: None,
            sensor,
            tracks: Vec::new(),
            next_id: FIRST_ID,
            free_ids: Vec::new(),
            missing: Missing::default(),
            agreement: Agreement::default(),
            trouble: None,
            looked_s: None,
            correction: Isometry2::identity(),
            matched: None,
            rays: Rays::default(),
            buffers: Buffers::default(),
            explained: Vec::new(),
            owners: Vec::new(),
            nearest_m: Vec::new(),
            left: Vec::new(),
            groups: Vec::new(),
            own: Vec::new(),
            owned: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// The reason why the scans cannot be used; `None` if they can.
    pub fn trouble(&self) -> Option<Trouble> {
        self.trouble
    }

    /// The pose according to the last scan; `None` if scans do not locate the robot, if the last one cannot be right, or
    /// if it shows too little of the drawing.
    pub fn matched(&self) -> Option<Matched> {
        self.matched
    }

    /// Processes a scan.
    pub fn look(&mut self, view: &View<'_>) -> Looked {
        let given = Uncertain::estimated(self.sensor.sigma_m, &view.covariance);
        self.matched = None;
        self.trouble = self.scan_trouble(view, &given);
        if self.trouble.is_some() {
            self.tracks.iter_mut().for_each(|track| track.is_seen = false);
            return Looked::default();
        }
        let scanned_from = *self.rays.frame();
        let reach_m = self.rays.range_m.iter().copied().filter(|m| m.is_finite()).fold(1.0, f64::max) + 1.0;
        let drawn = view.charted.iter().filter(|obstacle| obstacle.id.0 < FIRST_ID);
        let drawing = Drawing::near(view.boundary, drawn, self.rays.eye(), reach_m);
        let corrected = drawing.correct(&mut self.rays, &given, &mut self.buffers);
        if self.sensor.locates && !self.agreement.is_open() && !self.agreement.is_doubtful() {
            self.matched = matched(&scanned_from, &corrected, &view.scan.since);
        }
        let pose = corrected.pose;
        self.correction = scanned_from.inverse() * self.rays.frame();
        drawing.explain(&self.rays, &pose, &mut self.buffers, &mut self.explained);
        let later_s = self.looked_s.replace(view.now_s).map_or(0.0, |looked_s| view.now_s - looked_s);
        self.tracks.iter_mut().for_each(|track| track.begin(later_s));
        self.share_out(&pose);
        self.join_groups(&pose);
        self.update(&pose, view.now_s);
        if !self.begin_tracks(&pose, view.now_s) {
            self.trouble = Some(Trouble::Crowded { most: tracks::MOST });
        }
        // The chart must not contain what a wrong scan shows.
        if !self.agreement.is_open() && !self.agreement.is_doubtful() {
            self.give_ids(view.charted, view.reach_m);
        }
        let mut not_there = self.missing.look(&drawing, &self.rays, &pose, self.range_m);
        not_there.extend(self.tracks.iter().filter_map(|track| Some((track.id?, track.is_gone()?))));
        self.drop_tracks(view.now_s);
        Looked { not_there }
    }

    /// The obstacles that the last scan showed, for a robot whose estimated pose is now `pose`.
    pub fn seen(&self, pose: &Pose) -> impl Iterator<Item = Seen<'_>> {
        let robot_from_tank = (pose.tank_from_robot() * self.correction).inverse();
        self.tracks.iter().filter(|track| track.is_seen).filter_map(move |track| {
            let shape = track.shape();
            let shape_in_robot = shape.transformed(&robot_from_tank);
            Some(Seen {
                id: track.id?,
                shape,
                shape_in_robot,
                sigma_m: track.sigma_m(),
                drift: track.drift(),
            })
        })
    }

    /// Whether the scans agree with the drawing as far as this is known: they can be used, and no verdict is pending.
    pub fn agrees(&self) -> bool {
        self.trouble.is_none() && !self.agreement.is_open() && !self.agreement.is_doubtful()
    }

    /// The pose of a robot with this estimated pose, corrected by what the last scan shows of the drawing.
    pub fn corrected(&self, pose: &Pose) -> Pose {
        let corrected = pose.tank_from_robot() * self.correction;
        Pose { position: corrected.translation.vector.into(), heading_rad: corrected.rotation.angle() }
    }

    /// Number of objects that are followed now, whether they are obstacles yet or not.
    pub fn tracks(&self) -> usize {
        self.tracks.len()
    }

    /// Takes the rays of a scan; returns the reason why the scan cannot be used, or `None` if it can.
    fn scan_trouble(&mut self, view: &View<'_>, given: &Uncertain) -> Option<Trouble> {
        let trouble = self.layout.trouble(view.scan, &self.sensor);
        if trouble.is_some() {
            return trouble;
        }
        self.rays.take(view.scan, &view.pose.tank_from_robot());
        self.rays.ignore_hull(view.hull_m);
        self.range_m = self.sensor.range_m.or(view.scan.range_max_m);
        self.agreement.compare(&self.rays, (view.boundary, view.map), given, self.range_m);
        self.agreement.trouble()
    }
}
