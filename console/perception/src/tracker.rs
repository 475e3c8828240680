//! Keeps all tracks from scan to scan.

use crate::{
    Drift, Sensor,
    check::Agreement,
    drawing::{Buffers, Drawing},
    groups::{self, Group, groups},
    rays::Rays,
    through::{self, Look},
    track::Track,
    uncertain::Uncertain,
};
use geometry::{Boundary, Pose, Shape};
use nalgebra::{Isometry2, Matrix3};
use std::collections::BTreeMap;
use world::{Obstacle, ObstacleId, ObstacleMap, Scan};

/// The first id of obstacles that are found in scans; drawings and the trackers of vehicles use smaller ids.
pub const FIRST_ID: u32 = 2_000_000;
/// Maximum number of tracks.
const MOST: usize = 512;
/// Maximum distance from a track, metres, at which a group belongs to the track.
const JOIN_M: f64 = 0.12;
/// Maximum extent, metres, of a track that can still take further groups.
const GROWS_TO_M: f64 = 1.0;
/// Minimum number of points for updating a track.
const LEAST_POINTS: usize = 2;
/// A drawn obstacle is reported as missing after this number of scans that pass through its place, if none in between
/// shows it.
const MISSING_AFTER: u32 = 40;
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
    /// An index of these obstacles for queries.
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
    /// Number of scans that passed through each drawn obstacle.
    through: BTreeMap<ObstacleId, u32>,
    agreement: Agreement,
    /// Number of rays of the first scan.
    rays_at_first: Option<usize>,
    /// Maximum distance that the scanner can measure, metres, if it is known.
    range_m: Option<f64>,
    trouble: Option<String>,
    /// Time of the last scan that was used, seconds.
    looked_s: Option<f64>,
    /// The correction of the estimated pose, in the robot frame.
    correction: Isometry2<f64>,
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

/// Drops the track of the obstacle on the chart that has been out of sight for the longest time; returns whether one was
/// dropped.
fn make_room(tracks: &mut Vec<Track>) -> bool {
    let charted = tracks.iter().enumerate().filter_map(|(k, track)| Some((k, track.charted_s()?)));
    let oldest = charted.min_by(|a, b| a.1.total_cmp(&b.1));
    oldest.map(|(k, _)| tracks.remove(k)).is_some()
}

