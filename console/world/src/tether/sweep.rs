//! Finds the first event on the free span of a cable while the end of the cable moves in a straight line.

use super::cable_obstacles::{CableObstacles, Post, tangent_point};
use geometry::{Point, Vector, unit_vector, wrap_angle_rad};

/// Lateral slack of a contact, metres: a contact ends once the robot is this far on the free side of the contact, and
/// begins half this distance early. Rounding therefore never lets a cable slip through a corner that it has just
/// touched.
pub(super) const SLACK_M: f64 = 1e-8;

/// The point at which the free span begins: the anchor, or the last post.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base {
    pub center: Point,
    pub radius_m: f64,
    /// 1 if the cable turns counter-clockwise around the base, -1 if clockwise, 0 for the anchor.
    pub side: f64,
    pub out_rad: f64,
    /// The wrap around the base, radians; infinite for the anchor, which never releases the cable.
    pub wrap_rad: f64,
    pub post: Option<usize>,
}

/// The next event in a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Event {
    /// No event: the end of the move is reached.
    Arrive,
    /// The last bend is unwound.
    Release,
    /// The free span becomes tangent to a post.
    Touch { post: usize, side: f64, bearing_rad: f64, at: Point },
}

impl Base {
    /// Returns the point at which the free span begins if it has a given bearing.
    pub(super) fn leaves_at(&self, bearing_rad: f64) -> Point {
        tangent_point(self.center, self.radius_m, self.side, bearing_rad)
    }

    /// Returns the bearing of the free span when it ends at a given point; `None` if the point is the base itself.
    pub(super) fn bearing_to(&self, point: Point) -> Option<f64> {
        let way = point - self.center;
        let far = way.norm();
        (far > 1e-12).then(|| way.y.atan2(way.x) + (self.side * self.radius_m / far).clamp(-1.0, 1.0).asin())
    }

    /// Returns the angle by which the free span turns as its end moves from `from` to `to`, radians.
    pub(super) fn turn_to(&self, from: Point, to: Point) -> f64 {
        let Some(bearing_rad) = self.bearing_to(to) else { return self.turn_to_end_here() };
        let turn = wrap_angle_rad(bearing_rad - self.out_rad);
        // A move close to the base can turn the free span by nearly half a turn, in the direction of the motion.
        if turn.abs() > 3.0 && turn * self.sense_of(from, to) < 0.0 {
            turn - std::f64::consts::TAU.copysign(turn)
        } else {
            turn
        }
    }

    /// Returns the angle of the turn after which the cable ends at the base, because the whole bend there has unwound.
    fn turn_to_end_here(&self) -> f64 {
        if self.post.is_some() { -self.side * self.wrap_rad } else { 0.0 }
    }

    /// Positive if a move passes the base counter-clockwise, negative if clockwise.
    ///
    /// A move that passes through the base, to within rounding errors, runs back along the cable and unwinds it.
    fn sense_of(&self, from: Point, to: Point) -> f64 {
        let along = (to - from).normalize();
        // A tip exactly on a corner is on neither side of the corner, but the cable's bearing still defines a side.
        let passed = if self.radius_m > 0.0 {
            (from - self.center).perp(&along)
        } else {
            unit_vector(self.out_rad).perp(&along)
        };
        if passed.abs() <= SLACK_M && self.side != 0.0 { -self.side } else { passed }
    }
}

/// Returns the first event of a move that still has to turn the free span by `turn_rad`.
///
/// `released` lists the posts that this move has already unwound; a straight move cannot meet them again.
pub(super) fn next_event(
    obstacles: &CableObstacles,
    base: &Base,
    from: Point,
    to: Point,
    turn_rad: f64,
    released: &[usize],
) -> Event {
    let sense = if turn_rad < 0.0 { -1.0 } else { 1.0 };
    let end = base.leaves_at(base.out_rad + turn_rad);
    let left_over_rad = base.wrap_rad - turn_rad.abs();
    let releases = sense * base.side < 0.0 && left_over_rad * (to - end).norm() < -SLACK_M;
    let sweep = Sweep::new(base, from, to, turn_rad, sense);
    let touched = sweep.first_touched(obstacles, |k| base.post == Some(k) || released.contains(&k));
    match touched {
        Some(touch) if !releases || touch.after_rad < base.wrap_rad => Event::Touch {
            post: touch.post,
            side: sense,
            bearing_rad: base.out_rad + sense * touch.after_rad,
            at: touch.at,
        },
        _ if releases => Event::Release,
        _ => Event::Arrive,
    }
}

/// The area that the free span sweeps in one turn about its base.
struct Sweep<'a> {
    base: &'a Base,
    sense: f64,
    turn_rad: f64,
    from: Point,
    to: Point,
    /// Unit vector of the move.
    along: Vector,
    /// First and last position of the free span: its starting point and its direction.
    start: (Point, Vector),
    end: (Point, Vector),
    /// Length of the free span at the start and at the end, metres.
    start_m: f64,
    end_m: f64,
}

struct Touch {
    post: usize,
    after_rad: f64,
    far_m: f64,
    at: Point,
}

