//! Site, request and what is sensed: written from the borrowed forms, read into the owned ones of the mission's port.

use super::body::{Body, Malformed, Read, Writer};
use mission::ask::{self, PlanAsk, SiteObstacle, SiteZone, StepAsk, TaskLeft};
use planner_api::{
    Boundary, Limits, Motion, Obstacle, Outline, PlanRequest, Reason, Sensed, Site, Task, TetherLimits, Zone,
    ZoneKind,
};
use std::sync::Arc;
use world::{Amphibious, Pace, Shape};

impl Writer {
    fn outline(&mut self, outline: &Outline<'_>) -> &mut Self {
        match outline {
            Outline::Disc { center, radius_m } => self.u8(0).point(center).f64(*radius_m),
            Outline::Polygon { vertices } => self.u8(1).points(vertices),
            Outline::Polyline { points, half_width_m } => self.u8(2).points(points).f64(*half_width_m),
        }
    }

    fn obstacle(&mut self, obstacle: &Obstacle<'_>) {
        self.u32(obstacle.id)
            .flag(obstacle.discovered)
            .outline(&obstacle.outline)
            .vector(&obstacle.velocity_m_per_s);
    }

    fn zone(&mut self, zone: &Zone<'_>) {
        self.u8(zone.kind as u8).outline(&zone.outline);
    }

    fn limits(&mut self, limits: &Limits) -> &mut Self {
        self.u8(limits.motion as u8)
            .f64(limits.v_max_m_per_s)
            .f64(limits.w_max_rad_per_s)
            .f64(limits.radius_m)
            .f64(limits.sensing_range_m)
            .f64(limits.acceleration_m_per_s2)
            .f64(limits.tick_s)
            .amphibious(limits.amphibious.as_ref())
    }

    fn amphibious(&mut self, both: Option<&Amphibious>) -> &mut Self {
        self.flag(both.is_some());
        if let Some(Amphibious { land, underwater, transition_steps }) = both {
            for pace in [land, underwater] {
                self.f64(pace.v_max_m_per_s).f64(pace.w_max_rad_per_s);
            }
            self.u32(*transition_steps);
        }
        self
    }

    pub(crate) fn site(&mut self, site: &Site<'_>) -> &mut Self {
        self.u32(site.revision).u64(site.seed);
        match site.boundary {
            Boundary::Circle { radius_m } => self.u8(0).f64(radius_m),
            Boundary::Polygon { vertices } => self.u8(1).points(vertices),
        };
        self.all(site.obstacles, Self::obstacle).all(site.zones, Self::zone);
        self.limits(&site.limits).f64(site.swath_m).f64(site.clearance_m)
    }

    fn reason(&mut self, reason: &Reason) -> &mut Self {
        match reason {
            Reason::Start => self.u8(0),
            Reason::Blocked => self.u8(1),
            Reason::MapChanged => self.u8(2),
            Reason::Operator => self.u8(3),
            Reason::Swap { from } => self.u8(4).text(from),
            Reason::Recover => self.u8(5),
        }
    }

    pub(crate) fn request(&mut self, request: &PlanRequest<'_>) -> &mut Self {
        self.reason(request.reason).pose(&request.start);
        match &request.task {
            Task::Goto { goal, tolerance_m } => self.u8(0).point(goal).f64(*tolerance_m),
            Task::Follow { targets, tolerance_m } => self.u8(1).points(targets).f64(*tolerance_m),
            Task::Cover { anchor, regions, tether, tolerance_m } => {
                self.u8(2).point(anchor).f64(*tolerance_m).tether(tether.as_ref());
                self.all(regions, |w, region| {
                    w.points(region);
                })
            }
        };
        self.site(request.site).points(request.previous).flag(request.under_way.is_some());
        if let Some(plan) = request.under_way {
            self.plan(plan);
        }
        self
    }

    fn tether(&mut self, limits: Option<&TetherLimits>) -> &mut Self {
        self.flag(limits.is_some());
        if let Some(limits) = limits {
            self.f64(limits.reel_length_m).f64(limits.wrap_max_rad).f64(limits.wrap_total_max_rad);
        }
        self
    }

    pub(crate) fn sensed(&mut self, sensed: &Sensed<'_>) -> &mut Self {
        self.u64(sensed.tick)
            .f64(sensed.t_s)
            .f64(sensed.dt_s)
            .pose(&sensed.pose)
            .f64(sensed.v_m_per_s)
            .f64(sensed.w_rad_per_s)
            .point(&sensed.target)
            .points(sensed.targets_ahead)
            .points(sensed.path_ahead)
            .all(sensed.obstacles, Self::obstacle)
    }

    pub(crate) fn values(&mut self, values: &[(String, f64)]) -> &mut Self {
        self.all(values, |w, (key, number)| {
            w.text(key).f64(*number);
        })
    }
}

