//! Converts structs of the C ABI to the safe values that a planner sees.

use super::invalid;
use crate::abi::{self, input};
use crate::{
    Boundary, Limits, Motion, Obstacle, Outline, Plan, PlanRequest, PoseEstimate, Reason, Result, Sensed,
    Site, Task, TetherLimits, TetherPull, Value, Zone, ZoneKind,
};
use geometry::{Amphibious, Pace};
use nalgebra::{Matrix3, Point2};

/// Borrows points in place.
unsafe fn points<'a>(ptr: *const abi::Vec2, n: u32) -> &'a [Point2<f64>] {
    // SAFETY: promised by the caller; a point is two doubles, as `abi` asserts.
    unsafe { abi::slice(ptr.cast(), n as usize) }
}

unsafe fn outline<'a>(raw: &abi::Outline) -> Result<Outline<'a>> {
    // SAFETY: promised by the caller.
    let points = unsafe { points(raw.points, raw.n_points) };
    match raw.kind {
        input::OUTLINE_DISC => {
            let center =
                *points.first().ok_or_else(|| invalid("the console sent a disc without a centre"))?;
            Ok(Outline::Disc { center, radius_m: raw.size_m })
        }
        input::OUTLINE_POLYGON => Ok(Outline::Polygon { vertices: points }),
        input::OUTLINE_POLYLINE => Ok(Outline::Polyline { points, half_width_m: raw.size_m }),
        unknown => Err(invalid(&format!("the console sent an outline of unknown kind {unknown}"))),
    }
}

/// The size of an obstacle in the first version of the ABI, in which obstacles had no velocity, bytes.
const FIRST_OBSTACLE: usize = 32;

/// Reads an array whose elements may have grown: fields that an older console's elements lack are read as zero. Refuses
/// elements shorter than `least` bytes.
///
/// # Safety
/// `first` points to `n` elements, `stride` bytes apart, and all-zero bytes are a valid `T`.
unsafe fn strided<T: Copy, U>(
    first: *const T,
    n: u32,
    stride: u32,
    least: usize,
    make: impl Fn(&T) -> Result<U>,
) -> Result<Vec<U>> {
    if n == 0 || first.is_null() {
        return Ok(Vec::new());
    }
    let stride = stride as usize;
    if stride < least {
        return Err(invalid("the console sent an array whose elements are too short"));
    }
    let element = |index: usize| {
        let mut element = std::mem::MaybeUninit::<T>::zeroed();
        // SAFETY: the caller promises `n` elements, `stride` bytes apart, and that all-zero bytes are a valid element.
        unsafe {
            let from = first.cast::<u8>().add(index * stride);
            std::ptr::copy_nonoverlapping(from, element.as_mut_ptr().cast(), stride.min(size_of::<T>()));
            element.assume_init()
        }
    };
    (0..n as usize).map(|index| make(&element(index))).collect()
}

unsafe fn obstacles<'a>(first: *const abi::Obstacle, n: u32, stride: u32) -> Result<Vec<Obstacle<'a>>> {
    let make = |raw: &abi::Obstacle| {
        // SAFETY: promised by the caller.
        let outline = unsafe { outline(&raw.outline)? };
        Ok(Obstacle {
            id: raw.id,
            outline,
            discovered: raw.flags & input::OBSTACLE_DISCOVERED != 0,
            velocity_m_per_s: raw.velocity.into(),
        })
    };
    // SAFETY: promised by the caller; an obstacle consists of numbers and raw pointers.
    unsafe { strided(first, n, stride, FIRST_OBSTACLE, make) }
}

unsafe fn zones<'a>(first: *const abi::Zone, n: u32, stride: u32) -> Result<Vec<Zone<'a>>> {
    let make = |raw: &abi::Zone| {
        let kind = match raw.kind {
            0 => ZoneKind::NoGo,
            1 => ZoneKind::Land,
            2 => ZoneKind::Underwater,
            unknown => {
                return Err(invalid(&format!("the console sent a zone of unknown kind {unknown}")));
            }
        };
        // SAFETY: promised by the caller.
        Ok(Zone { kind, outline: unsafe { outline(&raw.outline)? } })
    };
    // SAFETY: promised by the caller; a zone consists of numbers and raw pointers.
    unsafe { strided(first, n, stride, size_of::<abi::Zone>(), make) }
}

/// A site, and the arrays that its safe form borrows.
pub(super) struct SiteParts<'a> {
    raw: abi::Site,
    boundary: Boundary<'a>,
    obstacles: Vec<Obstacle<'a>>,
    zones: Vec<Zone<'a>>,
}

