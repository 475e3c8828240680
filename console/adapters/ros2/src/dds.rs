//! The connection to the robot: ROS 2 over DDS. One thread per topic waits for messages.

mod commands;
mod joined;
mod stop;

use crate::{bridge::Input, config::Config, types::Time};
use commands::Commands;
use joined::Joined;
use std::{
    fmt::Display,
    sync::mpsc::SyncSender,
    time::{SystemTime, UNIX_EPOCH},
};
use stop::Stop;
use tankops_adapter::commands::Velocity;

/// The connection to the robot, for the shell.
pub(crate) struct Robot {
    joined: Joined,
    commands: Commands,
    stop: Option<Stop>,
}

impl Robot {
    /// Joins the domain and subscribes; messages go to `inputs`.
    ///
    /// # Errors
    /// The part that cannot be created, with the reason.
    pub(crate) fn connect(config: &Config, inputs: &SyncSender<Input>) -> Result<Self, String> {
        let mut joined = Joined::join(config)?;
        let commands = Commands::create(&mut joined, &config.command)?;
        joined.subscribe_all(config, inputs)?;
        let stop = config.stop.as_ref().map(|stop| Stop::create(&mut joined.node, stop)).transpose()?;
        Ok(Self { joined, commands, stop })
    }

    /// Publishes a command.
    ///
    /// # Errors
    /// The reason why the command was not published.
    pub(crate) fn publish(&self, velocity: Velocity) -> Result<(), String> {
        self.commands.publish(velocity)
    }

    /// Calls the stop service, if there is one.
    pub(crate) fn call_stop(&mut self) -> Option<Input> {
        self.stop.as_mut().and_then(Stop::call)
    }

    /// The inputs that must be polled: matched topics, and answers of the stop service.
    pub(crate) fn news(&mut self) -> Vec<Input> {
        let mut news = self.commands.news(&self.joined);
        news.extend(self.stop.as_mut().and_then(Stop::answer));
        news
    }
}

/// Turns an error of the middleware into a text that begins with the object concerned.
fn about<E: Display>(what: &str) -> impl Fn(E) -> String {
    move |error| format!("{what}: {error}")
}

fn wall_clock() -> Time {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Time { sec: i32::try_from(since.as_secs()).unwrap_or(i32::MAX), nanosec: since.subsec_nanos() }
}
