//! Assigns the points of a scan to tracks.

use super::{NONE, Perception};
use crate::{
    groups::{self, groups},
    track::Track,
    uncertain::Uncertain,
};

/// Maximum distance from a track, metres, at which a group belongs to the track.
pub(super) const JOIN_M: f64 = 0.12;
/// Maximum extent, metres, of a track that can still take further groups.
pub(super) const GROWS_TO_M: f64 = 1.0;

impl Perception {
    /// Assigns each point that the drawing does not explain to the track with the nearest outline.
    pub(super) fn share_out(&mut self, pose: &Uncertain) {
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
    pub(super) fn join_groups(&mut self, pose: &Uncertain) {
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
}