impl Perception {
    /// Creates the state before the first scan.
    pub fn new(sensor: Sensor) -> Self {
        Self {
            rays_at_first: None,
            range_m: None,
            sensor,
            tracks: Vec::new(),
            next_id: FIRST_ID,
            free_ids: Vec::new(),
            through: BTreeMap::new(),
            agreement: Agreement::default(),
            trouble: None,
            looked_s: None,
            correction: Isometry2::identity(),
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

    /// The reason why the scans cannot be used, as a clause; `None` if they can.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// Processes a scan.
    pub fn look(&mut self, view: &View<'_>) -> Looked {
        let given = Uncertain::estimated(self.sensor.sigma_m, &view.covariance);
        self.trouble = self.scan_trouble(view, &given);
        if self.trouble.is_some() {
            self.tracks.iter_mut().for_each(|track| track.is_seen = false);
            return Looked::default();
        }
        let scanned_from = *self.rays.frame();
        let reach_m = self.rays.range_m.iter().copied().filter(|m| m.is_finite()).fold(1.0, f64::max) + 1.0;
        let drawn = view.charted.iter().filter(|obstacle| obstacle.id.0 < FIRST_ID);
        let drawing = Drawing::near(view.boundary, drawn, self.rays.eye(), reach_m);
        let pose = drawing.correct(&mut self.rays, &given, &mut self.buffers);
        self.correction = scanned_from.inverse() * self.rays.frame();
        drawing.explain(&self.rays, &pose, &mut self.buffers, &mut self.explained);
        let later_s = self.looked_s.replace(view.now_s).map_or(0.0, |looked_s| view.now_s - looked_s);
        self.tracks.iter_mut().for_each(|track| track.begin(later_s));
        self.share_out(&pose);
        self.join_groups(&pose);
        self.update(&pose, view.now_s);
        if !self.begin_tracks(&pose, view.now_s) {
            self.trouble = Some(format!(
                "the scans show more than {MOST} objects that are not drawn; check the scanner, the position and the \
                 drawing"
            ));
        }
        // The chart must not contain what a wrong scan shows.
        if !self.agreement.is_open() {
            self.give_ids(view.charted, view.reach_m);
        }
        let mut not_there = self.missing(&drawing, &pose);
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

    /// Number of objects that are followed now, whether they are obstacles yet or not.
    pub fn tracks(&self) -> usize {
        self.tracks.len()
    }

    /// Takes the rays of a scan; returns the reason why the scan cannot be used, or `None` if it can.
    fn scan_trouble(&mut self, view: &View<'_>, given: &Uncertain) -> Option<String> {
        let trouble = self.layout_trouble(view.scan);
        if trouble.is_some() {
            return trouble;
        }
        self.rays.take(view.scan, &view.pose.tank_from_robot());
        self.rays.ignore_hull(view.hull_m);
        self.range_m = self.sensor.range_m.or(view.scan.range_max_m);
        self.agreement.compare(&self.rays, (view.boundary, view.map), given, self.range_m);
        self.agreement.trouble()
    }

    /// The reason why scans of this layout cannot be used; `None` if they can.
    fn layout_trouble(&mut self, scan: &Scan) -> Option<String> {
        let n = scan.ranges_mm.0.len();
        let is_finite = scan.first_rad.is_finite() && scan.sensor_m.iter().all(|m| m.is_finite());
        if n == 0 {
            return Some("the scan has no rays".into());
        }
        if !is_finite || !scan.step_rad.is_normal() {
            return Some("the angles of the scan are not numbers, or all the same".into());
        }
        if let Some(wanted) = self.sensor.rays {
            return (n != wanted as usize).then(|| format!("the scan has {n} rays instead of {wanted}"));
        }
        // Some scanners leave out rays without an echo, so the number of rays is not always the same.
        let first = *self.rays_at_first.get_or_insert(n);
        let least = first.div_ceil(2);
        (n < least).then(|| {
            format!("the scan has {n} rays; it must have at least {least}, half as many as the first scan")
        })
    }

    /// Assigns each point that the drawing does not explain to the track with the nearest outline.
    fn share_out(&mut self, pose: &Uncertain) {
        let Self { tracks, rays, owners, nearest_m, explained, .. } = self;
        owners.clear();
        owners.resize(rays.len(), NONE);
        nearest_m.clear();
        nearest_m.resize(rays.len(), f64::INFINITY);
        for (k, track) in tracks.iter().enumerate() {
            let (center, radius_m) = track.around();
            let far_m = (center - rays.eye()).norm();
            let gate_m = track.gate_m(pose, far_m);
            let shape = track.shape();
            for ray in rays.towards(center, radius_m + gate_m) {
                if explained[ray] || (rays.range_m[ray] - far_m).abs() > radius_m + gate_m {
                    continue;
                }
                let off_m = shape.distance_m(rays.point(ray)).abs();
                if off_m <= gate_m && off_m < nearest_m[ray] {
                    (owners[ray], nearest_m[ray]) = (k as u16, off_m);
                }
            }
        }
    }

    /// Groups the remaining points, and assigns a group beside a track to that track.
    fn join_groups(&mut self, pose: &Uncertain) {
        let Self { tracks, rays, owners, explained, left, groups: found, .. } = self;
        left.clear();
        left.extend((0..rays.len()).filter(|ray| !explained[*ray] && owners[*ray] == NONE));
        groups::turned(rays, left, pose.sigma_m);
        groups(rays, left, pose.sigma_m, found);
        for group in found.iter() {
            let of = &left[group.rays.clone()];
            let apart_m = |track: &Track| {
                let shape = track.shape();
                of.iter().map(|ray| shape.distance_m(rays.point(*ray))).fold(f64::INFINITY, f64::min)
            };
            let is_near = |track: &Track| {
                let (center, radius_m) = track.around();
                let reach_m = radius_m + JOIN_M + GROWS_TO_M;
                (rays.point(of[0]) - center).norm() < reach_m && track.extent_m() < GROWS_TO_M
            };
            let near = tracks.iter().enumerate().filter(|(_, track)| is_near(track));
            let nearest = near.map(|(k, track)| (k, apart_m(track))).min_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((k, _)) = nearest.filter(|(_, apart_m)| *apart_m < JOIN_M) {
                for ray in of {
                    owners[*ray] = k as u16;
                }
            }
        }
    }

    /// Updates each track with its points.
    fn update(&mut self, pose: &Uncertain, now_s: f64) {
        let Self { tracks, rays, owners, own, owned, parts, .. } = self;
        owned.clear();
        owned.resize(tracks.len(), false);
        for owner in owners.iter().filter(|owner| **owner != NONE) {
            owned[usize::from(*owner)] = true;
        }
        for (k, track) in tracks.iter_mut().enumerate() {
            own.clear();
            if owned[k] {
                let (center, radius_m) = track.around();
                let reach_m = radius_m + GROWS_TO_M;
                own.extend(rays.towards(center, reach_m).filter(|ray| usize::from(owners[*ray]) == k));
            }
            if own.len() >= LEAST_POINTS {
                track.see(rays, own, pose, now_s);
            }
            if track.is_seen && track.cross(through::look(rays, &track.shape(), pose, self.range_m)) {
                groups(rays, own, pose.sigma_m, parts);
                if let Some(part) = groups::apart(rays, own, parts, JOIN_M) {
                    track.restart(rays, part, pose, now_s);
                }
            }
            if !track.is_seen {
                let through = own.is_empty()
                    && through::look(rays, &track.shape(), pose, self.range_m) == Look::Through;
                track.miss(through);
            }
        }
    }

    /// Begins a track for each group that belongs to no track; returns whether there was room for all.
    fn begin_tracks(&mut self, pose: &Uncertain, now_s: f64) -> bool {
        let Self { tracks, rays, owners, left, groups: found, .. } = self;
        found.iter().filter(|group| owners[left[group.rays.start]] == NONE).all(|group| {
            let has_room = tracks.len() < MOST || make_room(tracks);
            if has_room {
                tracks.extend(Track::new(rays, &left[group.rays.clone()], pose, now_s));
            }
            has_room
        })
    }

    /// Turns the tracks that are certain enough into obstacles. A track that lies on another obstacle that is tracked is
    /// dropped instead; one that lies on an obstacle of the chart that is not tracked is that obstacle.
    fn give_ids(&mut self, charted: &[Obstacle], reach_m: f64) {
        let mut at = 0;
        while at < self.tracks.len() {
            let track = &self.tracks[at];
            if track.id.is_some() || !track.is_mature(reach_m) {
                at += 1;
                continue;
            }
            let center = track.around().0;
            let is_on = |other: &Track| other.id.is_some() && other.shape().distance_m(center) < 0.0;
            if self.tracks.iter().any(is_on) {
                self.tracks.remove(at);
                continue;
            }
            let is_tracked = |id: ObstacleId| self.tracks.iter().any(|track| track.id == Some(id));
            let is_back = |obstacle: &&Obstacle| {
                obstacle.id.0 >= FIRST_ID
                    && obstacle.shape.distance_m(center) < 0.0
                    && !is_tracked(obstacle.id)
            };
            let back = charted.iter().find(is_back).map(|obstacle| obstacle.id);
            self.free_ids.retain(|id| Some(*id) != back);
            let id = back.or_else(|| self.free_ids.pop()).unwrap_or_else(|| {
                self.next_id += 1;
                ObstacleId(self.next_id - 1)
            });
            self.tracks[at].id = Some(id);
            at += 1;
        }
    }

    /// Counts the scans that pass through each drawn obstacle; returns the obstacles to be reported now.
    fn missing(&mut self, drawing: &Drawing<'_>, pose: &Uncertain) -> Vec<(ObstacleId, u32)> {
        let mut missing = Vec::new();
        for (obstacle, ..) in &drawing.obstacles {
            match through::look(&self.rays, &obstacle.shape, pose, self.range_m) {
                Look::Hidden => {}
                Look::Hit => {
                    self.through.remove(&obstacle.id);
                }
                Look::Through => {
                    let times = self.through.entry(obstacle.id).or_default();
                    *times = times.saturating_add(1);
                    if *times == MISSING_AFTER {
                        missing.push((obstacle.id, *times));
                    }
                }
            }
        }
        missing
    }

    /// Drops the tracks that are over. A moving obstacle that is out of sight could be anywhere; its id is used again.
    fn drop_tracks(&mut self, now_s: f64) {
        let free_ids = &mut self.free_ids;
        self.tracks.retain(|track| {
            let is_over = track.is_over(now_s);
            free_ids.extend(track.id.filter(|_| is_over && track.moves()));
            !is_over
        });
    }
}
