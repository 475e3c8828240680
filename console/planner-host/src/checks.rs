//! Checks that the robot can follow a planner's answers. [`limits`] checks that whatever a worker sends is small enough
//! and valid.

pub(crate) mod limits;

use planner_api::{Command, Drive, Limits, Plan};

/// Rounding tolerance by which a command may exceed a limit.
const SLACK: f64 = 1e-6;

/// Checks a command. The error completes a sentence that begins with the planner's name.
pub(crate) fn command(command: &Command, limits: &Limits) -> Result<(), String> {
    let (v_max, w_max) = (limits.v_max_m_per_s, limits.w_max_rad_per_s);
    match command.drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => {
            within("a speed", v_m_per_s.abs(), v_max, "m/s")?;
            within("a turn rate", w_rad_per_s.abs(), w_max, "rad/s")
        }
        Drive::Velocity(velocity) => within("a speed", velocity.norm(), v_max, "m/s"),
    }
}

fn within(what: &str, value: f64, limit: f64, unit: &str) -> Result<(), String> {
    if value.is_nan() {
        return Err(format!("gave {what} that is not a number"));
    }
    if value > limit + SLACK {
        return Err(format!("gave {what} of {value:?} {unit}; the robot's limit is {limit} {unit}"));
    }
    Ok(())
}

/// Checks a plan. The error completes a sentence that begins with the planner's name.
pub(crate) fn plan(plan: &Plan) -> Result<(), String> {
    plan.check()?;
    if !plan.cost.is_finite() {
        return Err("gave a plan without a finite cost".to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point2, Vector2};
    use planner_api::{Leg, LegTag, Motion};
    use proptest::prelude::*;

    const LIMITS: Limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.3,
        w_max_rad_per_s: 1.0,
        radius_m: 0.2,
        sensing_range_m: 2.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };

    #[test]
    fn a_command_beyond_the_limits_names_value_and_limit() {
        let refused = command(&Command::twist(1e308, 0.0), &LIMITS);
        assert_eq!(refused, Err("gave a speed of 1e308 m/s; the robot's limit is 0.3 m/s".into()));
        assert!(command(&Command::twist(0.0, -1.1), &LIMITS).is_err());
        assert!(command(&Command::velocity(Vector2::new(0.3, 0.3)), &LIMITS).is_err());
        assert!(command(&Command::velocity(Vector2::new(f64::NAN, 0.0)), &LIMITS).is_err());
    }

    #[test]
    fn a_path_of_finite_points_is_needed() {
        let path = vec![Point2::new(0.0, 0.0), Point2::new(f64::INFINITY, 0.0)];
        let refused = plan(&Plan { path, cost: 1.0, complete: true, ..Plan::default() });
        assert_eq!(refused, Err("gave a path whose point 1 is not finite".into()));
        assert!(plan(&Plan { cost: f64::NAN, complete: true, ..Plan::default() }).is_err());
        assert!(plan(&Plan { cuts: vec![vec![Point2::new(0.0, f64::NAN)]], ..Plan::default() }).is_err());
    }

    #[test]
    fn legs_lie_on_the_path_in_order() {
        let checked = |legs: &[(usize, usize)]| {
            let legs = legs.iter().map(|&(first, last)| Leg { tag: LegTag::Swath, first, last }).collect();
            plan(&Plan { path: vec![Point2::origin(); 5], legs, ..Plan::default() })
        };
        assert_eq!(checked(&[(0, 2), (2, 2), (3, 4)]), Ok(()));
        assert_eq!(checked(&[(0, 5)]), Err("gave leg 0 from point 0 to 5 in a path of 5 points".into()));
        assert_eq!(
            checked(&[(0, 3), (2, 4)]),
            Err("gave leg 1, whose first point 2 is inside the previous leg".into())
        );
        assert!(checked(&[(2, 1)]).is_err());
    }

    #[test]
    fn a_path_too_long_to_be_sampled_names_length_and_limit() {
        let path = |x| vec![Point2::origin(), Point2::new(x, 0.0)];
        let checked = |x| plan(&Plan { path: path(x), ..Plan::default() });
        assert_eq!(checked(1e6), Ok(()));
        assert_eq!(checked(1e12), Err("gave a path of 1000000000000 m; the limit is 1000000 m".into()));
        assert!(checked(1e308).is_err());
    }

    proptest! {
        #[test]
        fn commands_within_the_limits_pass(v in -0.3..=0.3_f64, w in -1.0..=1.0_f64) {
            prop_assert_eq!(command(&Command::twist(v, w), &LIMITS), Ok(()));
        }
    }
}