impl SiteParts<'_> {
    /// Reads a site.
    ///
    /// # Safety
    /// `site` is null or points to a site that does not change while `self` is used.
    pub(super) unsafe fn read(site: *const abi::Site) -> Result<Self> {
        if site.is_null() {
            return Err(invalid("the console sent no site"));
        }
        // SAFETY: promised by the caller.
        unsafe {
            let raw = abi::copy_sized(site);
            let boundary = match outline(&raw.boundary)? {
                Outline::Disc { radius_m, .. } => Boundary::Circle { radius_m },
                Outline::Polygon { vertices } | Outline::Polyline { points: vertices, .. } => {
                    Boundary::Polygon { vertices }
                }
            };
            let obstacles = obstacles(raw.obstacles, raw.n_obstacles, raw.obstacle_stride)?;
            let zones = zones(raw.zones, raw.n_zones, raw.zone_stride)?;
            Ok(Self { raw, boundary, obstacles, zones })
        }
    }

    /// Returns the site as a planner sees it.
    pub(super) fn site(&self) -> Result<Site<'_>> {
        let motion = match self.raw.motion {
            0 => Motion::Point,
            1 => Motion::Unicycle,
            unknown => return Err(invalid(&format!("the console sent the unknown motion type {unknown}"))),
        };
        Ok(Site {
            revision: self.raw.revision,
            boundary: self.boundary,
            obstacles: &self.obstacles,
            zones: &self.zones,
            limits: Limits {
                motion,
                v_max_m_per_s: self.raw.v_max,
                w_max_rad_per_s: self.raw.w_max,
                radius_m: self.raw.radius,
                sensing_range_m: self.raw.sensing_range,
                acceleration_m_per_s2: acceleration(&self.raw),
                tick_s: self.raw.tick,
                amphibious: amphibious(&self.raw),
            },
            swath_m: self.raw.swath,
            clearance_m: self.raw.clearance,
            seed: self.raw.seed,
        })
    }
}

/// The acceleration assumed if the console does not state one, metres per second squared. In older consoles,
/// robots stopped instantly.
const AT_ONCE_M_PER_S2: f64 = 1e3;

fn acceleration(site: &abi::Site) -> f64 {
    if site.acceleration > 0.0 { site.acceleration } else { AT_ONCE_M_PER_S2 }
}

fn amphibious(site: &abi::Site) -> Option<Amphibious> {
    let pace = |v_max_m_per_s, w_max_rad_per_s| Pace { v_max_m_per_s, w_max_rad_per_s };
    (site.is_amphibious != 0).then(|| Amphibious {
        land: pace(site.land_v_max, site.land_w_max),
        underwater: pace(site.underwater_v_max, site.underwater_w_max),
        transition_steps: site.transition_ticks,
    })
}

/// Reads parameter values and checks that their keys are UTF-8.
///
/// # Safety
/// `first` points to `n` values that do not change while the result is used.
pub(super) unsafe fn config_values<'a>(first: *const abi::Value, n: u32) -> Result<Vec<Value<'a>>> {
    // SAFETY: promised by the caller.
    let raw: &[abi::Value] = unsafe { abi::slice(first, n as usize) };
    raw.iter()
        .map(|value| {
            // SAFETY: promised by the caller.
            let key = unsafe { text(value.key) }.ok_or_else(|| invalid("a parameter key is not UTF-8"))?;
            Ok(Value { key, number: value.number })
        })
        .collect()
}

unsafe fn text<'a>(raw: abi::Str) -> Option<&'a str> {
    // SAFETY: promised by the caller.
    std::str::from_utf8(unsafe { abi::slice(raw.ptr, raw.len) }).ok()
}

fn estimate(pose: abi::Pose, covariance: &[f64; 6]) -> PoseEstimate {
    let [xx, xy, xh, yy, yh, hh] = *covariance;
    PoseEstimate {
        position: Point2::new(pose.x, pose.y),
        heading_rad: pose.heading,
        covariance: Matrix3::new(xx, xy, xh, xy, yy, yh, xh, yh, hh),
    }
}

/// Reads the reason why a plan is requested; a reason that only newer consoles know is treated as a request by the
/// operator.
///
/// # Safety
/// `raw.from` points to a text.
pub(super) unsafe fn reason_of(raw: &abi::PlanIn) -> Reason {
    match raw.reason {
        input::REASON_START => Reason::Start,
        input::REASON_BLOCKED => Reason::Blocked,
        input::REASON_MAP_CHANGED => Reason::MapChanged,
        // SAFETY: promised by the caller.
        input::REASON_SWAP => Reason::Swap { from: unsafe { text(raw.from) }.unwrap_or_default().to_owned() },
        input::REASON_RECOVER => Reason::Recover,
        _ => Reason::Operator,
    }
}

/// Reads the regions that are still to be covered according to a request.
///
/// # Safety
/// `raw.regions` points to outlines that do not change while the result is used.
pub(super) unsafe fn regions_of<'a>(raw: &abi::PlanIn) -> Result<Vec<&'a [Point2<f64>]>> {
    // SAFETY: promised by the caller.
    let outlines: &[abi::Outline] = unsafe { abi::slice(raw.regions, raw.n_regions as usize) };
    outlines
        .iter()
        // SAFETY: as above.
        .map(|raw| match unsafe { outline(raw)? } {
            Outline::Polygon { vertices } => Ok(vertices),
            Outline::Disc { .. } | Outline::Polyline { .. } => {
                Err(invalid("the console sent a region that is not a polygon"))
            }
        })
        .collect()
}

