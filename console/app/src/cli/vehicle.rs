//! Options of real vehicles.

use super::Changes;
use clap::{Args, Subcommand};
use remote::{Address, Wanted};
use std::path::PathBuf;

/// The vehicle that a command drives.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct VehicleArgs {
    /// Drive a real vehicle instead of the simulator: unix:PATH, tcp:HOST:PORT, udp:HOST:PORT, or run:COMMAND for an
    /// adapter that uses its stdin and stdout. Without an address, `at` in the scenario's section [vehicle] applies.
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1)]
    #[allow(clippy::option_option, reason = "the option, and its value")]
    pub vehicle: Option<Option<Address>>,
    /// Allow a vehicle on another machine; the wire is not protected.
    #[arg(long)]
    pub vehicle_network: bool,
}

impl VehicleArgs {
    /// The vehicle that is to be driven; `None` for the simulator.
    pub(crate) fn wanted(&self) -> Option<Wanted> {
        self.vehicle.clone().map(|at| Wanted { at, network: self.vehicle_network })
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum VehicleCommand {
    /// Offer the simulator of a scenario as a vehicle, in a separate process.
    Simulate(SimulateArgs),
}

#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Scenario file, or the name of a scenario in the folder `scenarios`.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Where to listen: unix:PATH, tcp:HOST:PORT or udp:HOST:PORT; port 0 takes any free port.
    #[arg(long, value_name = "ADDRESS")]
    pub listen: Address,
    /// Advance the simulation by one tick per command instead of by the clock; a mission then makes the same decisions
    /// as with the simulator inside the console.
    #[arg(long)]
    pub lockstep: bool,
    /// Allow consoles on other machines; the wire is not protected.
    #[arg(long)]
    pub vehicle_network: bool,
}
