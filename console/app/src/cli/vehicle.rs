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

/// The trial of a vehicle by `tankops check`.
#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// Try a vehicle: measure its messages, rates and clock and, with --drive, its frames and stops. The address is
    /// unix:PATH, tcp:HOST:PORT, udp:HOST:PORT, or run:COMMAND.
    #[arg(long, value_name = "ADDRESS", group = "tried", conflicts_with = "files")]
    pub vehicle: Option<Address>,
    /// Allow the trial to MOVE the vehicle: 0.2 m ahead, 20 degrees to the left, then stops from full speed, ahead and
    /// back in turn.
    #[arg(long, requires = "vehicle")]
    pub drive: bool,
    /// Speed before each stop, in metres per second; default: the limit of the vehicle.
    #[arg(long, value_name = "M_PER_S", requires = "drive", value_parser = positive)]
    pub speed: Option<f64>,
    /// Longest time of each stop, in seconds; default: the stop time that the vehicle states, plus the lease.
    #[arg(long, value_name = "SECONDS", requires = "drive", value_parser = positive)]
    pub stop_max: Option<f64>,
    /// Allow a vehicle on another machine; the wire is not protected.
    #[arg(long, requires = "vehicle")]
    pub vehicle_network: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| *value > 0.0 && *value <= 60.0);
    value.ok_or_else(|| "write a number greater than 0 and at most 60".into())
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
    /// Report obstacles by a scanner of 360 rays instead of by their outlines: obstacles that are not drawn are then
    /// only in the scan, and the guard must stop the robot.
    #[arg(long)]
    pub scanner: bool,
    /// Allow consoles on other machines; the wire is not protected.
    #[arg(long)]
    pub vehicle_network: bool,
}
