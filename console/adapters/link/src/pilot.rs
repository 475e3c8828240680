//! The part of every adapter between the console's lines and the robot's commands: introduction, lease, repetition of
//! commands, state, and the end.

use crate::{
    commands::{Commands, Heard, Velocity},
    message::{FromVehicle, Has, Hello, Mode, State},
    settings::Vehicle,
    status::Status,
};

#[cfg(test)]
mod tests;

/// An order to the adapter.
#[derive(Debug, Clone, PartialEq)]
pub enum Order {
    /// Send this message to the console.
    Say(FromVehicle),
    /// Command this velocity to the robot.
    Move(Velocity),
    /// The robot was moving and must now stand still: if the robot can be stopped in other ways, use these, too.
    Halt,
    /// Write this text to standard error.
    Note(String),
    /// End: the console has left, and zero velocity has been commanded for some time.
    End,
}

/// Longest time to wait for the robot before `hello`, seconds; the console waits for `hello` for 10 s.
const GREET_WITHIN_S: f64 = 5.0;
/// Time for which zero velocity is commanded after the console has left, seconds.
const LEAVE_AFTER_S: f64 = 0.5;

/// Keeps the lease and the other rules of the wire.
#[derive(Debug, Clone)]
pub struct Pilot {
    hello: Hello,
    commands: Commands,
    status: Status,
    period_s: f64,
    started_s: f64,
    has_greeted: bool,
    moves_s: f64,
    /// Whether the last commanded velocity had a lease.
    was_driven: bool,
    leaves_s: Option<f64>,
}

impl Pilot {
    /// Creates the pilot for a vehicle that receives a command every `period_s`.
    pub fn new(vehicle: &Vehicle, has: Has, period_s: f64, now_s: f64) -> Self {
        Self {
            hello: vehicle.hello(has),
            commands: Commands::new(vehicle.motion, vehicle.limits(), vehicle.lease_max_s),
            status: Status::default(),
            period_s,
            started_s: now_s,
            has_greeted: false,
            moves_s: now_s,
            was_driven: false,
            leaves_s: None,
        }
    }

    /// Whether the vehicle has been introduced. Before that, nothing may be sent to the console.
    pub fn has_greeted(&self) -> bool {
        self.has_greeted
    }

    /// The time at which [`Pilot::act`] must be called at the latest.
    pub fn wakes_s(&self) -> f64 {
        let lease_s = self.commands.lease_until_s().filter(|_| self.was_driven);
        lease_s.map_or(self.moves_s, |lease_s| lease_s.min(self.moves_s))
    }

    /// Takes a line from the console, or the end of the connection.
    pub fn hear(&mut self, line: Option<&str>, now_s: f64, orders: &mut Vec<Order>) {
        match line.map_or(Heard::Bye, |line| self.commands.hear(line, now_s)) {
            Heard::Drive | Heard::Stop => self.moves_s = now_s,
            Heard::Ping { stamp_s } => {
                orders.push(Order::Say(FromVehicle::Pong { echo_s: stamp_s, stamp_s: now_s }));
            }
            Heard::Bye => {
                self.commands.stand();
                self.moves_s = now_s;
                self.leaves_s.get_or_insert(now_s + LEAVE_AFTER_S);
            }
            Heard::Nothing => {}
            Heard::Bad(why) => {
                self.moves_s = now_s;
                orders.push(Order::Note(format!("stopped by a bad line: {why}")));
            }
        }
    }

    /// Carries out everything that is due. Call this after each message and at the time of [`Pilot::wakes_s`]. The robot
    /// moves only if its mode is ready.
    pub fn act(&mut self, state: State, now_s: f64, orders: &mut Vec<Order>) {
        self.greet(state.mode, now_s, orders);
        let velocity = self.commands.velocity(now_s).filter(|_| state.mode == Mode::Ready);
        let must_halt = self.was_driven && velocity.is_none();
        if must_halt || now_s >= self.moves_s {
            orders.push(Order::Move(velocity.unwrap_or(Velocity::ZERO)));
            self.moves_s = now_s + self.period_s;
            self.was_driven = velocity.is_some();
        }
        if must_halt {
            orders.push(Order::Halt);
        }
        if self.has_greeted {
            orders.extend(self.status.say(state).map(FromVehicle::State).map(Order::Say));
        }
        if self.leaves_s.is_some_and(|leaves_s| now_s >= leaves_s) {
            orders.push(Order::End);
        }
    }

    /// The introduction, once the robot can be driven, or when that takes too long.
    fn greet(&mut self, mode: Mode, now_s: f64, orders: &mut Vec<Order>) {
        let is_due = mode != Mode::Fault || now_s - self.started_s >= GREET_WITHIN_S;
        if !self.has_greeted && is_due {
            self.has_greeted = true;
            orders.push(Order::Say(FromVehicle::Hello(self.hello.clone())));
        }
    }
}
