//! `tankops vehicle simulate`: the simulator behind the wire, in a process of its own.

use crate::{cli::SimulateArgs, stop_signal};
use anyhow::Context;
use flight::{
    behind::Behind,
    failure::{COMPLETE, bad_input},
    scenarios,
};
use remote::server::{Client, ClientId, Did, Server};
use report::print::say_line;
use std::{
    collections::BTreeMap,
    process::ExitCode,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};
use vehicle::wire::{
    FromVehicle, ToVehicle,
    message::{Commander, Hello},
};

/// Time between two reports of the state.
const STATE_EVERY: Duration = Duration::from_millis(500);
/// Interval at which the loop checks for a signal that ends the command.
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// Runs `tankops vehicle simulate SCENARIO`, until a signal ends it.
pub(crate) fn simulate(args: &SimulateArgs) -> anyhow::Result<ExitCode> {
    let stop = stop_signal::listen();
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let vehicle = if args.scanner { Behind::with_scanner(&scenario) } else { Behind::new(&scenario) };
    let vehicle = vehicle.with_session(since_1970.as_secs());
    let vehicle = if args.lockstep { vehicle } else { vehicle.with_pose() };
    let FromVehicle::Hello(hello) = vehicle.hello() else {
        anyhow::bail!("the simulated vehicle sent no `hello` message")
    };
    let server = Server::listen(&args.listen, Hello::clone(&hello), args.vehicle_network)
        .map_err(|error| bad_input(format!("cannot listen on {}: {error}", args.listen)))?;
    say_line(&format!("{} listens on {}", hello.name, server.at()))?;
    let mut offered = Offered::new(vehicle, args.lockstep);
    while !stop.requested() {
        let until = offered.due.min(Instant::now() + LOOK_AGAIN);
        if let Some((id, did)) = server.next(until) {
            offered.take(id, did)?;
        }
        offered.pass_time()?;
    }
    Ok(ExitCode::from(COMPLETE))
}

/// A vehicle and the consoles that are connected to it.
struct Offered {
    vehicle: Behind,
    clients: BTreeMap<ClientId, Client>,
    /// The console that the vehicle obeys: of all connected consoles, the first that connected.
    commander: Option<ClientId>,
    began: Instant,
    /// The time at which the next tick is due.
    due: Instant,
    state_due: Instant,
    lockstep: bool,
    /// The last readings, for a console that joins.
    last: FromVehicle,
}

impl Offered {
    fn new(mut vehicle: Behind, lockstep: bool) -> Self {
        let (now, last) = (Instant::now(), vehicle.first(0.0));
        let tick = Duration::from_secs_f64(vehicle.tick_s());
        Self {
            vehicle,
            clients: BTreeMap::new(),
            commander: None,
            began: now,
            due: now + tick,
            state_due: now,
            lockstep,
            last,
        }
    }

    fn now_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    fn take(&mut self, id: ClientId, did: Did) -> anyhow::Result<()> {
        match did {
            Did::Joined(mut client) => {
                client.send(&self.vehicle.hello())?;
                if self.lockstep {
                    client.send(&self.last)?;
                }
                self.clients.insert(id, client);
                self.choose_commander();
            }
            // Over datagrams, a console that has said `bye` still counts as connected for a while.
            Did::Left | Did::Said(ToVehicle::Bye(_)) => self.part_with(id),
            // Rule 3 of the protocol: a vehicle stops on bad input.
            Did::SaidWrong(_) if self.commander == Some(id) => self.vehicle.halt(),
            Did::Said(message) if self.commander == Some(id) || matches!(message, ToVehicle::Ping(_)) => {
                let now_s = self.now_s();
                if let Some(answer) = self.vehicle.take(&message, now_s)
                    && let Some(client) = self.clients.get_mut(&id)
                {
                    client.send(&answer)?;
                }
                if self.lockstep && matches!(message, ToVehicle::Drive(_) | ToVehicle::Stop(_)) {
                    self.step()?;
                }
            }
            Did::Said(_) | Did::SaidWrong(_) => {}
        }
        Ok(())
    }

    fn part_with(&mut self, id: ClientId) {
        self.clients.remove(&id);
        if self.commander == Some(id) {
            self.vehicle.leave();
            self.commander = None;
        }
        self.choose_commander();
    }

    fn choose_commander(&mut self) {
        self.commander = self.commander.or_else(|| self.clients.keys().next().copied());
        self.state_due = Instant::now();
    }

    /// Sends the state and computes the next tick when they are due.
    fn pass_time(&mut self) -> anyhow::Result<()> {
        let now = Instant::now();
        if now >= self.state_due {
            self.state_due = now + STATE_EVERY;
            self.tell_state()?;
        }
        if now >= self.due {
            let tick = Duration::from_secs_f64(self.vehicle.tick_s());
            // After a long interruption, the simulation does not make up for lost ticks.
            self.due = if now > self.due + tick { now } else { self.due } + tick;
            if !self.lockstep {
                self.step()?;
            }
        }
        Ok(())
    }

    fn tell_state(&mut self) -> anyhow::Result<()> {
        let now_s = self.now_s();
        for (id, client) in &mut self.clients {
            let commander =
                if self.commander == Some(*id) { Commander::You } else { Commander::OtherConsole };
            client.send(&self.vehicle.state(now_s, commander))?;
        }
        Ok(())
    }

    fn step(&mut self) -> anyhow::Result<()> {
        self.last = self.vehicle.step(self.now_s());
        for client in self.clients.values_mut() {
            client
                .send(&self.last)
                .context("the simulator gave readings that the protocol does not allow")?;
        }
        Ok(())
    }
}
