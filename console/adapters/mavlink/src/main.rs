//! An adapter between the console and a rover that speaks MAVLink over UDP: `tankops run SCENARIO --vehicle
//! "run:tankops-mavlink rover.toml"`. The wire is on standard input and output; `README.md` describes the settings.

mod bridge;
mod config;
mod convert;

use bridge::{Bridge, Input, Output};
use config::Config;
use mavlink::{Connection, MavConnection, MavHeader, dialects::common::MavMessage};
use std::{
    env,
    path::PathBuf,
    process::ExitCode,
    sync::{
        Arc,
        mpsc::{Receiver, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};
use tankops_adapter::{
    console::{Speaker, listen},
    settings::Settings,
};

/// Maximum number of messages that wait to be processed; then the threads that read messages wait.
const WAITING_MAX: usize = 256;
/// Time to wait after an error of the socket; a rover that has not started yet causes such an error.
const AFTER_ERROR: Duration = Duration::from_millis(20);

fn main() -> ExitCode {
    let Some(path) = env::args_os().nth(1).map(PathBuf::from) else {
        note("usage: tankops-mavlink SETTINGS.toml");
        return ExitCode::from(2);
    };
    match Config::read(&path).and_then(drive) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            note(&why);
            ExitCode::FAILURE
        }
    }
}

fn drive(config: Config) -> Result<(), String> {
    let (inputs, arrived) = sync_channel(WAITING_MAX);
    listen(forward(inputs.clone()));
    let address = &config.connection;
    let connection =
        mavlink::connect::<MavMessage>(address).map_err(|error| format!("{address}: {error}"))?;
    let connection = Arc::new(connection);
    let reading = Arc::clone(&connection);
    thread::spawn(move || receive(&reading, &inputs));
    serve(config, &connection, &arrived);
    Ok(())
}

/// Returns a function that passes the console's lines on as inputs.
fn forward(inputs: SyncSender<Input>) -> impl FnMut(Option<String>) -> bool {
    move |line| inputs.send(Input::Console(line)).is_ok()
}

fn receive(connection: &Connection<MavMessage>, inputs: &SyncSender<Input>) {
    loop {
        match connection.recv() {
            Ok((header, message)) => {
                if inputs.send(Input::Message(header, Box::new(message))).is_err() {
                    return;
                }
            }
            Err(_) => thread::sleep(AFTER_ERROR),
        }
    }
}

/// Processes inputs until the console has left.
fn serve(config: Config, connection: &Connection<MavMessage>, arrived: &Receiver<Input>) {
    let started = Instant::now();
    let speaker = Speaker::start();
    let mut header =
        MavHeader { system_id: config.own.system.into(), component_id: config.own.component, sequence: 0 };
    let mut bridge = Bridge::new(config, 0.0);
    loop {
        let wait_s = (bridge.wakes_s() - started.elapsed().as_secs_f64()).max(0.0);
        let input = arrived.recv_timeout(Duration::from_secs_f64(wait_s)).unwrap_or(Input::Tick);
        for output in bridge.take(input, started.elapsed().as_secs_f64()) {
            match output {
                Output::Say(message) => speaker.say(message),
                Output::Send(message) => {
                    header.sequence = header.sequence.wrapping_add(1);
                    // If messages do not reach the rover, its own messages show this.
                    let _ = connection.send(&header, &message);
                }
                Output::Note(text) => note(&text),
                Output::End => return,
            }
        }
    }
}

#[allow(clippy::print_stderr, reason = "standard error is for people")]
fn note(text: &str) {
    eprintln!("tankops-mavlink: {text}");
}
