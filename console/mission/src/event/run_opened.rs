//! The first event of a run.

use super::Measured;
use crate::config::MissionConfig;
use serde::{Deserialize, Serialize};
use vehicle::port::VehicleInfo;
use world::World;

/// Everything needed to repeat a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunOpened {
    /// Version of the journal format of the writer.
    pub journal_version: u32,
    /// Version of tankops.
    pub tankops_version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// The scenario file as read, with the settings of the command line already applied.
    pub scenario_toml: String,
    /// Seed for all random choices.
    pub seed: u64,
    /// The true tank.
    pub world: World,
    /// Configuration of the mission.
    pub mission: MissionConfig,
    /// The coverage grid, with the cells that are floor and those that the tool can reach.
    pub floor: world::Floor,
    /// The layout of the floor plates, if the drawing shows them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plates: Option<world::PlateLayout>,
    /// The true thickness of the floor, for simulated readings; the mission does not know it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wear: Option<world::FloorWear>,
    /// The checks that the operator ticks by hand before the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checklist: Vec<String>,
    /// Measurements by another system, located afterwards; absent for a run that was flown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// The real vehicle that was driven; absent for a simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vehicle: Option<Box<VehicleInfo>>,
}
