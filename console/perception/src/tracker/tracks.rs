//! Updates, begins and ends tracks, and turns the certain ones into obstacles.

use super::{
    FIRST_ID, NONE, Perception,
    points::{GROWS_TO_M, JOIN_M},
};
use crate::{
    groups::{self, groups},
    through::{self, Look},
    track::Track,
    uncertain::Uncertain,
};
use world::{Obstacle, ObstacleId};

/// Maximum number of tracks.
pub(super) const MOST: usize = 512;
/// Minimum number of points for updating a track.
const LEAST_POINTS: usize = 2;

/// Drops the track of the obstacle on the chart that has been out of sight for the longest time; returns whether one was
/// dropped.
fn make_room(tracks: &mut Vec<Track>) -> bool {
    let charted = tracks.iter().enumerate().filter_map(|(k, track)| Some((k, track.charted_s()?)));
    let oldest = charted.min_by(|a, b| a.1.total_cmp(&b.1));
    oldest.map(|(k, _)| tracks.remove(k)).is_some()
}

impl Perception {
    /// Updates each track with its points.
    pub(super) fn update(&mut self, pose: &Uncertain, now_s: f64) {
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
    pub(super) fn begin_tracks(&mut self, pose: &Uncertain, now_s: f64) -> bool {
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
    pub(super) fn give_ids(&mut self, charted: &[Obstacle], reach_m: f64) {
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

    /// Drops the tracks that are over. A moving obstacle that is out of sight could be anywhere; its id is used again.
    pub(super) fn drop_tracks(&mut self, now_s: f64) {
        let free_ids = &mut self.free_ids;
        self.tracks.retain(|track| {
            let is_over = track.is_over(now_s);
            free_ids.extend(track.id.filter(|_| is_over && track.moves()));
            !is_over
        });
    }
}
