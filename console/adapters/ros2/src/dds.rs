//! The robot's side: ROS 2 over DDS. A thread per topic waits for its messages.

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

/// The robot, as the shell sees it.
pub(crate) struct Robot {
    joined: Joined,
    commands: Commands,
    stop: Option<Stop>,
}

impl Robot {
    /// Joins the domain and subscribes; messages go to `inputs`.
    ///
    /// # Errors
    /// What cannot be created, and why.
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
    /// Why it was not published.
    pub(crate) fn publish(&self, velocity: Velocity) -> Result<(), String> {
        self.commands.publish(velocity)
    }

    /// Calls the stop service, if there is one.
    pub(crate) fn call_stop(&mut self) -> Option<Input> {
        self.stop.as_mut().and_then(Stop::call)
    }

    /// What must be asked for from time to time.
    pub(crate) fn news(&mut self) -> Vec<Input> {
        let mut news = self.commands.news(&self.joined);
        news.extend(self.stop.as_mut().and_then(Stop::answer));
        news
    }
}

/// An error of the middleware, with what it is about.
fn about<E: Display>(what: &str) -> impl Fn(E) -> String {
    move |error| format!("{what}: {error}")
}

fn wall_clock() -> Time {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Time { sec: i32::try_from(since.as_secs()).unwrap_or(i32::MAX), nanosec: since.subsec_nanos() }
}
