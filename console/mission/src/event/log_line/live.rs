//! The lines about a real vehicle.

use super::{LogLine, line};
use crate::event::severity::Severity;
use vehicle::port::{LinkSeen, Notice};

pub(super) fn of_link(link: &LinkSeen) -> LogLine {
    let LinkSeen { heard, missed, faulty, unmeasured_s, .. } = link;
    let unmeasured =
        if *unmeasured_s > 0.0 { format!(", motion unknown for {unmeasured_s:.2} s") } else { String::new() };
    let readings = if *heard == 1 { "reading" } else { "readings" };
    let figures = format!("{heard} {readings} arrived, {missed} missing, {faulty} faulty{unmeasured}");
    match (link.trouble(), link.state.is_heard()) {
        (None, _) => line(Severity::Info, "vehicle", format!("link up: {figures}")),
        (Some(why), true) => line(Severity::Warn, "vehicle", format!("{why} ({figures})")),
        (Some(why), false) => line(Severity::Crit, "vehicle", format!("{why} ({figures})")),
    }
}

pub(super) fn of_notice(notice: &Notice) -> LogLine {
    let (severity, text) = match notice {
        Notice::OtherVehicle { vehicle, differs } => (
            Severity::Warn,
            format!(
                "another vehicle, {}, answers on the same connection: {}",
                vehicle.name,
                differs.join(", ")
            ),
        ),
        Notice::FaultyMessages { count: 1, first, .. } => {
            (Severity::Warn, format!("1 faulty message from the vehicle was ignored: {first}"))
        }
        Notice::FaultyMessages { count, first, last } => (
            Severity::Warn,
            format!(
                "{count} faulty messages from the vehicle were ignored; the first: {first}; the last: {last}"
            ),
        ),
        Notice::ClockRate { field, rate, is_off: true } => (
            Severity::Warn,
            format!(
                "the vehicle's clock advances {rate:.3} s in each second of the console's clock (`{field}`); correct it"
            ),
        ),
        Notice::ClockRate { field, rate, is_off: false } => (
            Severity::Info,
            format!(
                "the vehicle's clock advances {rate:.3} s in each second of the console's clock again (`{field}`)"
            ),
        ),
    };
    line(severity, "vehicle", text)
}