impl<'a> Sweep<'a> {
    fn new(base: &'a Base, from: Point, to: Point, turn_rad: f64, sense: f64) -> Self {
        let out_rad = base.out_rad + turn_rad;
        let start = (base.leaves_at(base.out_rad), unit_vector(base.out_rad));
        let end = (base.leaves_at(out_rad), unit_vector(out_rad));
        Self {
            base,
            sense,
            turn_rad,
            from,
            to,
            along: (to - from).normalize(),
            start_m: (from - start.0).norm(),
            end_m: (to - end.0).norm(),
            start,
            end,
        }
    }

    fn first_touched(
        &self,
        obstacles: &CableObstacles,
        is_excluded: impl Fn(usize) -> bool,
    ) -> Option<Touch> {
        // The ends of the free span move by some distance; no swept point is farther than that from the first
        // position of the span.
        let room_m = (self.to - self.from).norm() + 2.0 * self.base.radius_m + 2.0 * SLACK_M;
        let near = obstacles.near(self.start.0, self.from, room_m);
        let may_touch = near.filter(|k| self.may_touch(&obstacles.posts[*k]) && !is_excluded(*k));
        let mut touches: Vec<Touch> = may_touch.filter_map(|k| self.touch(k, &obstacles.posts[k])).collect();
        touches.sort_unstable_by_key(|touch| touch.post);
        touches.into_iter().reduce(|best, touch| {
            let same =
                (touch.after_rad - best.after_rad).abs() <= self.early_rad(touch.far_m.max(best.far_m));
            let is_first = if same { touch.far_m < best.far_m } else { touch.after_rad < best.after_rad };
            if is_first { touch } else { best }
        })
    }

    /// Returns how far before the start a tangent may lie and still count, radians, for a post at this distance from
    /// the base.
    fn early_rad(&self, far_m: f64) -> f64 {
        0.25 * SLACK_M / self.start_m.max(far_m).max(SLACK_M)
    }

    /// Returns how far beyond the end a tangent may lie and still count, radians.
    fn late_rad(&self, far_m: f64) -> f64 {
        0.5 * SLACK_M / self.end_m.max(far_m).max(SLACK_M)
    }

    /// Whether the free span passes through a round post at the start, with the post's centre on the side to which
    /// the span turns.
    ///
    /// This happens after a move along a chord of the post that led past the tangent point, where an arc would have
    /// turned the span back and forth.
    fn starts_through(&self, post: &Post, far_m: f64) -> bool {
        let aside_m = |point: Point| self.sense * self.start.1.perp(&(point - self.start.0));
        // Later in a move, the free span no longer ends where the move began.
        let is_first = aside_m(self.from).abs() <= SLACK_M;
        let is_ahead = far_m < self.start_m && self.start.1.dot(&(post.center - self.start.0)) > 0.0;
        let middle_m = aside_m(post.center);
        is_first && is_ahead && middle_m > 0.0 && middle_m < post.radius_m - SLACK_M
    }

    /// Whether the post reaches into the cone of the sweep, on the near side of the move; a quick test.
    fn may_touch(&self, post: &Post) -> bool {
        let room_m = post.radius_m + SLACK_M;
        // The free span leaves a round base from a different point at every bearing.
        let wide_m = room_m + 2.0 * self.base.radius_m;
        let side_of = |o: Point, d: Vector| self.sense * d.perp(&(post.center - o));
        side_of(self.from, self.along) >= -room_m
            && side_of(self.start.0, self.start.1) >= -wide_m
            && side_of(self.end.0, self.end.1) <= wide_m
    }

    /// Returns the common tangent of base and post, if the free span passes it on this move.
    fn touch(&self, k: usize, post: &Post) -> Option<Touch> {
        let way = post.center - self.base.center;
        let far = way.norm();
        let offset = self.sense * post.radius_m - self.base.side * self.base.radius_m;
        if far <= 1e-12 || offset.abs() > far + SLACK_M {
            return None;
        }
        let bearing_rad = way.y.atan2(way.x) - (offset / far).clamp(-1.0, 1.0).asin();
        let after_rad = self.sense * wrap_angle_rad(bearing_rad - self.base.out_rad);
        let far_m = (far * far - offset * offset).max(0.0).sqrt();
        let is_early = after_rad < -self.early_rad(far_m) && !self.starts_through(post, far_m);
        if is_early || after_rad > self.turn_rad.abs() + self.late_rad(far_m) {
            return None;
        }
        let at = tangent_point(post.center, post.radius_m, self.sense, bearing_rad);
        let (leaves, free) = (self.base.leaves_at(bearing_rad), unit_vector(bearing_rad));
        let across = free.perp(&self.along);
        let reaches = |end: Point| far_m <= (end - leaves).norm() + SLACK_M;
        // Beyond the line of the move, the end passes in front of the post.
        let is_near = if across.abs() > 1e-9 {
            self.sense * self.along.perp(&(at - self.from)) >= 0.0 && (reaches(self.from) || reaches(self.to))
        } else {
            // The move leads along the free span itself: away from the base, or towards and past it.
            reaches(if free.dot(&self.along) > 0.0 { self.to } else { self.from })
        };
        (is_near && post.lies_on(self.sense, free)).then_some(Touch { post: k, after_rad, far_m, at })
    }
}
