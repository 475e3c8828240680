//! Answers: what a library holds, what a planner said, a plan, how far it is, a command, a refusal.

use super::body::{Body, Malformed, Read, Writer};
use crate::Progress;
pub(crate) use mission::Said;
use mission::{ParamInfo, ParamKind, Sandbox};
use nalgebra::Point2;
use planner_api::{Command, Drawing, Leg, LegTag, LogLevel, Plan, abi};

/// A planner's refusal as it crosses: the number of its code, its sentence, the part of the way that it found.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Refusal {
    pub(crate) code: i32,
    pub(crate) message: String,
    pub(crate) partial: Vec<Point2<f64>>,
}

/// Code of a refusal that the worker itself makes: the planner's answer is none.
pub(crate) const BAD_OUTPUT: i32 = 100;

/// One planner of a library.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Described {
    pub(crate) id: String,
    pub(crate) name: String,
    pub(crate) version: String,
    pub(crate) about: String,
    pub(crate) caps: u32,
    pub(crate) state_version: u32,
    pub(crate) parameters: Vec<ParamInfo>,
}

/// A library that was loaded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loaded {
    pub(crate) sha256: String,
    pub(crate) abi_major: u32,
    pub(crate) abi_minor: u32,
    pub(crate) planners: Vec<Described>,
}

impl Writer {
    pub(crate) fn loaded(&mut self, loaded: &Loaded) -> &mut Self {
        self.text(&loaded.sha256).u32(loaded.abi_major).u32(loaded.abi_minor);
        self.all(&loaded.planners, |w, planner| {
            w.text(&planner.id).text(&planner.name).text(&planner.version).text(&planner.about);
            w.u32(planner.caps).u32(planner.state_version);
            w.all(&planner.parameters, Self::parameter);
        })
    }

    fn parameter(&mut self, param: &ParamInfo) {
        self.text(&param.key).text(&param.label).text(&param.unit).text(&param.help).text(&param.group);
        self.flag(param.live);
        match &param.kind {
            ParamKind::Float { min, max, default } => self.u8(0).f64(*min).f64(*max).f64(*default),
            ParamKind::Int { min, max, default } => {
                self.u8(1).u64(*min as u64).u64(*max as u64).u64(*default as u64)
            }
            ParamKind::Flag { default } => self.u8(2).flag(*default),
            ParamKind::Choice { options, default } => self
                .u8(3)
                .all(options, |w, word| {
                    w.text(word);
                })
                .text(default),
        };
    }

    pub(crate) fn refusal(&mut self, refusal: &Refusal) -> &mut Self {
        self.i32(refusal.code).text(&refusal.message).points(&refusal.partial)
    }

    pub(crate) fn said(&mut self, said: &Said) -> &mut Self {
        self.all(&said.drawings, |w, drawing| w.drawing(&drawing.into()));
        self.all(&said.scalars, |w, (name, value, unit)| {
            w.text(name).f64(*value).text(unit);
        });
        self.all(&said.logs, |w, (level, message)| {
            w.u8(*level as u8).text(message);
        })
    }

    fn drawing(&mut self, draw: &abi::Draw) {
        self.u8(draw.kind as u8).u8(draw.layer as u8);
        self.point(&draw.a.into()).point(&draw.b.into()).f64(draw.value);
    }

    pub(crate) fn plan(&mut self, plan: &Plan) -> &mut Self {
        self.points(&plan.path).f64(plan.cost).flag(plan.complete);
        self.all(&plan.legs, |w, leg| {
            w.u32(leg.tag as u32).u32(leg.first as u32).u32(leg.last as u32);
        });
        self.all(&plan.cuts, |w, cut| {
            w.points(cut);
        })
    }

    pub(crate) fn sandbox(&mut self, sandbox: &Sandbox) -> &mut Self {
        match sandbox {
            Sandbox::Full => self.u8(0),
            Sandbox::Partial(why) => self.u8(1).text(why),
            Sandbox::None(why) => self.u8(2).text(why),
        }
    }

