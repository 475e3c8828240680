//! The console: engine, keys, signals and screen, each on its own thread. The calling thread draws.

pub mod config;

mod backlog;
mod checking;
mod combining;
mod comparing;
mod crash;
mod desk;
mod engine;
mod forecasting;
mod foreground;
mod glimpsing;
mod handover;
mod history;
mod inbox;
mod jobs;
mod line;
mod look;
mod measure;
mod pace;
mod plain;
mod promise;
mod reading;
mod rebuilt;
mod replaying;
mod screen;
mod script;
mod session;
mod typing;
mod viewing;
mod watch;

pub use foreground::take_terminal;
pub use watch::STRAY_SIGNALS;

use config::Config;
use desk::{Desk, Known, Request, Tools};
use flight::{Flight, failure::bad_input, planners, scenarios};
use foreground::Foreground;
use inbox::{Outbox, RunOutbox, inbox};
use line::Current;
use planner_host::PluginDirs;
use reading::{Frames, Reader};
use recording::{JournalError, Ticks, journal_of};
use runs::check_logs;
use scenario::{Scenario, Settings};
use screen::{Left, Screen};
use script::Script;
use session::Session;
use std::{
    io::IsTerminal,
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    process::ExitCode,
    sync::Arc,
    thread,
    time::Duration,
};
use tui::{Caps, Colours, Glyphs, Model, Msg, RunId, Source, Speed, Transport, terminal};

/// How long the screen waits for the terminal's answer about its background.
const BACKGROUND_WITHIN: Duration = Duration::from_millis(100);

/// The options for opening a console; `None` leaves the choice to `config.toml`, then to the terminal.
#[derive(Debug)]
pub struct Options {
    /// The scenario file; `None` to open the demo.
    pub scenario: Option<PathBuf>,
    /// Changes to the scenario from the command line.
    pub settings: Settings,
    /// The folder of the runs.
    pub logs: PathBuf,
    /// The initial speed of the simulation.
    pub speed: Option<Speed>,
    /// The number of colours.
    pub colours: Option<Colours>,
    /// The character set of the map and the charts.
    pub glyphs: Option<Glyphs>,
    /// The real vehicle to drive; `None` for the simulator.
    pub vehicle: Option<remote::Wanted>,
    /// How the console is operated.
    pub by: By,
    /// A run to watch instead of opening a scenario. The run is given by its folder, or by its name in `logs`.
    pub view: Option<PathBuf>,
    /// A past run to play back, instead of opening a scenario.
    pub replay: Option<Replay>,
    /// The part of the console that fails on purpose, if any.
    pub drill: Option<Drill>,
}

/// A past run to play back. The run is given by its folder, or by its name in the folder of the runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replay {
    /// The run to play back.
    pub run: PathBuf,
    /// A second run to compare with the first.
    pub with: Option<PathBuf>,
}

/// How a console is operated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum By {
    /// By a person at the terminal, with keys.
    Keys,
    /// By the commands in a file, without a terminal.
    Script(PathBuf),
    /// By commands on stdin, answered in sentences on stdout.
    Lines,
}

/// A part of the console that fails on purpose, to test that the run and the terminal survive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drill {
    /// The drawing thread panics.
    PanicScreen,
    /// The engine thread panics.
    PanicEngine,
}

/// How the console was closed.
enum Ended {
    /// By the operator or a signal.
    Left(Left),
    /// The script ended, or one of its lines failed.
    Script(Result<(), String>),
}

