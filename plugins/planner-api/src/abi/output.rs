//! What a planner passes back.
#![allow(missing_docs, reason = "the header explains the fields")]

use super::{Sized32, Str, Vec2};
use crate::{Command, Drawing, Drive, Layer, LegTag, Status};

/// Kinds of [`Param`].
pub const PARAM_FLOAT: u32 = 0;
pub const PARAM_INT: u32 = 1;
pub const PARAM_FLAG: u32 = 2;
pub const PARAM_CHOICE: u32 = 3;
/// Flag of a parameter that may change during a mission.
pub const PARAM_LIVE: u32 = 1;

/// Kinds of [`Draw`].
pub const DRAW_ARROW: u32 = 0;
pub const DRAW_CIRCLE: u32 = 1;
pub const DRAW_LINE: u32 = 2;

/// Kinds of drive in [`StepOut`]: speed and turn rate, or velocity in the tank frame.
pub const DRIVE_TWIST: u32 = 0;
pub const DRIVE_VELOCITY: u32 = 1;

/// One declared parameter; the `options` are joined by `|`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Param {
    pub size: u32,
    pub kind: u32,
    pub flags: u32,
    pub reserved: u32,
    pub key: Str,
    pub label: Str,
    pub unit: Str,
    pub help: Str,
    pub group: Str,
    pub options: Str,
    pub min: f64,
    pub max: f64,
    pub default: f64,
}

/// One parameter value: 0 or 1 for a flag, the index of the word for a choice.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Value {
    pub key: Str,
    pub number: f64,
}

/// One drawing; the layout is frozen for the major version.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw {
    pub kind: u32,
    pub layer: u32,
    pub a: Vec2,
    pub b: Vec2,
    pub value: f64,
}

/// A stretch of a path and its purpose; the layout is frozen for the major version.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leg {
    pub tag: u32,
    pub first: u32,
    pub last: u32,
    pub reserved: u32,
}

/// What a plan contains besides its points. The console initialises it with invalid values ([`Self::UNSET`]).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanOut {
    pub size: u32,
    pub complete: u32,
    pub cost: f64,
}

/// A command. The console initialises it with invalid values ([`Self::UNSET`]).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOut {
    pub size: u32,
    pub status: u32,
    pub drive: u32,
    pub reserved: u32,
    pub a: f64,
    pub b: f64,
}

// SAFETY: consists of numbers and raw pointers and begins with its size.
unsafe impl Sized32 for Param {}

impl PlanOut {
    /// The value until the planner answers.
    pub const UNSET: Self = Self { size: size_of::<Self>() as u32, complete: u32::MAX, cost: f64::NAN };
}

impl StepOut {
    /// The value until the planner answers.
    pub const UNSET: Self = Self {
        size: size_of::<Self>() as u32,
        status: u32::MAX,
        drive: u32::MAX,
        reserved: 0,
        a: f64::NAN,
        b: f64::NAN,
    };

    /// Stores a command as numbers.
    pub fn set(&mut self, command: Command) {
        let (drive, a, b) = match command.drive {
            Drive::Twist { v_m_per_s, w_rad_per_s } => (DRIVE_TWIST, v_m_per_s, w_rad_per_s),
            Drive::Velocity(velocity) => (DRIVE_VELOCITY, velocity.x, velocity.y),
        };
        let status = match command.status {
            Status::Moving => 0,
            Status::Arrived => 1,
            Status::Stuck => 2,
            Status::Waiting => 3,
        };
        (self.status, self.drive, self.a, self.b) = (status, drive, a, b);
    }

    /// Reads the command from the numbers.
    ///
    /// # Errors
    /// States which number is invalid. The text is for the operator, and completes a sentence that begins with the
    /// planner's name.
    pub fn get(&self) -> Result<Command, String> {
        let status = match self.status {
            0 => Status::Moving,
            1 => Status::Arrived,
            2 => Status::Stuck,
            3 => Status::Waiting,
            u32::MAX => return Err("gave no command".to_owned()),
            unknown => return Err(format!("gave the unknown status {unknown}")),
        };
        let drive = match self.drive {
            u32::MAX => return Err("gave a status but no drive".to_owned()),
            DRIVE_TWIST => Drive::Twist { v_m_per_s: self.a, w_rad_per_s: self.b },
            DRIVE_VELOCITY => Drive::Velocity(nalgebra::Vector2::new(self.a, self.b)),
            unknown => return Err(format!("gave the unknown drive kind {unknown}")),
        };
        Ok(Command { drive, status })
    }
}

impl From<&crate::Leg> for Leg {
    fn from(leg: &crate::Leg) -> Self {
        Self { tag: leg.tag as u32, first: leg.first as u32, last: leg.last as u32, reserved: 0 }
    }
}

impl Leg {
    /// Reads the leg.
    ///
    /// # Errors
    /// States that the tag is unknown. The text is for the operator, and completes a sentence that begins with the
    /// planner's name.
    pub fn get(&self) -> Result<crate::Leg, String> {
        let tag = LegTag::from_number(self.tag)
            .ok_or_else(|| format!("gave a leg of unknown kind {}", self.tag))?;
        Ok(crate::Leg { tag, first: self.first as usize, last: self.last as usize })
    }
}

impl From<&Drawing> for Draw {
    fn from(drawing: &Drawing) -> Self {
        let zero = Vec2::default();
        match *drawing {
            Drawing::Arrow { layer, at, vector } => {
                Self { kind: DRAW_ARROW, layer: layer as u32, a: at.into(), b: vector.into(), value: 0.0 }
            }
            Drawing::Circle { layer, center, radius_m } => {
                Self { kind: DRAW_CIRCLE, layer: layer as u32, a: center.into(), b: zero, value: radius_m }
            }
            Drawing::Line { layer, from, to } => {
                Self { kind: DRAW_LINE, layer: layer as u32, a: from.into(), b: to.into(), value: 0.0 }
            }
        }
    }
}

impl Draw {
    /// Reads the drawing; `None` if one of its numbers is not finite or its kind is unknown.
    pub fn get(&self) -> Option<Drawing> {
        let finite = [self.a.x, self.a.y, self.b.x, self.b.y, self.value].iter().all(|x| x.is_finite());
        let layer = Layer::from_number(self.layer);
        match self.kind {
            _ if !finite => None,
            DRAW_ARROW => Some(Drawing::Arrow { layer, at: self.a.into(), vector: self.b.into() }),
            DRAW_CIRCLE => Some(Drawing::Circle { layer, center: self.a.into(), radius_m: self.value }),
            DRAW_LINE => Some(Drawing::Line { layer, from: self.a.into(), to: self.b.into() }),
            _ => None,
        }
    }
}
