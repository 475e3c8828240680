//! An adapter between the console and a robot that speaks ROS 2: `tankops run SCENARIO --vehicle "run:tankops-ros2
//! robot.toml"`. The wire is on standard input and output; `README.md` describes the settings.

mod bridge;
mod config;
mod convert;
mod dds;
mod types;

use bridge::{Bridge, Input};
use config::Config;
use dds::Robot;
use std::{
    env,
    path::PathBuf,
    process::ExitCode,
    sync::mpsc::{Receiver, SyncSender, sync_channel},
    time::{Duration, Instant},
};
use tankops_adapter::{
    console::{Speaker, listen},
    pilot::Order,
    settings::Settings,
};

/// Maximum number of messages that wait to be processed; then the threads that read messages wait, and DDS drops the
/// oldest messages.
const WAITING_MAX: usize = 256;
/// Interval at which matched topics and answers of the stop service are polled.
const NEWS_EVERY: Duration = Duration::from_millis(100);

fn main() -> ExitCode {
    let Some(path) = env::args_os().nth(1).map(PathBuf::from) else {
        note("usage: tankops-ros2 SETTINGS.toml");
        return ExitCode::from(2);
    };
    match Config::read(&path).and_then(fly) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            note(&why);
            ExitCode::FAILURE
        }
    }
}

fn fly(config: Config) -> Result<(), String> {
    let (inputs, arrived) = sync_channel(WAITING_MAX);
    listen(forward(inputs.clone()));
    let robot = Robot::connect(&config, &inputs)?;
    serve(config, robot, &arrived);
    Ok(())
}

/// Returns a function that passes the console's lines on as inputs.
fn forward(inputs: SyncSender<Input>) -> impl FnMut(Option<String>) -> bool {
    move |line| inputs.send(Input::Console(line)).is_ok()
}

/// Processes inputs until the console has left.
fn serve(config: Config, mut robot: Robot, arrived: &Receiver<Input>) {
    let started = Instant::now();
    let speaker = Speaker::start();
    let mut bridge = Bridge::new(config, 0.0);
    let mut looked: Option<Instant> = None;
    loop {
        let wait_s = (bridge.wakes_s() - started.elapsed().as_secs_f64()).max(0.0);
        let mut inputs = vec![arrived.recv_timeout(Duration::from_secs_f64(wait_s)).unwrap_or(Input::Tick)];
        if looked.is_none_or(|looked| looked.elapsed() >= NEWS_EVERY) {
            looked = Some(Instant::now());
            inputs.extend(robot.news());
        }
        // An order can cause an input: the answer of a service.
        while let Some(input) = inputs.pop() {
            for order in bridge.take(input, started.elapsed().as_secs_f64()) {
                match order {
                    Order::Say(message) => speaker.say(message),
                    Order::Move(velocity) => robot.publish(velocity).unwrap_or_else(|why| note(&why)),
                    Order::Halt => inputs.extend(robot.call_stop()),
                    Order::Note(text) => note(&text),
                    Order::End => return,
                }
            }
        }
    }
}

#[allow(clippy::print_stderr, reason = "standard error is for people")]
fn note(text: &str) {
    eprintln!("tankops-ros2: {text}");
}