/// Opens the console on a scenario, or on the demo; returns when the operator leaves or the script ends.
///
/// # Errors
/// There is no terminal; the scenario, its planners, the script or the folder of the runs is refused; a thread cannot
/// be started; or the run could not be closed.
pub fn open(options: &Options, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let config = Arc::new(Config::load());
    let script = match &options.by {
        By::Script(file) => Some(Script::read(file, &config.keys)?),
        By::Keys | By::Lines => None,
    };
    if options.by == By::Keys {
        check_terminal()?;
    }
    let Options { settings, logs, drill, .. } = options;
    let speed = options.speed.unwrap_or(config.speed);
    // Survey the plugins while the scenario is read and its floor is laid out.
    let dirs = plugins.clone();
    let survey = thread::Builder::new().name("survey".into()).spawn(move || planners::found(&dirs))?;
    let opening = Opening::of(options, &config.scenarios)?;
    let found = survey.join().map_err(|_| anyhow::anyhow!("the plugin survey panicked"))?;
    let (outbox, inbox) = inbox();
    let tools = Tools {
        logs: logs.clone(),
        plugins: plugins.clone(),
        planners: Known::default(),
        outbox: outbox.clone(),
        config: Arc::clone(&config),
        vehicle: options.vehicle.clone(),
    };
    tools.planners.set(found.clone());
    let mut desk = Desk::new(tools, settings.clone(), speed, *drill);
    let run = RunId(1);
    // Open the run before the screen, so that the first frame shows the scenario and every key takes effect.
    let model = match opening {
        Opening::Mission(source, mission) => {
            let (scenario, flight) = *mission;
            desk.open(run, &scenario, flight)?;
            desk.list(&source);
            Model::opened(run, source, speed)
        }
        Opening::View(folder) => {
            viewing::begin(&folder, RunOutbox { run, outbox: outbox.clone() })?;
            Model::looking_on(run, folder.display().to_string())
        }
        Opening::Replay { run: name, with } => {
            desk.replay(run, name.clone())?;
            let mut model = Model::replaying(run, name, with.clone());
            if let Some(with) = with {
                desk.transport(&Transport::Compare(Some(with)));
            }
            desk.pace(speed);
            model.live.speed = speed;
            model
        }
    };
    outbox.send(Msg::Planners { found: found.planners, refused: found.refused });
    let current = desk.current();
    let (desk, thread) = desk.start()?;
    desk.request(Request::Look);
    rebuilt::watch(desk.clone(), plugins.clone())?;
    let mut session = Session::new(config.apply(model), inbox, (current.clone(), desk.clone()));
    if options.by == By::Keys {
        session.remember();
    }
    let ended = match script {
        Some(script) => script.run(session, &outbox, &current).map(Ended::Script),
        None if options.by == By::Lines => plain::speak(session, &outbox, &current).map(Ended::Left),
        None => {
            let caps = caps(options, &config);
            let asks = config.theme.is_none() && caps.colours != Colours::None;
            show(session, (caps, asks), logs, (outbox, current), *drill).map(Ended::Left)
        }
    };
    // Close the run cleanly, whatever happened to the screen.
    let hurry = matches!(&ended, Ok(Ended::Left(left)) if left.signal.is_some());
    desk.request(Request::Leave { hurry });
    let closed =
        thread.join().map_err(|_| anyhow::anyhow!("the desk thread, which closes the run, panicked"))?;
    let closed = closed?;
    match ended? {
        Ended::Left(left) => Ok(left.report_end(closed.as_ref())),
        Ended::Script(done) => Ok(script::report(done)),
    }
}

/// What the console opens first.
enum Opening {
    /// A new mission, with its prepared flight.
    Mission(Source, Box<(Scenario, Flight)>),
    /// A run to watch, in this folder.
    View(PathBuf),
    /// A past run to play back, and optionally a run to compare it with.
    Replay { run: String, with: Option<String> },
}

impl Opening {
    fn of(
        Options { scenario, settings, logs, view, replay, .. }: &Options,
        folders: &[PathBuf],
    ) -> anyhow::Result<Self> {
        if let Some(Replay { run, with }) = replay {
            let name = |run: &PathBuf| {
                let folder = runs::find(run, logs)?;
                check_version(&folder)?;
                anyhow::Ok(named(&folder, logs))
            };
            return Ok(Self::Replay { run: name(run)?, with: with.as_ref().map(name).transpose()? });
        }
        if let Some(run) = view {
            return Ok(Self::View(runs::find(run, logs)?));
        }
        let (source, scenario) = match scenario {
            Some(path) => (source(path, folders)?, scenarios::read(path, settings)?),
            None => (Source::Demo, scenarios::demo(settings)?),
        };
        check_logs(logs)?;
        let flight = Flight::for_operator(&scenario);
        Ok(Self::Mission(source, Box::new((scenario, flight))))
    }
}