/// Reads the task of a request; `regions` are those of the same request.
///
/// # Safety
/// `raw.targets` points to points that do not change while the result is used.
pub(super) unsafe fn task_of<'a>(raw: &abi::PlanIn, regions: &'a [&'a [Point2<f64>]]) -> Result<Task<'a>> {
    // SAFETY: promised by the caller.
    let targets = unsafe { points(raw.targets, raw.n_targets) };
    match raw.task {
        input::TASK_GOTO => {
            let goal = *targets.first().ok_or_else(|| invalid("the console sent no goal"))?;
            Ok(Task::Goto { goal, tolerance_m: raw.tolerance })
        }
        input::TASK_FOLLOW => Ok(Task::Follow { targets, tolerance_m: raw.tolerance }),
        input::TASK_COVER => {
            let anchor = *targets.first().ok_or_else(|| invalid("the console sent no anchor"))?;
            let tether = (raw.has_tether != 0).then_some(TetherLimits {
                reel_length_m: raw.reel,
                wrap_max_rad: raw.max_wrap,
                wrap_total_max_rad: raw.max_sum_wrap,
                pull: (raw.reel_pull > 0.0).then_some(TetherPull {
                    floor_n_per_m: raw.pull_per_m,
                    friction: raw.pull_friction,
                    reel_n: raw.reel_pull,
                    preferred_n: raw.preferred_pull,
                }),
            });
            Ok(Task::Cover { anchor, regions, tether, tolerance_m: raw.tolerance })
        }
        unknown => Err(invalid(&format!("the console sent the unknown task {unknown}"))),
    }
}

/// Reads the plan to keep to as far as possible, if there is one.
///
/// # Safety
/// The path, legs and cuts of `raw` point to as many elements as `raw` states.
pub(super) unsafe fn under_way_of(raw: &abi::PlanIn) -> Result<Option<Plan>> {
    // SAFETY: promised by the caller, as everywhere below.
    let path = unsafe { points(raw.way, raw.n_way) }.to_vec();
    if path.is_empty() {
        return Ok(None);
    }
    // SAFETY: as above.
    let legs: &[abi::Leg] = unsafe { abi::slice(raw.way_legs, raw.n_way_legs as usize) };
    let legs: Vec<_> = legs.iter().filter_map(|leg| leg.get().ok()).collect();
    // SAFETY: as above.
    let cuts: &[abi::Outline] = unsafe { abi::slice(raw.way_cuts, raw.n_way_cuts as usize) };
    // SAFETY: as above.
    let cut = |raw: &abi::Outline| unsafe { points(raw.points, raw.n_points) }.to_vec();
    let plan = Plan {
        path,
        legs,
        cuts: cuts.iter().map(cut).collect(),
        complete: raw.way_complete != 0,
        ..Plan::default()
    };
    plan.check().map_err(|what| invalid(&format!("the console {what}")))?;
    Ok(Some(plan))
}

/// Assembles a request from its parts.
///
/// # Safety
/// `raw.previous` points to points that do not change while the result is used.
pub(super) unsafe fn plan_request<'a>(
    raw: &abi::PlanIn,
    reason: &'a Reason,
    task: Task<'a>,
    site: &'a Site<'a>,
    under_way: Option<&'a Plan>,
) -> PlanRequest<'a> {
    PlanRequest {
        reason,
        start: estimate(raw.start, &raw.covariance),
        task,
        site,
        // SAFETY: promised by the caller.
        previous: unsafe { points(raw.previous, raw.n_previous) },
        under_way,
    }
}

/// A planner's view of one tick, and the array that its safe form borrows.
pub(super) struct SensedParts<'a> {
    raw: abi::StepIn,
    targets_ahead: &'a [Point2<f64>],
    path_ahead: &'a [Point2<f64>],
    obstacles: Vec<Obstacle<'a>>,
}

impl SensedParts<'_> {
    /// Reads a planner's view of one tick.
    ///
    /// # Safety
    /// `input` points to a struct that does not change while `self` is used.
    pub(super) unsafe fn read(input: *const abi::StepIn) -> Result<Self> {
        // SAFETY: promised by the caller.
        unsafe {
            let raw = abi::copy_sized(input);
            Ok(Self {
                targets_ahead: points(raw.targets_ahead, raw.n_targets_ahead),
                path_ahead: points(raw.path_ahead, raw.n_path_ahead),
                obstacles: obstacles(raw.obstacles, raw.n_obstacles, raw.obstacle_stride)?,
                raw,
            })
        }
    }

    /// Returns the view of the tick in its safe form.
    pub(super) fn sensed(&self) -> Sensed<'_> {
        Sensed {
            tick: self.raw.tick,
            t_s: self.raw.t,
            dt_s: self.raw.dt,
            pose: estimate(self.raw.pose, &self.raw.covariance),
            v_m_per_s: self.raw.v,
            w_rad_per_s: self.raw.w,
            target: self.raw.target.into(),
            targets_ahead: self.targets_ahead,
            path_ahead: self.path_ahead,
            obstacles: &self.obstacles,
        }
    }
}
