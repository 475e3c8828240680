//! Acceptance tests: the built `tankops`, its plugins and its terminal, from the user's point of view.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "acceptance/account.rs"]
mod account;
#[cfg(target_os = "linux")]
#[path = "acceptance/arrivals.rs"]
mod arrivals;
#[cfg(target_os = "linux")]
#[path = "acceptance/author.rs"]
mod author;
#[path = "acceptance/bench.rs"]
mod bench;
#[cfg(unix)]
#[path = "acceptance/breach.rs"]
mod breach;
#[path = "acceptance/campaign.rs"]
mod campaign;
#[path = "acceptance/carts.rs"]
mod carts;
#[path = "acceptance/channels.rs"]
mod channels;
#[path = "acceptance/command_line.rs"]
mod command_line;
#[cfg(unix)]
#[path = "acceptance/connecting.rs"]
mod connecting;
#[cfg(unix)]
#[path = "acceptance/dead_reel.rs"]
mod dead_reel;
#[cfg(unix)]
#[path = "acceptance/engines.rs"]
mod engines;
#[path = "acceptance/faults.rs"]
mod faults;
#[cfg(target_os = "linux")]
#[path = "acceptance/foreign.rs"]
mod foreign_files;
#[cfg(target_os = "linux")]
#[path = "acceptance/hostile.rs"]
mod hostile;
#[path = "acceptance/imported.rs"]
mod imported;
#[cfg(unix)]
#[path = "acceptance/killed.rs"]
mod killed;
#[path = "acceptance/located.rs"]
mod located;
#[path = "acceptance/looking_on.rs"]
mod looking_on;
#[path = "acceptance/mapped.rs"]
mod mapped;
#[path = "acceptance/packed.rs"]
mod packed;
#[path = "acceptance/physical.rs"]
mod physical;
#[cfg(target_os = "linux")]
#[path = "acceptance/planning.rs"]
mod planning;
#[path = "acceptance/proof.rs"]
mod proof;
#[path = "acceptance/protection.rs"]
mod protection;
#[path = "acceptance/readings.rs"]
mod readings;
#[path = "acceptance/recovered.rs"]
mod recovered;
#[path = "acceptance/replay.rs"]
mod replay;
#[path = "acceptance/report.rs"]
mod report_file;
#[path = "acceptance/reproduce.rs"]
mod reproduce;
#[path = "acceptance/rerun.rs"]
mod rerun;
#[path = "acceptance/rescan.rs"]
mod rescan;
#[path = "acceptance/return_path.rs"]
mod return_path;
#[path = "acceptance/reviewing.rs"]
mod reviewing;
#[path = "acceptance/scenarios.rs"]
mod scenarios;
#[path = "acceptance/schemas.rs"]
mod schemas;
#[path = "acceptance/script.rs"]
mod script;
#[cfg(unix)]
#[path = "acceptance/session.rs"]
mod session;
#[path = "acceptance/shadow.rs"]
mod shadow;
#[path = "acceptance/shift.rs"]
mod shift;
#[path = "acceptance/signing.rs"]
mod signing;
#[cfg(target_os = "linux")]
#[path = "acceptance/slow_line.rs"]
mod slow_line;
#[cfg(target_os = "linux")]
#[path = "acceptance/slurm.rs"]
mod slurm;
#[path = "acceptance/stopping.rs"]
mod stopping;
#[cfg(unix)]
#[path = "acceptance/streaming.rs"]
mod streaming;
#[path = "acceptance/surveys.rs"]
mod surveys;
#[cfg(unix)]
#[path = "acceptance/terminal.rs"]
mod terminal;
#[cfg(target_os = "linux")]
#[path = "acceptance/vehicle.rs"]
mod vehicle;
#[cfg(target_os = "linux")]
#[path = "acceptance/vehicle_misses.rs"]
mod vehicle_misses;
