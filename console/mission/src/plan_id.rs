//! The hash by which a start order names the plan that the operator saw.

use crate::planner::{ParamValue, PlannerChoice, PlannerInfo};
use planner_api::Leg;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use sha2::{Digest, Sha256};
use std::fmt;
use world::Point;

/// SHA-256 that identifies a plan. It covers the planner with its build and parameters, and the exact path with its
/// legs and cuts.
///
/// For a planner that only steps, the path is empty, so the hash covers only the planner with its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PlanId([u8; 32]);

/// A plan as it would be run, including its return path: the plan that the operator sees.
#[derive(Debug, Clone, Copy)]
pub struct PlanSeen<'a> {
    /// The path, metres, tank frame.
    pub path: &'a [Point],
    /// The legs of the path and their purposes.
    pub legs: &'a [Leg],
    /// Lines that the tethered robot never crosses, metres, tank frame.
    pub cuts: &'a [Vec<Point>],
    /// Whether the plan achieves the whole task.
    pub complete: bool,
}

impl PlanId {
    /// Computes the hash of a planner's plan.
    pub fn of(choice: &PlannerChoice, info: &PlannerInfo, plan: PlanSeen<'_>) -> Self {
        let mut hash = Hash(Sha256::new());
        hash.text(&choice.id);
        hash.text(&info.sha256);
        hash.count(choice.parameters.len());
        for (key, value) in &choice.parameters {
            hash.text(key);
            hash.value(value);
        }
        hash.path(plan.path);
        hash.count(plan.legs.len());
        for leg in plan.legs {
            hash.text(leg.tag.word());
            hash.count(leg.first);
            hash.count(leg.last);
        }
        hash.count(plan.cuts.len());
        plan.cuts.iter().for_each(|cut| hash.path(cut));
        hash.count(usize::from(plan.complete));
        Self(hash.0.finalize().into())
    }

    /// The first eight hexadecimal digits, for display.
    pub fn short(&self) -> String {
        let first = u32::from_be_bytes([self.0[0], self.0[1], self.0[2], self.0[3]]);
        format!("{first:08x}")
    }
}

/// All hexadecimal digits.
impl fmt::Display for PlanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&hex::encode(self.0))
    }
}

impl Serialize for PlanId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for PlanId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let is_hex = text.len() == 64 && text.bytes().all(|digit| digit.is_ascii_hexdigit());
        let byte = |index: usize| u8::from_str_radix(&text[2 * index..2 * index + 2], 16).unwrap_or_default();
        if is_hex {
            Ok(Self(std::array::from_fn(byte)))
        } else {
            Err(D::Error::custom("the hash of a plan has 64 hexadecimal digits"))
        }
    }
}

/// Feeds values into the hash in such a way that different plans never feed the same bytes: everything of variable length
/// is preceded by its length.
struct Hash(Sha256);

impl Hash {
    fn count(&mut self, count: usize) {
        self.0.update((count as u64).to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.count(text.len());
        self.0.update(text.as_bytes());
    }

    fn path(&mut self, path: &[Point]) {
        self.count(path.len());
        for point in path {
            self.0.update(point.x.to_bits().to_le_bytes());
            self.0.update(point.y.to_bits().to_le_bytes());
        }
    }

    fn value(&mut self, value: &ParamValue) {
        match value {
            ParamValue::Flag(on) => self.0.update([0, u8::from(*on)]),
            ParamValue::Int(number) => {
                self.0.update([1]);
                self.0.update(number.to_le_bytes());
            }
            ParamValue::Float(number) => {
                self.0.update([2]);
                self.0.update(number.to_bits().to_le_bytes());
            }
            ParamValue::Word(word) => {
                self.0.update([3]);
                self.text(word);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::LegTag;

    fn info(sha256: &str) -> PlannerInfo {
        let json = format!(
            r#"{{"id":"a","name":"","version":"","about":"","plugin":"","sha256":"{sha256}","abi":"","parameters":[]}}"#
        );
        serde_json::from_str(&json).expect("a planner")
    }

    #[test]
    fn whatever_differs_between_two_plans_differs_in_the_hash() {
        let choice = |id: &str, gain: Option<f64>| PlannerChoice {
            id: id.into(),
            parameters: gain.map(|gain| ("gain".into(), ParamValue::Float(gain))).into_iter().collect(),
        };
        let path = [Point::new(0.0, 0.0), Point::new(1.0, 0.0)];
        let other = [Point::new(0.0, 0.0), Point::new(1.0, f64::EPSILON)];
        let (leg, cut) = (Leg { tag: LegTag::Swath, first: 0, last: 1 }, vec![path.to_vec()]);
        let plan = PlanSeen { path: &path, legs: &[], cuts: &[], complete: true };
        let none = PlanSeen { path: &[], ..plan };
        let ids = [
            PlanId::of(&choice("a", None), &info("x"), plan),
            PlanId::of(&choice("b", None), &info("x"), plan),
            PlanId::of(&choice("a", Some(1.0)), &info("x"), plan),
            PlanId::of(&choice("a", Some(2.0)), &info("x"), plan),
            PlanId::of(&choice("a", None), &info("y"), plan),
            PlanId::of(&choice("a", None), &info("x"), PlanSeen { path: &other, ..plan }),
            PlanId::of(&choice("a", None), &info("x"), PlanSeen { legs: &[leg], ..plan }),
            PlanId::of(&choice("a", None), &info("x"), PlanSeen { cuts: &cut, ..plan }),
            PlanId::of(&choice("a", None), &info("x"), PlanSeen { complete: false, ..plan }),
            // Planners that only step.
            PlanId::of(&choice("a", None), &info("x"), none),
            PlanId::of(&choice("a", Some(1.0)), &info("x"), none),
        ];
        for (index, id) in ids.iter().enumerate() {
            assert!(ids[..index].iter().all(|before| before != id), "{index}");
        }
        assert_eq!(ids[0], PlanId::of(&choice("a", None), &info("x"), plan));
    }

    #[test]
    fn it_is_written_in_hexadecimal_and_read_back() {
        let id = PlanId::of(
            &PlannerChoice::default(),
            &info("x"),
            PlanSeen { path: &[], legs: &[], cuts: &[], complete: true },
        );
        let json = serde_json::to_string(&id).expect("JSON");
        assert_eq!(json.len(), 66);
        assert!(json[1..].starts_with(&id.short()));
        assert_eq!(serde_json::from_str::<PlanId>(&json).expect("a hash"), id);
        for wrong in ["\"\"", "\"12\"", &json.replace(&id.short(), "wxyzwxyz"), "12"] {
            assert!(serde_json::from_str::<PlanId>(wrong).is_err(), "{wrong}");
        }
    }
}
