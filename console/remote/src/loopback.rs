//! The simulator behind the wire, inside this process. Time passes with the ticks, so that a mission over the wire can be
//! compared with the same mission without it.

use crate::{inbox::Inbox, outbox::Outbox, remote::motion};
use flight::{Flight, behind::Behind};
use scenario::Scenario;
use vehicle::{
    port::{CannotInject, Command, Live, Sensed, StationFault, Vehicle, VehicleInfo},
    wire::{
        FromSession, FromVehicle, Misfit, Reader, ToSession, ToVehicle, Writer,
        message::{Commander, Pong},
    },
};
use world::Truth;

/// The vehicle sends its state in one tick of this many, which last less than a second.
const STATE_EVERY: u64 = 8;

/// A simulated vehicle that is reached by the bytes of the wire alone.
struct Loopback {
    behind: Behind,
    inbox: Inbox,
    outbox: Outbox,
    is_omni: bool,
    to_vehicle: (Writer<ToVehicle>, Reader<ToVehicle>),
    from_vehicle: (Writer<FromVehicle>, Reader<FromVehicle>),
    tick: u64,
    tick_s: f64,
}

/// The flight with its simulator behind the wire.
///
/// # Errors
/// The scenario needs a vehicle that the protocol does not allow.
pub(crate) fn looped_back(flight: Flight, scenario: &Scenario) -> Result<Flight, Misfit> {
    let (loopback, info) = Loopback::of(scenario)?;
    Ok(flight.with_vehicle(scenario, Box::new(loopback), info))
}

impl Loopback {
    /// The simulator of a scenario, after its introduction, and what it says about itself.
    fn of(scenario: &Scenario) -> Result<(Self, VehicleInfo), Misfit> {
        let mut behind = Behind::new(scenario);
        let FromVehicle::Hello(hello) = behind.hello() else {
            return Err(Misfit { field: "hello".into(), what: "is missing".into() });
        };
        let stations =
            scenario.sim.world.stations.iter().map(|station| (station.name.clone(), station.id)).collect();
        let session = ToSession::of((*hello).clone());
        let info = VehicleInfo {
            name: hello.name.clone(),
            at: "loopback".into(),
            protocol: hello.protocol,
            lease_s: hello.lease_max_s,
            stop_s: hello.stop_time_s,
            ..VehicleInfo::default()
        };
        let first = behind.first(0.0);
        let mut loopback = Self {
            is_omni: hello.motion == vehicle::wire::message::MotionKind::Omni,
            behind,
            inbox: Inbox::new(stations, "loopback".into()),
            outbox: Outbox::default(),
            to_vehicle: (Writer::new(session.clone()), Reader::new(session)),
            from_vehicle: (Writer::new(FromSession::default()), Reader::new(FromSession::default())),
            tick: 0,
            tick_s: scenario.mission.tick_s,
        };
        let pong = FromVehicle::Pong(Pong { echo_s: 0.0, stamp_s: 0.0 });
        let state = loopback.behind.state(0.0, Commander::You);
        for message in [FromVehicle::Hello(hello), first, pong, state] {
            let line = loopback.line(&message)?;
            loopback.take(&line);
        }
        Ok((loopback, info))
    }

    fn now_s(&self) -> f64 {
        self.tick as f64 * self.tick_s
    }

    /// A message of the vehicle as a line of the wire.
    fn line(&mut self, message: &FromVehicle) -> Result<Vec<u8>, Misfit> {
        let mut line = Vec::new();
        self.from_vehicle.0.write(message, &mut line)?;
        Ok(line)
    }

    /// Takes a line of the vehicle.
    fn take(&mut self, line: &[u8]) {
        let now_s = self.now_s();
        for heard in self.from_vehicle.1.read(line) {
            self.inbox.take(heard, now_s);
        }
    }

    /// Sends a command; returns the lines with which the vehicle answers after a tick.
    fn answered(&mut self, command: Command) -> Result<Vec<Vec<u8>>, Misfit> {
        let Command { drive, heading_rad, braking_orders } = command;
        self.inbox.commanded(drive.is_some(), self.now_s());
        let motion = drive.map(|drive| motion(drive, heading_rad, self.is_omni));
        self.outbox.command(motion, braking_orders, self.now_s());
        let (mut line, now_s) = (Vec::new(), self.now_s());
        let message = self.outbox.next(|| now_s, &mut now_s.clone());
        self.to_vehicle.0.write(&message, &mut line)?;
        self.inbox.sent(&message, now_s);
        for heard in self.to_vehicle.1.read(&line) {
            if let vehicle::wire::Heard::Message(message) = heard {
                self.behind.take(&message, now_s);
            }
        }
        self.tick += 1;
        let readings = self.behind.step(self.now_s());
        let mut lines = vec![self.line(&readings)?];
        if self.tick.is_multiple_of(STATE_EVERY) {
            let state = self.behind.state(self.now_s(), Commander::You);
            lines.push(self.line(&state)?);
        }
        Ok(lines)
    }
}

impl Vehicle for Loopback {
    fn sense(&mut self) -> Sensed {
        let now_s = self.now_s();
        self.inbox.sense(now_s)
    }

    fn act(&mut self, command: Command) {
        match self.answered(command) {
            Ok(lines) => lines.iter().for_each(|line| self.take(line)),
            Err(misfit) => self.inbox.close(misfit.to_string()),
        }
    }

    fn settle(&mut self, _: bool) -> Option<Live> {
        let now_s = self.now_s();
        Some(self.inbox.settled(now_s))
    }

    fn truth(&self) -> Option<Truth> {
        None
    }

    fn inject(&mut self, _: StationFault) -> Result<(), CannotInject> {
        Err(CannotInject)
    }
}

#[cfg(test)]
mod spoiled;
