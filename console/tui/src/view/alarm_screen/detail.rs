//! The details of one alarm.

use crate::guide::{guide, name};
use crate::model::alarms::State;
use crate::model::log::severity_word;
use crate::model::{Alarm, Cause};
use crate::view::fields::{self, Field};
use crate::view::look::Look;
use crate::view::text;
use positioning::Exclusion;
use ratatui::text::Line;

/// Width of the figure names, columns.
const NAMES: usize = 10;

pub(super) fn title(look: &Look, alarm: &Alarm) -> String {
    format!("{}  {}", severity_word(alarm.severity), name(&alarm.cause, look.run))
}

pub(super) fn lines(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Line<'static>> {
    fields::lines(look, &fields_of(look, alarm), NAMES, columns)
}

fn fields_of(look: &Look, alarm: &Alarm) -> Vec<Field> {
    let guide = guide(&alarm.cause);
    let mut fields: Vec<Field> = vec![("Cause", guide.cause.into()), ("Effect", guide.effect.into())];
    fields.push(("Message", message(alarm)));
    if let Some((_, text)) = &alarm.fallen {
        fields.push(("Since then", text::capitalized(text)));
    }
    fields.push(("Since", since(look, alarm)));
    if let State::Shelved(shelf) = &alarm.state {
        let until = text::clock(shelf.until_s);
        fields.push(("Shelved", format!("until T+{until}: {}", shelf.reason)));
    }
    fields.extend(alarm.place.map(|place| ("Place", text::place(place))));
    let is_acoustic = matches!(alarm.cause, Cause::PositionLost | Cause::Contradiction | Cause::Station(_));
    if is_acoustic && alarm.is_active() {
        fields.extend(residuals(look).map(|residuals| ("Residuals", residuals)));
    }
    fields
}

fn message(alarm: &Alarm) -> String {
    let text = text::capitalized(&alarm.text);
    match alarm.reading.as_ref().filter(|_| alarm.is_active()) {
        Some(reading) => format!("{text}; now {}", reading.now),
        None => text,
    }
}

fn since(look: &Look, alarm: &Alarm) -> String {
    let mut words = format!("T+{}", text::clock(alarm.since_s));
    if let Some(cleared_s) = alarm.cleared_s.filter(|_| !alarm.is_active()) {
        words = format!("{words}, cleared T+{}", text::clock(cleared_s));
    }
    if alarm.count > 1 {
        words = format!("{words}, {} times", alarm.count);
    }
    if look.run.alarms.is_first_out(alarm) {
        words = format!("{words}, first of several");
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