    pub(crate) fn progress(&mut self, progress: &Progress) -> &mut Self {
        self.f64(progress.share).text(&progress.what)
    }

    pub(crate) fn command(&mut self, command: Command) -> &mut Self {
        let mut raw = abi::StepOut::UNSET;
        raw.set(command);
        self.u32(raw.status).u32(raw.drive).f64(raw.a).f64(raw.b)
    }
}

/// Reads what a library holds.
pub(crate) fn loaded_of(body: &mut Body<'_>) -> Read<Loaded> {
    Ok(Loaded {
        sha256: body.text()?,
        abi_major: body.u32()?,
        abi_minor: body.u32()?,
        planners: body.all(|body| {
            Ok(Described {
                id: body.text()?,
                name: body.text()?,
                version: body.text()?,
                about: body.text()?,
                caps: body.u32()?,
                state_version: body.u32()?,
                parameters: body.all(Body::parameter)?,
            })
        })?,
    })
}

/// Reads what a planner drew, reported and said.
pub(crate) fn said_of(body: &mut Body<'_>) -> Read<Said> {
    Ok(Said {
        drawings: body.all(Body::drawing)?,
        scalars: body.all(|body| Ok((body.text()?, body.f64()?, body.text()?)))?,
        logs: body.all(|body| Ok((log_level(body.u8()?.into()), body.text()?)))?,
    })
}

impl Body<'_> {
    fn parameter(&mut self) -> Read<ParamInfo> {
        Ok(ParamInfo {
            key: self.text()?,
            label: self.text()?,
            unit: self.text()?,
            help: self.text()?,
            group: self.text()?,
            live: self.flag()?,
            kind: self.parameter_kind()?,
        })
    }

    fn parameter_kind(&mut self) -> Read<ParamKind> {
        match self.u8()? {
            0 => Ok(ParamKind::Float { min: self.f64()?, max: self.f64()?, default: self.f64()? }),
            1 => {
                let mut next = || self.u64().map(|bits| bits as i64);
                Ok(ParamKind::Int { min: next()?, max: next()?, default: next()? })
            }
            2 => Ok(ParamKind::Flag { default: self.flag()? }),
            3 => Ok(ParamKind::Choice { options: self.all(Self::text)?, default: self.text()? }),
            _ => Err(Malformed),
        }
    }

    pub(crate) fn refusal(&mut self) -> Read<Refusal> {
        Ok(Refusal { code: self.i32()?, message: self.text()?, partial: self.points()? })
    }

    fn drawing(&mut self) -> Read<Drawing> {
        let (kind, layer) = (self.u8()?.into(), self.u8()?.into());
        let (a, b) = (self.point()?.into(), self.point()?.into());
        abi::Draw { kind, layer, a, b, value: self.f64()? }.get().ok_or(Malformed)
    }

    pub(crate) fn plan(&mut self) -> Read<Plan> {
        Ok(Plan {
            path: self.points()?,
            cost: self.f64()?,
            complete: self.flag()?,
            legs: self.all(Self::leg)?,
            cuts: self.all(Self::points)?,
        })
    }

    fn leg(&mut self) -> Read<Leg> {
        let tag = LegTag::from_number(self.u32()?).ok_or(Malformed)?;
        Ok(Leg { tag, first: self.u32()? as usize, last: self.u32()? as usize })
    }

    pub(crate) fn sandbox(&mut self) -> Read<Sandbox> {
        match self.u8()? {
            0 => Ok(Sandbox::Full),
            1 => self.text().map(Sandbox::Partial),
            2 => self.text().map(Sandbox::None),
            _ => Err(Malformed),
        }
    }

    /// A worker sends only text that can be displayed unchanged.
    pub(crate) fn progress(&mut self) -> Read<Progress> {
        let progress = Progress { share: self.f64()?, what: self.text()? };
        let is_short = progress.what.chars().count() <= Progress::LONGEST;
        let is_plain = is_short && !progress.what.contains(char::is_control);
        if is_plain && (0.0..=1.0).contains(&progress.share) { Ok(progress) } else { Err(Malformed) }
    }

    pub(crate) fn command(&mut self) -> Read<Command> {
        let (status, drive) = (self.u32()?, self.u32()?);
        let raw = abi::StepOut { status, drive, a: self.f64()?, b: self.f64()?, ..abi::StepOut::UNSET };
        raw.get().map_err(|_| Malformed)
    }
}