impl Body<'_> {
    fn outline(&mut self) -> Read<Shape> {
        match self.u8()? {
            0 => Ok(Shape::Disc { center: self.point()?, radius_m: self.f64()? }),
            1 => Ok(Shape::Polygon { vertices: self.points()? }),
            2 => Ok(Shape::Polyline { points: self.points()?, half_width_m: self.f64()? }),
            _ => Err(Malformed),
        }
    }

    fn obstacle(&mut self) -> Read<SiteObstacle> {
        Ok(SiteObstacle {
            id: self.u32()?,
            discovered: self.flag()?,
            shape: self.outline()?,
            velocity_m_per_s: self.point()?.coords,
        })
    }

    fn zone(&mut self) -> Read<SiteZone> {
        let kind = match self.u8()? {
            0 => ZoneKind::NoGo,
            1 => ZoneKind::Land,
            2 => ZoneKind::Underwater,
            _ => return Err(Malformed),
        };
        Ok(SiteZone { kind, shape: self.outline()? })
    }

    fn pace(&mut self) -> Read<Pace> {
        Ok(Pace { v_max_m_per_s: self.f64()?, w_max_rad_per_s: self.f64()? })
    }

    fn amphibious(&mut self) -> Read<Option<Amphibious>> {
        if !self.flag()? {
            return Ok(None);
        }
        let (land, underwater) = (self.pace()?, self.pace()?);
        Ok(Some(Amphibious { land, underwater, transition_steps: self.u32()? }))
    }

    fn limits(&mut self) -> Read<Limits> {
        let motion = match self.u8()? {
            0 => Motion::Point,
            1 => Motion::Unicycle,
            _ => return Err(Malformed),
        };
        Ok(Limits {
            motion,
            v_max_m_per_s: self.f64()?,
            w_max_rad_per_s: self.f64()?,
            radius_m: self.f64()?,
            sensing_range_m: self.f64()?,
            acceleration_m_per_s2: self.f64()?,
            tick_s: self.f64()?,
            amphibious: self.amphibious()?,
        })
    }

    pub(crate) fn site(&mut self) -> Read<ask::Site> {
        let (revision, seed) = (self.u32()?, self.u64()?);
        let boundary = match self.u8()? {
            0 => world::Boundary::Circle { radius_m: self.f64()? },
            1 => world::Boundary::Polygon { vertices: self.points()? },
            _ => return Err(Malformed),
        };
        Ok(ask::Site {
            revision,
            seed,
            boundary,
            obstacles: self.all(Self::obstacle)?,
            zones: self.all(Self::zone)?,
            limits: self.limits()?,
            swath_m: self.f64()?,
            clearance_m: self.f64()?,
        })
    }

    fn reason(&mut self) -> Read<Reason> {
        match self.u8()? {
            0 => Ok(Reason::Start),
            1 => Ok(Reason::Blocked),
            2 => Ok(Reason::MapChanged),
            3 => Ok(Reason::Operator),
            4 => Ok(Reason::Swap { from: self.text()? }),
            5 => Ok(Reason::Recover),
            _ => Err(Malformed),
        }
    }

    fn tether(&mut self) -> Read<Option<TetherLimits>> {
        if !self.flag()? {
            return Ok(None);
        }
        let (reel_length_m, wrap_max_rad, wrap_total_max_rad) = (self.f64()?, self.f64()?, self.f64()?);
        Ok(Some(TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad }))
    }

    pub(crate) fn request(&mut self) -> Read<PlanAsk> {
        let (reason, start) = (self.reason()?, self.pose()?);
        let task = match self.u8()? {
            0 => TaskLeft::Goto { goal: self.point()?, tolerance_m: self.f64()? },
            1 => TaskLeft::Follow { targets: self.points()?, tolerance_m: self.f64()? },
            2 => TaskLeft::Cover {
                anchor: self.point()?,
                tolerance_m: self.f64()?,
                tether: self.tether()?,
                regions: self.all(Self::points)?,
            },
            _ => return Err(Malformed),
        };
        let (site, previous) = (Arc::new(self.site()?), self.points()?);
        let under_way = if self.flag()? { Some(self.plan()?) } else { None };
        Ok(PlanAsk { reason, start, task, site, previous, under_way })
    }

    pub(crate) fn sensed(&mut self) -> Read<StepAsk> {
        Ok(StepAsk {
            tick: self.u64()?,
            t_s: self.f64()?,
            dt_s: self.f64()?,
            pose: self.pose()?,
            v_m_per_s: self.f64()?,
            w_rad_per_s: self.f64()?,
            target: self.point()?,
            targets_ahead: self.points()?,
            path_ahead: self.points()?,
            obstacles: self.all(Self::obstacle)?,
        })
    }

    pub(crate) fn values(&mut self) -> Read<Vec<(String, f64)>> {
        self.all(|body| Ok((body.text()?, body.f64()?)))
    }
}

#[cfg(test)]
mod tests;
