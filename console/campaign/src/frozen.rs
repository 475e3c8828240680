//! A campaign frozen before its first mission: every block is run from this frozen form alone.

use crate::{
    design::Design,
    plan::{MOST_CASES, Plan, SEEDS},
    value::Value,
};
use scenario::Settings;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::{collections::BTreeMap, ops::Range};

/// Version of the frozen format; files with any other version are refused.
const FORMAT: u32 = 2;
/// Number of missions per block if the plan does not set this number.
const BLOCK: u64 = 64;
/// Maximum number of blocks; blocks are made larger if there would be more.
const MOST_BLOCKS: u64 = 1000;

/// The program and the plugins that run the missions.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    /// Version of tankops.
    pub tankops_version: String,
    /// SHA-256 of the program, hexadecimal.
    pub tankops_sha256: String,
    /// SHA-256 of every plugin file, hexadecimal, by file name.
    pub plugins_sha256: BTreeMap<String, String>,
}

/// A scenario as it was when the campaign was frozen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScenarioText {
    /// Unique name of the scenario in the table.
    pub name: String,
    /// Path of the scenario file, used in the command that repeats a mission.
    pub path: String,
    /// Text of the scenario, with the maps included.
    pub text: String,
    /// SHA-256 of the text, hexadecimal.
    pub sha256: String,
}

/// A plan, with the texts of its scenarios and the program that runs them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Campaign {
    format: u32,
    /// The program and the plugins.
    pub program: Program,
    /// The scenarios.
    pub scenarios: Vec<ScenarioText>,
    /// The values that vary between missions, and the metrics.
    #[serde(flatten)]
    pub design: Design,
    /// Number of missions per block; not part of the table.
    block: u64,
}

/// One mission of a campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<'a> {
    /// Number of the mission, from 0.
    pub n: u64,
    /// Scenario of the mission.
    pub scenario: &'a ScenarioText,
    /// Planner of the mission; `None` for the planner named by the scenario.
    pub planner: Option<&'a str>,
    /// The values of the campaign's keys.
    pub point: &'a [Value],
    /// Seed of the mission.
    pub seed: u64,
}

impl Campaign {
    /// Freezes a plan.
    pub fn freeze(plan: Plan, program: Program, scenarios: Vec<ScenarioText>) -> Self {
        let Plan { design, block, .. } = plan;
        let mut campaign = Self { format: FORMAT, design, program, scenarios, block: 1 };
        campaign.block = block.unwrap_or(BLOCK).max(campaign.cases().div_ceil(MOST_BLOCKS));
        campaign
    }

    /// Reads a frozen campaign and checks it.
    ///
    /// # Errors
    /// The file is not a campaign, has a different format, or was changed after the campaign was frozen.
    pub fn thaw(json: &[u8]) -> Result<Self, String> {
        let no_campaign = |error| format!("is not a campaign: {error}");
        let value: serde_json::Value = serde_json::from_slice(json).map_err(no_campaign)?;
        // Checked first, because a later format may have other keys.
        if let Some(format) = value["format"].as_u64().filter(|format| *format != u64::from(FORMAT)) {
            let remedy = "prepare the campaign again, in a different folder";
            return Err(format!("has format {format}; this tankops reads format {FORMAT}: {remedy}"));
        }
        let digest = value["sha256"].as_str().unwrap_or_default().to_owned();
        let campaign: Self = serde_json::from_value(value).map_err(no_campaign)?;
        let damage = campaign
            .damage()
            .or_else(|| (campaign.digest() != digest).then(|| "its SHA-256 does not match".to_owned()));
        match damage {
            None => Ok(campaign),
            Some(what) => Err(format!("was changed or damaged: {what}; prepare the campaign again")),
        }
    }

    /// The frozen form, with the digest by which [`Self::thaw`] detects changes.
    ///
    /// # Errors
    /// None for a campaign that was frozen from a plan.
    pub fn to_json(&self) -> serde_json::Result<Vec<u8>> {
        let mut value = serde_json::to_value(self)?;
        value["sha256"] = self.digest().into();
        serde_json::to_vec_pretty(&value)
    }

    /// SHA-256 of the frozen content, hexadecimal.
    fn digest(&self) -> String {
        hex::encode(Sha256::digest(serde_json::to_vec(self).unwrap_or_default()))
    }

