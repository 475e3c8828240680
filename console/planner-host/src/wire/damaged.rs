//! Tests damaged answers and requests: they are read or refused, but never cause a panic, and never reserve memory
//! merely because a length claims that it is needed.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::LONGEST;
use super::answer::{Answered, Described, GivenPlan, Planners, Refusal, Said, Sealed};
use super::body::{Body, Read, Writer, whole};
use super::request::{Call, Load, Values};
use crate::Progress;
use crate::checks::limits::Text;
use mission::ask::{PlanAsk, Site, StepAsk};
use mission::{ParamInfo, ParamKind};
use mutations::{mutated, mutations};
use nalgebra::{Point2, Vector2};
use planner_api::{Command, Drawing, Layer, Leg, LegTag, LogLevel, Plan};
use proptest::prelude::*;

fn plan() -> Plan {
    let path: Vec<_> = (0..40).map(|x| Point2::new(f64::from(x), 1.0)).collect();
    let cuts = vec![path[..3].to_vec(), Vec::new()];
    Plan { path, cost: 3.0, complete: true, legs: vec![Leg { tag: LegTag::Swath, first: 0, last: 9 }], cuts }
}

fn planners() -> Vec<Described> {
    let text = |text: &str| text.to_owned();
    let kind = ParamKind::Choice { options: vec![text("a"), text("b")], default: text("b") };
    let [key, label, unit, help, group] = ["k", "L", "m", "h", "g"].map(text);
    let parameters = vec![ParamInfo { key, label, unit, help, group, live: true, kind }];
    let [id, name, version, about] = ["x", "X", "1", "?"].map(text);
    vec![Described { id, name, version, about, caps: 9, state_version: 2, parameters }]
}

fn said() -> Said {
    let arrow = Drawing::Arrow { layer: Layer::Tether, at: Point2::origin(), vector: Vector2::new(3.0, 4.0) };
    let logs = vec![(LogLevel::Warn, "narrow".into())];
    Said { drawings: vec![arrow; 9], scalars: vec![("u".into(), 1.5, "J".into())], logs }
}

fn refusal() -> Refusal {
    Refusal { code: -7, message: "no".into(), partial: plan().path }
}

/// One answer of every kind, in a sequence.
fn answers() -> Vec<u8> {
    let mut writer = Writer::default();
    writer.put(&Planners(planners())).put(&Answered { given: GivenPlan(plan()), said: said() });
    writer.put(&Answered { given: Command::twist(0.1, -0.2), said: said() }).put(&refusal());
    writer.into_bytes()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn damaged_bytes_are_read_or_refused_by_every_reader(
        damage in mutations(),
        skipped in any::<prop::sample::Index>(),
    ) {
        let bytes = mutated(&answers(), &damage);
        let bytes = &bytes[skipped.index(bytes.len() + 1)..];
        let most = bytes.len();
        let body = || Body(bytes);
        // Every element takes up at least one byte, so nothing that was read has more elements than there were bytes.
        if let Ok(Answered { given: GivenPlan(plan), said }) = body().take::<Answered<GivenPlan>>() {
            prop_assert!(plan.path.len() + plan.legs.len() + plan.cuts.len() <= most);
            prop_assert!(said.drawings.len() + said.scalars.len() + said.logs.len() <= most);
        }
        if let Ok(Planners(planners)) = body().take() {
            prop_assert!(planners.len() <= most);
        }
        if let Ok(Answered { said, .. }) = body().take::<Answered<()>>() {
            prop_assert!(said.drawings.len() + said.scalars.len() + said.logs.len() <= most);
        }
        if let Ok(Refusal { message, partial, .. }) = body().take() {
            // A character that is not plain is replaced by a character of three bytes.
            prop_assert!(message.chars().count() + partial.len() <= most);
        }
        let _ = (body().take::<Answered<Command>>(), body().take::<Progress>(), body().take::<Sealed>());
        let _ = (body().take::<Site>(), body().take::<Call<PlanAsk>>(), body().take::<Call<StepAsk>>());
        let _ = (body().take::<Values>(), body().take::<Text>(), Load::read(body()));
    }
}

#[test]
fn what_is_damaged_above_is_good_before() {
    let bytes = answers();
    let mut body = Body(&bytes);
    assert_eq!(body.take(), Ok(Planners(planners())));
    assert_eq!(body.take(), Ok(Answered { given: GivenPlan(plan()), said: said() }));
    assert_eq!(body.take(), Ok(Answered { given: Command::twist(0.1, -0.2), said: said() }));
    assert_eq!(body.take(), Ok(refusal()));
    assert!(body.0.is_empty());
}

/// A frame of maximum length that begins with the largest counts that its first bytes can claim, followed by the
/// shortest possible elements. A list without a limit would need many times that length in memory.
#[test]
fn a_list_of_the_shortest_elements_ends_at_its_limit() {
    fn is_refused<T: serde::de::DeserializeOwned>(before: &[u8]) -> bool {
        let count = [0xff, 0xff, 0xff, 0x7f];
        let bytes = [before, &count, &vec![0; LONGEST]].concat();
        let read: Read<T> = whole(Body(&bytes));
        let claimed: Read<T> = whole(Body(&bytes[..before.len() + count.len()]));
        read.is_err() && claimed.is_err()
    }
    // Planners, and the parameters of one of them.
    assert!(is_refused::<Planners>(&[]) && is_refused::<Planners>(&[1, 1, b'x', 0, 0, 0, 0, 0]));
    // The words of a parameter, after five texts and the number of its kind.
    assert!(is_refused::<Planners>(&[1, 1, b'x', 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 3]));
    // Legs and cuts of a plan, after a path without points, its cost, and the flag for an incomplete plan.
    assert!(is_refused::<Answered<GivenPlan>>(&[0; 10]) && is_refused::<Answered<GivenPlan>>(&[0; 11]));
    // Drawings, figures and messages.
    assert!((0..3).all(|n| is_refused::<Answered<()>>(&[0; 3][..n])));
}
