//! Damaged answers and requests: read or refused; never a panic, and no memory for what a length only claims.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::answer::{Described, Refusal, Said, planners_of, said_of};
use super::body::{Body, Writer};
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

/// All kinds of answers, one after the other.
fn answers() -> Vec<u8> {
    let mut writer = Writer::default();
    let refusal = Refusal { code: -7, message: "no".into(), partial: plan().path };
    writer
        .planners(&planners())
        .said(&said())
        .plan(&plan())
        .command(Command::twist(0.1, -0.2))
        .refusal(&refusal);
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
        // No element is shorter than a byte, so nothing that was read has more elements than there were bytes.
        if let Ok(plan) = body().plan() {
            prop_assert!(plan.path.len() + plan.legs.len() + plan.cuts.len() <= most);
        }
        if let Ok(planners) = planners_of(&mut body()) {
            prop_assert!(planners.len() <= most);
        }
        if let Ok(said) = said_of(&mut body()) {
            prop_assert!(said.drawings.len() + said.scalars.len() + said.logs.len() <= most);
        }
        if let Ok(refusal) = body().refusal() {
            // A character that is not plain is shown as one of three bytes.
            prop_assert!(refusal.message.chars().count() + refusal.partial.len() <= most);
        }
        let _ = (body().command(), body().progress(), body().site(), body().request(), body().sensed());
        let _ = (body().values(), body().text(), body().points());
    }
}

#[test]
fn what_is_damaged_above_is_good_before() {
    let bytes = answers();
    let mut body = Body(&bytes);
    assert_eq!(planners_of(&mut body).unwrap(), planners());
    assert_eq!(said_of(&mut body).unwrap(), said());
    assert_eq!(body.plan().unwrap(), plan());
    assert!(body.command().is_ok() && body.refusal().is_ok());
    assert_eq!(body.end(), Ok(()));
}
