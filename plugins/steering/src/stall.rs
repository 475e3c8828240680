//! Checks whether the robot makes progress.

use geometry::Point;

/// Radius of the circle that a robot must leave to count as moving, metres.
const MOVING_M: f64 = 0.5;
/// Distance by which a robot must come closer to its target to make progress, metres.
const GAIN_M: f64 = 0.1;
/// Shift above which a target counts as a new target, metres.
const OTHER_TARGET_M: f64 = 0.2;
/// Factor by which moving without coming closer is tolerated for longer than standing still.
const PATIENCE: f64 = 3.0;
/// Interval between ticks above which the robot must have been held, seconds; a held robot could not make progress.
const HELD_S: f64 = 1.0;

/// Remembers when the robot last moved and when it last came closer to its target.
#[derive(Debug, Clone, Default)]
pub struct Stall {
    memory: Option<Memory>,
}

#[derive(Debug, Clone, Copy)]
struct Memory {
    anchor: Point,
    moved_s: f64,
    target: Point,
    best_m: f64,
    gained_s: f64,
    seen_s: f64,
}

impl Stall {
    /// Processes a tick. Returns the time without progress, seconds.
    pub fn update(&mut self, t_s: f64, at: Point, target: Point) -> f64 {
        let missing_m = (target - at).norm();
        let fresh =
            Memory { anchor: at, moved_s: t_s, target, best_m: missing_m, gained_s: t_s, seen_s: t_s };
        let memory = self.memory.get_or_insert(fresh);
        if t_s - memory.seen_s > HELD_S {
            *memory = fresh;
        }
        memory.seen_s = t_s;
        if (target - memory.target).norm() > OTHER_TARGET_M {
            (memory.target, memory.best_m, memory.gained_s) = (target, missing_m, t_s);
        }
        if (at - memory.anchor).norm() > MOVING_M {
            (memory.anchor, memory.moved_s) = (at, t_s);
        }
        if missing_m < memory.best_m - GAIN_M {
            (memory.best_m, memory.gained_s) = (missing_m, t_s);
        }
        (t_s - memory.moved_s).max((t_s - memory.gained_s) / PATIENCE)
    }
}

/// The remedies tried in turn while the robot makes no progress: first the other side, then straight on without a
/// detour. The second remedy is needed because the path to a preset point in a niche is blocked from every side.
#[derive(Debug, Clone, Default)]
pub struct Remedy {
    tried: u32,
    due_s: f64,
}

impl Remedy {
    /// Processes the time without progress. Returns true when the robot should change sides now.
    pub fn update(&mut self, idle_s: f64, pause_s: f64) -> bool {
        if idle_s < self.due_s - pause_s || idle_s < pause_s {
            *self = Self { tried: 0, due_s: pause_s };
        }
        let is_due = idle_s >= self.due_s && idle_s > 0.0;
        if is_due {
            self.tried += 1;
            self.due_s = idle_s + pause_s;
        }
        is_due && !self.pushes()
    }

    /// Whether the robot should go straight on now.
    pub fn pushes(&self) -> bool {
        self.tried > 0 && self.tried.is_multiple_of(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn idle_after(path: impl Fn(f64) -> Point) -> f64 {
        let mut stall = Stall::default();
        (0..=300)
            .map(|k| stall.update(f64::from(k) * 0.1, path(f64::from(k) * 0.1), Point::new(50.0, 0.0)))
            .fold(0.0, f64::max)
    }

    #[test]
    fn time_spent_held_does_not_count() {
        let mut stall = Stall::default();
        let goal = Point::new(50.0, 0.0);
        assert!(stall.update(0.0, Point::origin(), goal).abs() < 1e-9);
        assert!(stall.update(500.0, Point::origin(), goal).abs() < 1e-9);
        assert!((stall.update(500.1, Point::origin(), goal) - 0.1).abs() < 1e-9);
    }

    #[test]
    fn standing_still_counts_at_once_and_circling_a_third() {
        assert!((idle_after(|_| Point::origin()) - 30.0).abs() < 1e-9);
        let circling = idle_after(|t| Point::new(2.0 * t.cos(), 2.0 * t.sin()));
        assert!((circling - 10.0).abs() < 1.0);
    }

    #[test]
    fn a_robot_on_its_way_is_never_idle_for_long() {
        assert!(idle_after(|t| Point::new(0.3 * t, 0.0)) < 2.0);
    }
}
