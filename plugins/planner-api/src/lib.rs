#![doc = include_str!("../README.md")]
//! # Rust
//!
//! Write a type, implement [`Planner`] for it, and export it with `export_planners!(MyPlanner)` from a crate of type
//! `cdylib`. Everything else (the C table, catching panics, copying) is done here; the author's crate may
//! `#![forbid(unsafe_code)]`.
//!
//! Frame: the tank frame, x east, y north, metres; angles in radians, counter-clockwise; SI units throughout.

pub mod command;
pub mod ctx;
pub mod drawing;
pub mod error;
pub mod message;
pub mod params;
pub mod planner;
pub mod request;
pub mod site;
pub mod testing;

pub mod abi;
pub mod export;
#[doc(hidden)]
pub mod glue;

pub use command::{Command, Status, Stopping};
pub use ctx::{Ctx, LogLevel, Services, StopReason};
pub use drawing::{Drawing, Layer};
pub use error::{Code, PlannerError};
/// Points, poses, shapes, paths and motion: what a planner shares with the console.
pub use geometry::{self, Drive, Limits, Motion};
pub use glue::on_own_thread;
pub use nalgebra::{Point2, Vector2};
pub use params::{Config, Kind, ParamSpec, Value, choice, flag, float, int};
pub use planner::{Caps, Planner};
pub use request::{Leg, LegTag, Plan, PlanRequest, PoseEstimate, Reason, Sensed, Task, TetherLimits};
pub use site::{Boundary, Obstacle, Outline, Site, Zone, ZoneKind};

/// The result of a planner's call.
pub type Result<T> = std::result::Result<T, PlannerError>;
