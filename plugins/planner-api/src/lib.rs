#![doc = include_str!("../README.md")]
//! # Rust
//!
//! Write a type, implement [`Planner`] for it, and export it with `export_planners!(MyPlanner)` from a crate of type
//! `cdylib`. This crate does the rest (the C ABI, catching panics, copying), so your crate can
//! `#![forbid(unsafe_code)]`.
//!
//! Units and frame: SI units throughout; the tank frame has x east and y north, in metres; angles are in radians,
//! counter-clockwise from east.

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
/// The types that planners share with the console: points, poses, shapes, paths and motion.
pub use geometry::{self, Drive, Limits, Motion};
pub use glue::on_own_thread;
pub use nalgebra::{Point2, Vector2};
pub use params::{Config, Kind, ParamSpec, Value, choice, flag, float, int};
pub use planner::{Caps, Planner};
pub use request::{
    Leg, LegTag, Plan, PlanRequest, PoseEstimate, Reason, Sensed, Task, TetherLimits, TetherPull,
};
pub use site::{Boundary, Obstacle, Outline, Site, Zone, ZoneKind};

/// The result of a call to a planner.
pub type Result<T> = std::result::Result<T, PlannerError>;