    /// A sign that the frozen campaign was changed or damaged, as a clause; `None` if there is none.
    fn damage(&self) -> Option<String> {
        let Design { points, keys, seeds, .. } = &self.design;
        let changed = self.scenarios.iter().find(|s| hex::encode(Sha256::digest(&s.text)) != s.sha256);
        if let Some(scenario) = changed {
            return Some(format!("the text of scenario {} does not match its SHA-256", scenario.name));
        }
        if points.iter().any(|point| point.len() != keys.len()) {
            return Some(format!("a point does not have {} values, one for each key", keys.len()));
        }
        let counts = [points.len() as u64, self.scenarios.len() as u64, seeds.count, self.block];
        let planners = self.design.planners.len().max(1) as u64;
        let cases = counts[..3].iter().fold(planners, |product, count| product.saturating_mul(*count));
        let is_possible =
            counts.iter().all(|count| *count > 0) && cases <= MOST_CASES && SEEDS.contains(&seeds.first);
        (!is_possible).then(|| "there are no missions, or more than a plan allows".to_owned())
    }

    /// Whether a different campaign runs the same missions with the same program, regardless of blocks.
    pub fn is_same(&self, other: &Self) -> bool {
        self == &Self { block: self.block, ..other.clone() }
    }

    /// Number of missions per seed.
    pub fn per_seed(&self) -> u64 {
        (self.scenarios.len() * self.design.planners.len().max(1) * self.design.points.len()) as u64
    }

    /// Number of missions.
    pub fn cases(&self) -> u64 {
        self.per_seed() * self.design.seeds.count
    }

    /// Number of blocks.
    pub fn blocks(&self) -> u64 {
        self.cases().div_ceil(self.block)
    }

    /// Numbers of the missions of a block.
    pub fn block(&self, block: u64) -> Range<u64> {
        let end = (block + 1) * self.block;
        block * self.block..end.min(self.cases())
    }

    /// Returns the mission with this number. The seeds are the outermost loop, so all blocks take about the same time,
    /// and the missions are still paired if only a part of the campaign has run.
    pub fn case(&self, n: u64) -> Case<'_> {
        let mut rest = (n % self.per_seed()) as usize;
        let mut take = |count: usize| {
            let digit = rest % count;
            rest /= count;
            digit
        };
        let point = &self.design.points[take(self.design.points.len())];
        let planner = take(self.design.planners.len().max(1));
        Case {
            n,
            scenario: &self.scenarios[take(self.scenarios.len())],
            planner: self.design.planners.get(planner).map(String::as_str),
            point,
            seed: self.design.seeds.first + n / self.per_seed(),
        }
    }

    /// Number of arms in the comparison: one for every planner at every point.
    pub(crate) fn arms(&self) -> usize {
        self.design.planners.len().max(1) * self.design.points.len()
    }

    /// Number of the arm to which a mission belongs, counted from 0.
    pub(crate) fn arm(&self, n: u64) -> usize {
        (n % self.arms() as u64) as usize
    }

    /// Name of an arm.
    pub(crate) fn arm_name(&self, arm: usize) -> String {
        let planner = self
            .design
            .planners
            .get(arm / self.design.points.len())
            .map_or("planner of the scenario", String::as_str);
        let values = self.design.keys.iter().zip(&self.design.points[arm % self.design.points.len()]);
        let last = |key: &str| key.rsplit('.').next().unwrap_or_default().to_owned();
        let set = values.map(|(key, value)| format!(" {}={value}", last(key))).collect::<Vec<_>>().concat();
        format!("{planner}{set}")
    }

    /// The settings in which a mission differs from its scenario.
    pub fn settings(&self, case: &Case<'_>) -> Settings {
        let expect = self.design.expect.iter().map(|(key, bound)| format!("expect.{key}={}", quoted(bound)));
        let set = expect.chain(self.set(case)).collect();
        Settings { set, planner: case.planner.map(str::to_owned), seed: Some(case.seed) }
    }

    fn set(&self, case: &Case<'_>) -> impl Iterator<Item = String> {
        self.design.keys.iter().zip(case.point).map(|(key, value)| format!("{key}={}", quoted(value)))
    }

    /// The command that repeats a mission.
    pub fn command(&self, case: &Case<'_>) -> String {
        let planner = case.planner.map(|id| format!(" --planner {id}")).unwrap_or_default();
        let set = self.set(case).map(|set| format!(" --set {}", shell(&set))).collect::<Vec<_>>().concat();
        format!("tankops run {}{planner}{set} --seed {}", shell(&case.scenario.path), case.seed)
    }

    /// The origin of a table, as stored in it: everything except the blocks, the scenario texts and the paths of the
    /// files.
    pub(crate) fn provenance(&self) -> String {
        let without_text =
            |s: &ScenarioText| ScenarioText { path: String::new(), text: String::new(), ..s.clone() };
        let scenarios = self.scenarios.iter().map(without_text).collect();
        let bare = Self { block: 1, scenarios, ..self.clone() };
        serde_json::to_string(&bare).expect("numbers are finite and keys are strings")
    }
}

/// Keeps the quotes of a word that could otherwise be read as a number or flag.
fn quoted(value: &Value) -> String {
    match value {
        Value::Word(word) if word.is_empty() || !word.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            format!("{word:?}")
        }
        Value::Word(word) if ["true", "false", "nan", "inf"].contains(&word.as_str()) => format!("{word:?}"),
        value => value.to_string(),
    }
}

