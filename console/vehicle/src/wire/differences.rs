//! The differences between two introductions.

use super::message::Hello;

impl Hello {
    /// The fields of a later introduction that describe a different vehicle, each as a clause with both values. `session`
    /// is not part of the description.
    pub fn differences(&self, later: &Self) -> Vec<String> {
        let mut found = Vec::new();
        let mut differ = |field: &str, before: &dyn std::fmt::Debug, now: &dyn std::fmt::Debug| {
            let (before, now) = (format!("{before:?}"), format!("{now:?}"));
            if before != now {
                found.push(format!("`{field}` is {now} instead of {before}"));
            }
        };
        differ("name", &self.name, &later.name);
        differ("motion", &self.motion.word(), &later.motion.word());
        let (before, now) = (&self.limits, &later.limits);
        differ("limits.speed_m_per_s", &before.speed_m_per_s, &now.speed_m_per_s);
        differ("limits.turn_rad_per_s", &before.turn_rad_per_s, &now.turn_rad_per_s);
        differ("limits.acceleration_m_per_s2", &before.acceleration_m_per_s2, &now.acceleration_m_per_s2);
        differ("limits.radius_m", &before.radius_m, &now.radius_m);
        differ("has", &self.has.parts(), &later.has.parts());
        differ("period_s", &self.period_s, &later.period_s);
        differ("stop_time_s", &self.stop_time_s, &later.stop_time_s);
        differ("lease_max_s", &self.lease_max_s, &later.lease_max_s);
        found
    }
}
