//! Force laws shared by the potential-field planners, and two ways to use them: walking a law over the known map to
//! plan, and flying a robot along it tick by tick.
//!
//! Frame: the tank frame, metres, radians. Distances to obstacles are measured from the robot's hull to the outline; a
//! point obstacle and a robot of radius zero give the papers' point form. Cost: only obstacles within reach of a law
//! are examined, and a bounding volume hierarchy finds them.
//!
//! Sources: Khatib 1986 (attraction, repulsion); Ge and Cui 2000 (improved repulsion); Wang et al. 2023 (rotation,
//! lock-step targets, stop rules); Xu et al. 2022 (logarithmic pull, tangent force); Yang et al. 2021 (capped pull).
//! Where these sources leave something open, the item states our choice.
#![forbid(unsafe_code)]

pub mod descent;
pub mod ends;
pub mod escape;
pub mod goal_law;
pub mod goal_walk;
pub mod law;
pub mod laws;
pub mod lockstep;
pub mod offline;
pub mod open_points;
pub mod oscillation;
pub mod outcome;
pub mod params;
pub mod pilot;
pub mod pull;
pub mod response;
pub mod rollout;
pub mod scene;
pub mod settings;
pub mod trap;
pub mod turning;
pub mod virtual_goals;
pub mod walk;

pub use escape::Escape;
pub use goal_law::{GoalLaw, Sides, TangentUse};
pub use law::{Law, Repulsion, RotationForm};
pub use laws::PushForm;
pub use pilot::ForcePilot;
pub use pull::{NearLaw, Pull};
pub use scene::Scene;
pub use settings::{FieldSettings, Planning, RotationUse, Walking};
pub use turning::{Reading, SenseRule};