/// A word as a POSIX shell reads it back: quoted if it contains anything but letters, digits and `-_./=,:+`.
pub fn shell(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(crate) fn campaign(plan: &str) -> Campaign {
        let plan = Plan::parse(plan, "plan.toml", "plan").expect("nothing is wrong");
        let text = |path: &String| ScenarioText {
            name: path.trim_end_matches(".toml").to_owned(),
            path: path.clone(),
            text: String::new(),
            sha256: hex::encode(Sha256::digest("")),
        };
        let scenarios = plan.scenarios.iter().map(text).collect();
        let program = Program {
            tankops_version: "1".into(),
            tankops_sha256: "cd".into(),
            plugins_sha256: BTreeMap::new(),
        };
        Campaign::freeze(plan, program, scenarios)
    }

    const PLAN: &str = "scenarios = [\"a.toml\", \"b b.toml\"]\nplanners = [\"p\", \"q\", \"r\"]\nblock = 7\n\
                        seeds = { first = 10, count = 5 }\n[grid]\nmode = [\"x\", \"1\"]\nk = [0.5, 2.0]\n";

    #[test]
    fn seeds_are_outermost_and_every_combination_comes_once_a_seed() {
        let campaign = campaign(PLAN);
        assert_eq!((campaign.per_seed(), campaign.cases(), campaign.blocks()), (24, 120, 18));
        let of = |n| campaign.command(&campaign.case(n));
        assert_eq!(of(0), "tankops run a.toml --planner p --set mode=x --set k=0.5 --seed 10");
        assert_eq!(of(119), "tankops run 'b b.toml' --planner r --set 'mode=\"1\"' --set k=2.0 --seed 14");
        let all: std::collections::BTreeSet<String> = (0..120).map(of).collect();
        assert_eq!(all.len(), 120);
    }

    #[test]
    fn what_is_frozen_thaws_and_the_blocks_are_no_part_of_where_a_table_comes_from() {
        let frozen = campaign(PLAN);
        let thawed = Campaign::thaw(&frozen.to_json().expect("written")).expect("read");
        assert_eq!(thawed, frozen);
        let other = campaign(&PLAN.replace("block = 7", "block = 50"));
        assert!(other.is_same(&frozen) && other.provenance() == frozen.provenance());
        assert!(!campaign(&PLAN.replace("count = 5", "count = 6")).is_same(&frozen));
    }

    #[test]
    fn what_was_changed_by_hand_is_refused_with_what_is_wrong() {
        let json: serde_json::Value =
            serde_json::from_slice(&campaign(PLAN).to_json().expect("written")).expect("JSON");
        let json = json.to_string();
        let refused = |from: &str, to: &str| {
            let changed = json.replace(from, to);
            assert_ne!(changed, json, "{from}");
            Campaign::thaw(changed.as_bytes()).expect_err(to)
        };
        for count in ["0", "18446744073709551615"] {
            assert!(refused("\"count\":5", &format!("\"count\":{count}")).contains("no missions, or more"));
        }
        assert!(refused("\"block\":7", "\"block\":0").contains("no missions, or more"));
        assert!(refused("\"first\":10", "\"first\":18446744073709551615").contains("no missions, or more"));
        assert!(refused("[\"x\",0.5],", "[\"x\"],").contains("does not have 2 values"));
        assert!(refused("\"text\":\"\"", "\"text\":\" \"").contains("the text of scenario a does not match"));
        assert!(refused("[\"x\",0.5]", "[\"x\",0.7]").contains("its SHA-256 does not match"));
        assert!(refused("\"first\":10", "\"first\":11").contains("its SHA-256 does not match"));
    }

    proptest! {
        #[test]
        fn damage_is_refused_or_leaves_a_campaign_that_can_be_counted(damage in mutations::mutations()) {
            let json = campaign(PLAN).to_json().expect("written");
            if let Ok(campaign) = Campaign::thaw(&mutations::mutated(&json, &damage)) {
                let last = campaign.blocks() - 1;
                let cases = campaign.block(last);
                prop_assert!(cases.start < cases.end && cases.end == campaign.cases());
                prop_assert!(!campaign.command(&campaign.case(cases.end - 1)).is_empty());
            }
        }

        #[test]
        fn blocks_hold_every_case_once(count in 1_u64..400, block in 1_u64..90) {
            let plan = format!("scenarios = [\"a.toml\"]\nseeds = {{ count = {count} }}\nblock = {block}\n");
            let campaign = campaign(&plan);
            let all: Vec<u64> = (0..campaign.blocks()).flat_map(|block| campaign.block(block)).collect();
            prop_assert_eq!(all, (0..campaign.cases()).collect::<Vec<_>>());
        }
    }
}
