//! Plans within other events: plans of a planner in shadow, and late plans.

use mission::{AskId, Event, EventKind};
use planner_api::{Leg, Reason};
use serde::{
    Deserialize, Deserializer,
    de::{Error, MapAccess, Visitor, value::MapAccessDeserializer},
};
use std::fmt;
use world::Point;

/// An event that contains a plan; `None` for any other event.
pub(super) fn event(line: &str) -> Option<Event> {
    #[derive(Deserialize)]
    struct Fields {
        tick: u64,
        t_s: f64,
        event: String,
        #[serde(default)]
        of: Option<Plan>,
        #[serde(default)]
        ask: Option<AskId>,
        #[serde(default)]
        plan: Option<Plan>,
    }
    let Fields { tick, t_s, event, of, ask, plan } = serde_json::from_str(line).ok()?;
    let boxed = |Plan(plan): Plan| Box::new(plan);
    let kind = match event.as_str() {
        "shadowed" => EventKind::Shadowed { of: of.map(boxed)? },
        "discarded" => EventKind::Discarded { ask: ask?, plan: plan.map(boxed) },
        _ => return None,
    };
    Some(Event { tick, t_s, kind })
}

/// A plan as an event that begins with its name.
struct Plan(EventKind);

#[derive(Deserialize)]
struct Planned {
    #[serde(default)]
    ask: Option<AskId>,
    #[serde(default)]
    return_path: usize,
    planner: String,
    reason: Reason,
    path: Vec<Point>,
    length_m: f64,
    complete: bool,
    #[serde(default)]
    legs: Vec<Leg>,
    #[serde(default)]
    cuts: Vec<Vec<Point>>,
}

impl<'de> Deserialize<'de> for Plan {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(Named)
    }
}

struct Named;

impl<'de> Visitor<'de> for Named {
    type Value = Plan;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a plan")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Plan, A::Error> {
        let is_plan =
            fields.next_entry::<String, String>()? == Some(("event".to_owned(), "planned".to_owned()));
        if !is_plan {
            return Err(A::Error::custom("no plan"));
        }
        let Planned { ask, return_path, planner, reason, path, length_m, complete, legs, cuts } =
            Planned::deserialize(MapAccessDeserializer::new(fields))?;
        Ok(Plan(EventKind::Planned {
            ask,
            return_path,
            planner,
            reason,
            path,
            length_m,
            complete,
            legs,
            cuts,
        }))
    }
}
