//! Answers: what a library holds, what a planner said, a plan, how far it is, a command, a refusal.
//!
//! Whoever wrote the plugin can write to the socket, too. So the console believes of an answer only what it has checked
//! itself: the readers here keep the limits of what a worker would send, and texts are made plain by [`Body::text`].

use super::body::{Body, Malformed, Read, Writer};
use crate::Progress;
use crate::parameters::check;
use crate::stamp::Abi;
pub(crate) use mission::Said;
use mission::{ParamInfo, ParamKind, Sandbox};
use nalgebra::Point2;
use planner_api::export::is_id;
use planner_api::{Command, Drawing, Leg, LegTag, LogLevel, Plan, abi};

/// A planner's refusal as it crosses: the number of its code, its sentence, the part of the way that it found.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Refusal {
    pub(crate) code: i32,
    pub(crate) message: String,
    pub(crate) partial: Vec<Point2<f64>>,
}

/// Code of a refusal that the worker itself makes: the planner's answer is invalid.
pub(crate) const BAD_OUTPUT: i32 = 100;

/// Most planners in a library.
pub(crate) const MOST_PLANNERS: usize = 64;
/// Most of everything that one answer may hold.
pub(crate) const MOST_PARAMS: usize = 256;
pub(crate) const MOST_DRAWINGS: usize = 4096;
pub(crate) const MOST_SCALARS: usize = 256;
/// Of the planner; the worker may add one.
pub(crate) const MOST_LOGS: usize = 64;
pub(crate) const MOST_POINTS: usize = 1_000_000;
pub(crate) const MOST_CUTS: usize = 10_000;

/// A worker that is closed off, and what it is about to load. It says so before anything of the plugin runs: this is
/// believed of it, and what it says later is the plugin's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sealed {
    /// How far it is closed off.
    pub(crate) sandbox: Sandbox,
    /// Of the file, hexadecimal.
    pub(crate) sha256: String,
    /// Of the file's stamp.
    pub(crate) abi: Abi,
}

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

