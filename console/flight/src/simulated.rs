//! The vehicle that the simulator computes.

use sim::Simulator;
use vehicle::port::{CannotInject, Command, Sensed, StationFault, Vehicle};
use world::Truth;

/// The simulator in the role of a vehicle. Its readings are not written to the journal, because they can be computed
/// again.
pub(crate) struct Simulated(Simulator);

impl Simulated {
    pub(crate) fn new(simulator: Simulator) -> Self {
        Self(simulator)
    }
}

impl Vehicle for Simulated {
    fn sense(&mut self) -> Sensed {
        Sensed { readings: self.0.sense(), live: None }
    }

    fn act(&mut self, command: Command) {
        self.0.act(command.drive.unwrap_or(geometry::Drive::STILL));
    }

    fn truth(&self) -> Option<Truth> {
        Some(self.0.truth())
    }

    fn inject(
        &mut self,
        StationFault { station, for_s, excess_range_m }: StationFault,
    ) -> Result<(), CannotInject> {
        self.0.inject(station, for_s, excess_range_m);
        Ok(())
    }
}
