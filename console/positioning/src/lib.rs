//! Locates the robot: turns acoustic-emission ranges into fixes, and fixes and odometry into a pose.
//!
//! Nothing here uses the truth, a clock or a file. Frame and units are as in [`world`]. Cost: a few microseconds for a
//! fix, less than one microsecond for a filter step.

pub mod fix;
pub mod noise;
pub mod possible;

pub mod aggregate;
pub mod bounded;
pub mod consensus;
pub mod differences;
pub mod linear;
pub mod nonlinear;
pub mod screened;
pub mod weighted;

pub mod accuracy;

pub mod calibration;
pub mod ekf;
pub mod fixed_lag;
pub mod particle;
pub mod positioner;
pub mod protection;
pub mod pulses;
pub mod repetitions;
pub mod session;
pub mod session_calibration;
pub mod station_clocks;

mod anchor;
#[cfg(test)]
mod draws;
mod pair;
mod quality;
mod sides;
mod solver_kind;

pub use accuracy::{
    Accuracy, AccuracyMap, Forecast,
    adviser::{Advice, AdviceError, advise},
    checks::{Checks, OneMore, SessionChecks},
};
pub use aggregate::Aggregation;
pub use bounded::Bounded;
pub use calibration::{Calibration, Unknowns};
pub use consensus::{Consensus, WrongRanges};
pub use differences::Differences;
pub use ekf::{Ekf, MotionNoise};
pub use fix::{Exclusion, Fix, FixError, Integrity, PositionSolver, Prior, Ranging, Residual};
pub use fixed_lag::FixedLag;
pub use linear::LinearLs;
pub use noise::{RangeNoise, Timing};
pub use nonlinear::Nls;
pub use particle::{Particles, ParticlesConfig};
pub use positioner::{Agreement, CycleResult, Doubt, Estimate, Positioner, PositionerConfig};
pub use possible::{Impossible, Possible};
pub use protection::{Guard, Multipliers, Risk, Unprotected, are_on_line};
pub use pulses::{Pulse, PulseError, PulseSeries, PulseTest, longest_pulse_m};
pub use quality::{alarm_limit, scatter_limit};
pub use repetitions::Repetitions;
pub use screened::Screened;
pub use session::{CommonError, Session, Verdict, Wrong};
pub use session_calibration::{Estimated, Near, News, OnBias, SessionCalibration, SessionConfig, SoundSpeed};
pub use sides::{Sides, mirrored};
pub use solver_kind::SolverKind;
pub use station_clocks::{ClockConfig, StationClocks};
pub use weighted::WeightedLinear;