/// The level of a number that came over the boundary; unknown ones count as a warning.
pub(crate) fn log_level(number: u32) -> LogLevel {
    match number {
        0 => LogLevel::Debug,
        1 => LogLevel::Info,
        _ => LogLevel::Warn,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use nalgebra::Vector2;
    use planner_api::{Layer, Status};

    fn carried<T>(write: impl FnOnce(&mut Writer), read: impl FnOnce(&mut Body<'_>) -> Read<T>) -> T {
        let mut writer = Writer::default();
        write(writer.begin(1, 0, 0));
        let mut body = Body(&writer.finish().unwrap()[13..]);
        let read = read(&mut body).unwrap();
        assert_eq!(body.end(), Ok(()));
        read
    }

    #[test]
    fn a_description_arrives_with_every_kind_of_parameter() {
        let kinds = [
            ParamKind::Float { min: -1.0, max: 2.0, default: 0.5 },
            ParamKind::Int { min: -4, max: 9, default: -3 },
            ParamKind::Flag { default: true },
            ParamKind::Choice { options: vec!["a".into(), "b".into()], default: "b".into() },
        ];
        let parameters = kinds.map(|kind| ParamInfo {
            key: "k".into(),
            label: "L".into(),
            unit: "m".into(),
            help: "h".into(),
            group: "g".into(),
            live: true,
            kind,
        });
        let [id, name, version, about] = ["x", "X", "1", "?"].map(str::to_owned);
        let planners = vec![Described {
            id,
            name,
            version,
            about,
            caps: 9,
            state_version: 2,
            parameters: parameters.into(),
        }];
        let loaded = Loaded { sha256: "ab".into(), abi_major: 1, abi_minor: 0, planners };
        let write = |w: &mut Writer| {
            w.loaded(&loaded);
        };
        assert_eq!(carried(write, loaded_of), loaded);
    }

    #[test]
    fn what_was_said_arrives() {
        let (layer, at) = (Layer::Tether, Point2::new(1.0, 2.0));
        let said = Said {
            drawings: vec![
                Drawing::Arrow { layer, at, vector: Vector2::new(3.0, 4.0) },
                Drawing::Circle { layer, center: at, radius_m: 0.5 },
                Drawing::Line { layer, from: at, to: Point2::origin() },
            ],
            scalars: vec![("u".into(), 1.5, "J".into())],
            logs: vec![(LogLevel::Warn, "narrow".into())],
        };
        let write = |w: &mut Writer| {
            w.said(&said);
        };
        assert_eq!(carried(write, said_of), said);
    }

    #[test]
    fn plans_commands_and_refusals_arrive() {
        let path = vec![Point2::new(1.0, 2.0)];
        let legs = vec![
            Leg { tag: LegTag::Retract, first: 0, last: 0 },
            Leg { tag: LegTag::Swath, first: 0, last: 0 },
        ];
        let cuts = vec![path.clone(), Vec::new()];
        let plan = Plan { path, cost: 3.0, complete: true, legs, cuts };
        let command = Command { status: Status::Waiting, ..Command::twist(0.1, -0.2) };
        let refusal = Refusal { code: -7, message: "no".into(), partial: plan.path.clone() };
        let write = |w: &mut Writer| {
            w.plan(&plan).command(command).refusal(&refusal);
        };
        let read = |body: &mut Body<'_>| Ok((body.plan()?, body.command()?, body.refusal()?));
        assert_eq!(carried(write, read), (plan.clone(), command, refusal.clone()));
    }
}
