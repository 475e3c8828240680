//! Tests the host with well-behaved and misbehaving plugins in real worker processes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "tests")]

mod asks;
mod attacks;
mod desk;
mod faults;
mod files;
mod in_c;
mod memory;
mod processes;
mod progress;
mod stand;
mod state;
mod waiting;
