//! Reports on a small round tank.

#![allow(clippy::unwrap_used, reason = "tests")]
