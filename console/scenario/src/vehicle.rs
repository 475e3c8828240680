//! Reads the requirements of a mission for a real vehicle: `[vehicle]`. The simulator ignores this section.

use super::{problem::Complaint, section::Section};

/// The requirements of a mission for a real vehicle, and the address of its adapter.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleNeeds {
    /// The address of its adapter, used if the command line does not give one; never a command.
    pub at: Option<String>,
    /// Longest time that the vehicle may take to stop, seconds.
    pub stop_max_s: f64,
    /// Whether a vehicle without a bumper is accepted.
    pub without_contact: bool,
    /// Whether a vehicle that does not measure the tether is accepted.
    pub without_reel: bool,
    /// Whether a vehicle without ranges to the stations is accepted; its position is then dead-reckoned.
    pub without_ranges: bool,
}

/// Reads `[vehicle]`; without this section, every requirement has its default.
pub(crate) fn vehicle(root: &Section<'_>) -> Option<VehicleNeeds> {
    let section = root.table_or_empty("vehicle")?;
    let at = if section.has("at") { Some(address(&section)?) } else { None };
    Some(VehicleNeeds {
        at,
        stop_max_s: section.number("stop_max_s")?,
        without_contact: section.flag("without_contact")?,
        without_reel: section.flag("without_reel")?,
        without_ranges: section.flag("without_ranges")?,
    })
}

/// An address of a socket. A scenario must not start a command.
fn address(section: &Section<'_>) -> Option<String> {
    let at = section.text("at")?;
    let is_socket =
        ["unix:", "tcp:", "udp:"].iter().any(|kind| at.len() > kind.len() && at.starts_with(kind));
    if !is_socket {
        let wanted = "unix:PATH, tcp:HOST:PORT or udp:HOST:PORT; a command is given only on the command line \
                      (--vehicle run:COMMAND)";
        section.complain("at", Complaint::OutOfRange(wanted.to_owned()));
        return None;
    }
    Some(at)
}
