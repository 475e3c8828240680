//! The details of one alarm.

use crate::guide::{effect, meaning, name};
use crate::model::alarms::State;
use crate::model::log::severity_word;
use crate::model::{Alarm, Cause};
use crate::theme::Role;
use crate::view::fields::{self, Field};
use crate::view::look::Look;
use crate::view::text;
use positioning::Exclusion;
use ratatui::text::Line;
use world::StationId;

/// Width of the figure names, columns.
const NAMES: usize = 10;

pub(super) fn title(look: &Look, alarm: &Alarm) -> String {
    format!("{}  {}", severity_word(alarm.severity), name(&alarm.cause, look.run))
}

pub(super) fn lines(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Line<'static>> {
    fields::lines(look, &fields_of(look, alarm), NAMES, columns)
}

/// The cause of an alarm in a few lines.
pub(super) fn cause(look: &Look, alarm: &Alarm, columns: usize, rows: usize) -> Vec<Line<'static>> {
    let columns = columns.saturating_sub(2);
    let lines = text::first_lines(text::wrap(meaning(&alarm.cause, look.run).cause, columns), rows, columns);
    lines.into_iter().map(|line| look.line([(Role::Text, format!(" {line}"))])).collect()
}

fn fields_of(look: &Look, alarm: &Alarm) -> Vec<Field> {
    let guide = meaning(&alarm.cause, look.run);
    let mut fields: Vec<Field> =
        vec![("Cause", guide.cause.into()), ("Effect", look.keys(&effect(alarm, look.run)))];
    fields.push(("Message", text::capitalized(&alarm.text)));
    if let Some((_, text)) = &alarm.fallen {
        fields.push(("Then", text::capitalized(text)));
    }
    fields.extend(reading(alarm).map(|words| ("Figure", words)));
    fields.push(("Since", since(look, alarm)));
    if let Some(seen) = &alarm.acknowledged {
        fields.push(("Ack", signed(seen.by.as_deref(), &format!("at T+{}", text::clock(seen.t_s)))));
    }
    if let State::Shelved(shelf) = &alarm.state {
        let until = format!("until T+{}: {}", text::clock(shelf.until_s), shelf.reason);
        fields.push(("Shelved", signed(shelf.by.as_deref(), &until)));
    }
    fields.extend(alarm.place.map(|place| ("Place", format!("{}, at its last event", text::place(place)))));
    if let Cause::Bias(station) = &alarm.cause {
        fields.extend(in_doubt(look, *station).map(|words| ("In doubt", words)));
    }
    let is_acoustic = matches!(
        alarm.cause,
        Cause::PositionLost | Cause::Contradiction | Cause::Station(_) | Cause::Bias(_)
    );
    if is_acoustic && alarm.is_active() {
        fields.extend(residuals(look).map(|residuals| ("Residuals", residuals)));
    }
    fields
}

/// The floor that is in doubt because of a station.
fn in_doubt(look: &Look, station: StationId) -> impl Iterator<Item = String> {
    let name = look.run.station_name(station);
    let floors = look.model.live.in_doubt().into_iter();
    floors.filter(move |doubt| doubt.floor.station == name).map(|doubt| {
        let times = [doubt.floor.since_s, doubt.floor.until_s].map(text::clock);
        let at = doubt.at.map_or_else(String::new, |at| format!(", around {}", text::place(at)));
        let area_m2 = text::number(doubt.floor.area_m2, 1);
        format!("{area_m2} m², scanned T+{} to T+{}{at}", times[0], times[1])
    })
}

/// The action of a person, with the person's name if it is known.
fn signed(by: Option<&str>, what: &str) -> String {
    by.map_or_else(|| what.to_owned(), |by| format!("{what}, by {by}"))
}

/// The figure of an alarm: as it is now, its peak and the limit of the alarm.
fn reading(alarm: &Alarm) -> Option<String> {
    let reading = alarm.reading.as_ref()?;
    let now = if alarm.is_active() {
        format!("now {}", reading.now)
    } else {
        format!("now ok, last {}", reading.now)
    };
    let peak = alarm.peak.as_ref().filter(|peak| peak.now != reading.now);
    let peak = peak.map_or_else(String::new, |peak| format!(", peak {}", peak.now));
    let limit = if reading.limit.is_empty() { String::new() } else { format!(", limit {}", reading.limit) };
    Some(format!("{now}{peak}{limit}"))
}

/// The name of an alarm's figure, with its unit.
pub(super) fn figure(cause: &Cause) -> &'static str {
    match cause {
        Cause::PositionLost => "95 % error, m",
        Cause::Contradiction => "Contradiction, χ²",
        Cause::Station(_) => "Residual, m",
        Cause::Tether(word) => match word.as_str() {
            "wrap" | "total wrap" => "Wrap, °",
            "slack" => "Slack, m",
            "reel pull" => "Pull to reel in, N",
            "robot pull" => "Pull at the robot, N",
            _ => "Tether out, m",
        },
        Cause::Response => "Response, ms",
        _ => "Figure",
    }
}

fn since(look: &Look, alarm: &Alarm) -> String {
    let mut words = format!("T+{}", text::clock(alarm.since_s));
    if let Some((cleared_s, lasted_s)) = alarm.cleared_s.zip(alarm.lasted_s()) {
        let ago = text::ago(look.run.clock.t_s - cleared_s);
        let (cleared, lasted) = (text::clock(cleared_s), text::ago(lasted_s));
        words = format!("{words}, lasted {lasted}, cleared T+{cleared} ({ago} ago)");
    }
    if alarm.count > 1 {
        words = format!("{words}; {} times, first T+{}", alarm.count, text::clock(alarm.first_s));
    }
    if look.run.alarms.is_first_out(alarm) {
        words = format!("{words}; first of several");
    }
    words
}

/// The residuals of the last fix, by station.
fn residuals(look: &Look) -> Option<String> {
    let fix = look.run.position.fix.as_ref()?;
    let used =
        fix.residuals.iter().map(|residual| (residual.station, format!("{:+.2} m", residual.residual_m)));
    let rejected = fix.excluded.iter().map(|(station, why)| {
        let residual = match why {
            Exclusion::Silent => "not heard".to_owned(),
            Exclusion::ByOrder => "excluded".to_owned(),
            Exclusion::Biased { bias_m } => format!("{bias_m:+.2} m bias, not used"),
            Exclusion::Impossible { range_m, .. } => format!("{range_m:.1} m impossible"),
            Exclusion::Residual { residual_m, .. } => format!("{residual_m:+.2} m rejected"),
        };
        (*station, residual)
    });
    let words = used.chain(rejected).map(|(station, words)| {
        format!("{} {words}", look.run.station_name(station).trim_start_matches("station "))
    });
    Some(words.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figure_of_a_tether_alarm_has_the_name_of_its_quantity() {
        let named = |word: &str| figure(&Cause::Tether(word.into()));
        let [slack, reel, robot] = ["slack", "reel pull", "robot pull"].map(named);
        assert_eq!([slack, reel, robot], ["Slack, m", "Pull to reel in, N", "Pull at the robot, N"]);
        assert_eq!(["snag", "reel", "broken"].map(named), ["Tether out, m"; 3]);
        assert_eq!(["wrap", "total wrap"].map(named), ["Wrap, °"; 2]);
    }
}
