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
    let mut loopback = Loopback {
        is_omni: hello.motion == vehicle::wire::message::MotionKind::Omni,
        behind,
        inbox: Inbox::new(stations, "loopback".into()),
        outbox: Outbox::default(),
        to_vehicle: (Writer::new(session.clone()), Reader::new(session)),
        from_vehicle: (Writer::new(FromSession::default()), Reader::new(FromSession::default())),
        tick: 0,
        tick_s: scenario.mission.tick_s,
    };
    loopback.hear(&FromVehicle::Hello(hello))?;
    loopback.hear(&first)?;
    loopback.hear(&FromVehicle::Pong(Pong { echo_s: 0.0, stamp_s: 0.0 }))?;
    loopback.tell_state()?;
    Ok(flight.with_vehicle(scenario, Box::new(loopback), info))
}

impl Loopback {
    fn now_s(&self) -> f64 {
        self.tick as f64 * self.tick_s
    }

    fn hear(&mut self, message: &FromVehicle) -> Result<(), Misfit> {
        let mut line = Vec::new();
        self.from_vehicle.0.write(message, &mut line)?;
        let now_s = self.now_s();
        for heard in self.from_vehicle.1.read(&line) {
            self.inbox.take(heard, now_s);
        }
        Ok(())
    }

    fn say(&mut self) -> Result<(), Misfit> {
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
        self.hear(&readings)?;
        if self.tick.is_multiple_of(STATE_EVERY) { self.tell_state() } else { Ok(()) }
    }

    fn tell_state(&mut self) -> Result<(), Misfit> {
        self.hear(&self.behind.state(self.now_s(), Commander::You))
    }
}

impl Vehicle for Loopback {
    fn sense(&mut self) -> Sensed {
        let now_s = self.now_s();
        self.inbox.sense(now_s)
    }

    fn act(&mut self, Command { drive, heading_rad, braking_orders }: Command) {
        self.inbox.commanded(drive.is_some(), self.now_s());
        let motion = drive.map(|drive| motion(drive, heading_rad, self.is_omni));
        self.outbox.command(motion, braking_orders, self.now_s());
        if let Err(misfit) = self.say() {
            self.inbox.close(misfit.to_string());
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