/// The source of a scenario that was opened by its path or by its name.
fn source(path: &Path, folders: &[PathBuf]) -> anyhow::Result<Source> {
    Ok(scenarios::file_of(path)?.map_or(Source::Demo, |file| listed(&file, folders)))
}

/// A scenario file under the name that the home screen lists: in one of its folders, however the path was typed.
fn listed(path: &Path, folders: &[PathBuf]) -> Source {
    let whole = path.canonicalize().ok();
    let is_same = |listed: &PathBuf| listed.canonicalize().is_ok_and(|listed| Some(listed) == whole);
    let name = path.file_name().unwrap_or_default();
    let found = folders.iter().map(|folder| folder.join(name)).find(is_same);
    Source::File(found.as_deref().unwrap_or(path).display().to_string())
}

/// Refuses a run whose journal has a different version: a replay cannot show it.
fn check_version(folder: &Path) -> anyhow::Result<()> {
    match Ticks::open(&journal_of(folder)) {
        Err(error @ JournalError::OtherVersion { .. }) => Err(error.into()),
        _ => Ok(()),
    }
}

/// The name of a run on the screen: its name in the folder of the runs, or its path if it is elsewhere.
fn named(folder: &Path, logs: &Path) -> String {
    let name = folder.file_name().filter(|name| folder == logs.join(name).as_path());
    name.map_or_else(|| folder.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn caps(options: &Options, config: &Config) -> Caps {
    let mut caps = Caps::from_env(|name| std::env::var(name).ok());
    caps.colours = options.colours.or(config.colours).unwrap_or(caps.colours);
    caps.glyphs = options.glyphs.unwrap_or(caps.glyphs);
    caps
}

fn check_terminal() -> anyhow::Result<()> {
    if !std::io::stdout().is_terminal() || !std::io::stdin().is_terminal() {
        return Err(bad_input(
            "the console needs a terminal on stdin and stdout; without one, use `tankops run SCENARIO`, \
             --script or --plain",
        ));
    }
    if std::env::var("TERM").is_ok_and(|term| term == "dumb") {
        return Err(bad_input("the console cannot draw with TERM=dumb; use `tankops console --plain`"));
    }
    Ok(())
}

fn show(
    session: Session,
    (caps, asks_background): (Caps, bool),
    logs: &Path,
    (outbox, current): (Outbox, Current),
    drill: Option<Drill>,
) -> anyhow::Result<Left> {
    let panic_outbox = outbox.clone();
    terminal::install_panic_hook(move |thread, message| {
        let panicked = Msg::ThreadPanicked { thread: thread.into(), message: message.into() };
        panic_outbox.send_urgent(panicked);
    });
    let places = watch::SharedPlaces::default();
    let frames = Frames::default();
    let mut screen = Screen::open(caps, session, places.clone(), frames.clone(), drill)?;
    let mut reader = Reader::new(frames);
    if asks_background && let Some(background) = reader.background(BACKGROUND_WITHIN) {
        screen.suit(background);
    }
    let openers = screen.model().console.keys.line_openers();
    watch::keys(&outbox, current.clone(), reader, (places, openers))?;
    watch::sizes(&outbox)?;
    let foreground = Foreground::new();
    watch::signals(&outbox, current.clone(), foreground.clone())?;
    watch::terminal(&outbox, current.clone(), foreground)?;
    watch::disk(&outbox, logs)?;
    drop(outbox);
    let ran = catch_unwind(AssertUnwindSafe(|| screen.run()));
    ran.unwrap_or_else(|_| Err(crash::report(logs, screen.model())))
}
