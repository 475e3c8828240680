//! The settings of a scenario that an operator compares before choosing one: robot, tether and limits.

use crate::view::fields::Field;
use crate::view::text;
use mission::{MissionConfig, TaskConfig};

/// The settings, most important first.
pub(super) fn fields(mission: &MissionConfig) -> Vec<Field> {
    let metres = |m: f64| format!("{} m", text::number(m, 2));
    let limits = &mission.limits;
    let robot = format!(
        "hull radius {}, at most {} m/s, sees {}",
        metres(limits.radius_m),
        text::number(limits.v_max_m_per_s, 2),
        metres(limits.sensing_range_m),
    );
    let tether = mission.tether.as_ref().map_or_else(
        || "none".to_owned(),
        |tether| {
            let wrap = text::number(tether.limits.wrap_max_rad.to_degrees(), 0);
            format!(
                "{} on the reel, wrap at most {wrap}° on one obstacle",
                metres(tether.limits.reel_length_m)
            )
        },
    );
    let mut fields = vec![("robot", robot), ("tether", tether)];
    if matches!(mission.task, TaskConfig::Cover { .. }) {
        let swath = metres(mission.swath_m);
        fields.push(("scan", format!("swath {swath}, in cells of {}", metres(mission.cell_m))));
    }
    fields.extend([
        ("clearance", format!("at least {}", metres(mission.clearance_m))),
        ("position", format!("lost above ±{}", metres(mission.position_limit_m))),
        ("time", format!("limit {}", text::clock(mission.time_limit_s))),
    ]);
    fields
}