impl Writer {
    pub(crate) fn planners(&mut self, planners: &[Described]) -> &mut Self {
        self.all(planners, |w, planner| {
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

    pub(crate) fn sealed(&mut self, sealed: &Sealed) -> &mut Self {
        match &sealed.sandbox {
            Sandbox::Full => self.u8(0),
            Sandbox::Partial(why) => self.u8(1).text(why),
            Sandbox::None(why) => self.u8(2).text(why),
        };
        self.text(&sealed.sha256).u32(sealed.abi.major).u32(sealed.abi.minor)
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

/// Reads which planners a library has.
pub(crate) fn planners_of(body: &mut Body<'_>) -> Read<Vec<Described>> {
    let planners = body.at_most(MOST_PLANNERS, Body::described)?;
    let is_new = |i: usize, id: &String| planners[..i].iter().all(|earlier| earlier.id != *id);
    let are_sound = planners.iter().enumerate().all(|(i, planner)| {
        is_id(&planner.id) && is_new(i, &planner.id) && check(&planner.parameters).is_ok()
    });
    if are_sound { Ok(planners) } else { Err(Malformed) }
}

/// Reads what a planner drew, reported and said.
pub(crate) fn said_of(body: &mut Body<'_>) -> Read<Said> {
    let said = Said {
        drawings: body.at_most(MOST_DRAWINGS, Body::drawing)?,
        scalars: body.at_most(MOST_SCALARS, |body| Ok((body.text()?, body.f64()?, body.text()?)))?,
        logs: body.at_most(MOST_LOGS + 1, |body| Ok((log_level(body.u8()?.into()), body.text()?)))?,
    };
    if said.scalars.iter().all(|(_, value, _)| value.is_finite()) { Ok(said) } else { Err(Malformed) }
}

impl Body<'_> {
    fn described(&mut self) -> Read<Described> {
        Ok(Described {
            id: self.text()?,
            name: self.text()?,
            version: self.text()?,
            about: self.text()?,
            caps: self.u32()?,
            state_version: self.u32()?,
            parameters: self.at_most(MOST_PARAMS, Body::parameter)?,
        })
    }

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
            cuts: self.at_most(MOST_CUTS, Self::points)?,
        })
    }

    fn leg(&mut self) -> Read<Leg> {
        let tag = LegTag::from_number(self.u32()?).ok_or(Malformed)?;
        Ok(Leg { tag, first: self.u32()? as usize, last: self.u32()? as usize })
    }

    pub(crate) fn sealed(&mut self) -> Read<Sealed> {
        let sandbox = match self.u8()? {
            0 => Sandbox::Full,
            1 => Sandbox::Partial(self.text()?),
            2 => Sandbox::None(self.text()?),
            _ => return Err(Malformed),
        };
        Ok(Sealed { sandbox, sha256: self.text()?, abi: Abi { major: self.u32()?, minor: self.u32()? } })
    }

    pub(crate) fn progress(&mut self) -> Read<Progress> {
        let progress = Progress { share: self.f64()?, what: self.text()? };
        let is_short = progress.what.chars().count() <= Progress::LONGEST;
        if is_short && (0.0..=1.0).contains(&progress.share) { Ok(progress) } else { Err(Malformed) }
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
        let keys = ["f", "i", "b", "c"].into_iter();
        let parameters = kinds.into_iter().zip(keys).map(|(kind, key)| ParamInfo {
            key: key.into(),
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
            parameters: parameters.collect(),
        }];
        let write = |w: &mut Writer| {
            w.planners(&planners);
        };
        assert_eq!(carried(write, planners_of), planners);
    }

    #[test]
    fn a_description_that_no_worker_sends_is_refused() {
        let planner = |id: &str, default: f64| {
            let [name, version, about] = ["X", "1", "?"].map(str::to_owned);
            let [key, label, unit, help, group] = ["k", "L", "m", "h", "g"].map(str::to_owned);
            let kind = ParamKind::Float { min: 0.0, max: 1.0, default };
            let parameters = vec![ParamInfo { key, label, unit, help, group, live: true, kind }];
            Described { id: id.to_owned(), name, version, about, caps: 0, state_version: 1, parameters }
        };
        let read = |planners: &[Described]| {
            let mut writer = Writer::default();
            writer.planners(planners);
            planners_of(&mut Body(&writer.into_bytes())).map(|planners| planners.len())
        };
        assert_eq!(read(&[planner("x", 0.5), planner("y", 0.5)]), Ok(2));
        for bad in [vec![planner("a b", 0.5)], vec![planner("x", f64::NAN)], vec![planner("x", 2.0)]] {
            assert_eq!(read(&bad), Err(Malformed), "{bad:?}");
        }
        assert_eq!(read(&[planner("x", 0.5), planner("x", 0.5)]), Err(Malformed));
    }

    #[test]
    fn a_text_moves_no_cursor_and_turns_no_line_round() {
        let mut writer = Writer::default();
        writer.text("a\u{1b}[2Jb\u{202e}c\u{9b}d\u{200b}");
        assert_eq!(Body(&writer.into_bytes()).text(), Ok("a�[2Jb�c�d�".to_owned()));
    }

    #[test]
    fn more_than_a_worker_sends_is_refused() {
        let reads = |said: &Said| {
            let mut writer = Writer::default();
            writer.said(said);
            said_of(&mut Body(&writer.into_bytes())).is_ok()
        };
        let logs = |n| Said { logs: vec![(LogLevel::Info, String::new()); n], ..Said::default() };
        let scalar = |value| Said { scalars: vec![("u".into(), value, String::new())], ..Said::default() };
        assert!(reads(&logs(MOST_LOGS + 1)) && !reads(&logs(MOST_LOGS + 2)));
        assert!(reads(&scalar(1.0)) && !reads(&scalar(f64::NAN)));
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
