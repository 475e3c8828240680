//! The examples in `console/docs/vehicle-protocol.md` are valid, and cover all kinds of messages.

use super::{FromSession, FromVehicle, Heard, Incoming, Reader, ToSession, ToVehicle, Writer};
use serde::Serialize;
use std::collections::BTreeSet;

const DOCUMENT: &str = include_str!("../../../docs/vehicle-protocol.md");

/// The examples in one half of the document, one a line.
pub(super) fn examples(half: &str) -> Vec<&'static str> {
    let half = DOCUMENT.split("\n## ").find(|part| part.starts_with(half)).expect("a section");
    half.split("```json\n").skip(1).map(|rest| rest.split('\n').next().expect("a line")).collect()
}

/// The session that the examples to the vehicle belong to.
pub(super) fn to_session() -> ToSession {
    let mut reader = Reader::<FromVehicle>::new(FromSession::default());
    reader.read(format!("{}\n", examples("From the vehicle")[0]).as_bytes());
    ToSession::of(reader.session().hello().expect("the first example").clone())
}

fn all_are_valid<M>(half: &str, session: impl Fn() -> M::Session)
where
    M: Incoming + Serialize + std::fmt::Debug + PartialEq,
{
    let (mut reader, mut again) = (Reader::<M>::new(session()), Reader::<M>::new(session()));
    let mut writer = Writer::<M>::new(session());
    let mut kinds = BTreeSet::new();
    for example in examples(half) {
        let heard = reader.read(format!("{example}\n").as_bytes());
        let [Heard::Message(message)] = &heard[..] else { panic!("{example}: {heard:?}") };
        let mut line = Vec::new();
        writer.write(message, &mut line).expect("valid");
        assert_eq!(again.read(&line), heard);
        let value: serde_json::Value = serde_json::from_str(example).expect("JSON");
        kinds.insert(value["type"].as_str().expect("a kind").to_owned());
    }
    let known: BTreeSet<String> = M::kinds().into_iter().map(|(kind, _)| kind.to_owned()).collect();
    assert_eq!(kinds, known);
}

#[test]
fn every_example_is_a_valid_message() {
    all_are_valid::<FromVehicle>("From the vehicle", FromSession::default);
    all_are_valid::<ToVehicle>("To the vehicle", to_session);
}

#[test]
fn every_key_is_in_an_example_or_a_table() {
    for (kind, keys) in FromVehicle::kinds().into_iter().chain(ToVehicle::kinds()) {
        for key in keys {
            let is_named = DOCUMENT.contains(&format!("`{key}`")) || DOCUMENT.contains(&format!("\"{key}\""));
            assert!(is_named, "{kind}: {key}");
        }
    }
}
