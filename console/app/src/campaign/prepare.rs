//! Turns a plan into a frozen campaign; checks everything before the first mission.

use campaign::{Campaign, Plan, PlanKey, ScenarioText};
use command::here::Here;
use flight::{
    failure::bad_input,
    planners::{Found, check_choices, choice_of},
    texts,
};
use scenario::{Scenario, Settings};
use sha2::{Digest, Sha256};
use std::{collections::BTreeMap, path::Path};

/// Reads a plan and freezes it together with the texts of its scenarios.
pub(crate) fn freeze(file: &Path, here: &Here) -> anyhow::Result<Campaign> {
    let shown = file.display().to_string();
    let text = texts::read_regular(file)?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let plan = Plan::parse(&text, &shown, &name).map_err(|errors| bad_input(errors.render()))?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let scenarios = scenarios(&plan, folder)?;
    for (at, id) in plan.design.planners.iter().enumerate() {
        choice_of(id, &here.found)
            .map_err(|why| bad_input(plan.refused(PlanKey::Planner(at), &why).render()))?;
    }
    let campaign = Campaign::freeze(plan.clone(), here.program.clone(), scenarios);
    check_values(&plan, &campaign, &here.found)?;
    Ok(campaign)
}

fn scenarios(plan: &Plan, folder: &Path) -> anyhow::Result<Vec<ScenarioText>> {
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    let mut texts = Vec::new();
    for (at, written) in plan.scenarios.iter().enumerate() {
        let path = folder.join(written);
        let scenario = Scenario::read_with(&path, &Settings::default()).map_err(|errors| {
            bad_input(format!(
                "{}\n{}",
                plan.refused(PlanKey::Scenario(at), "is refused:").render(),
                errors.render()
            ))
        })?;
        let times = names.entry(scenario.name.clone()).or_default();
        *times += 1;
        let name = if *times == 1 { scenario.name } else { format!("{}-{times}", scenario.name) };
        let sha256 = hex::encode(Sha256::digest(&scenario.text));
        texts.push(ScenarioText { name, path: path.display().to_string(), text: scenario.text, sha256 });
    }
    Ok(texts)
}

/// Refuses a plan if no scenario accepts its bounds, or if every scenario refuses one of its keys: this must be a
/// typing error. A value that only some combinations refuse becomes a row of the table.
fn check_values(plan: &Plan, campaign: &Campaign, found: &Found) -> anyhow::Result<()> {
    let tried = |set: Vec<String>, planner: Option<&String>, scenario: &ScenarioText| {
        let settings = Settings { set, planner: planner.cloned(), seed: Some(campaign.design.seeds.first) };
        let scenario = Scenario::parse_with(&scenario.text, &scenario.name, &settings);
        let scenario = scenario.map_err(|errors| errors.to_string())?;
        check_choices(&scenario, found)
            .map_err(|why| why.to_string().lines().next().unwrap_or_default().to_owned())
    };
    let everywhere = |set: &Vec<String>| -> Result<(), String> {
        let planners: Vec<Option<&String>> = if plan.design.planners.is_empty() {
            vec![None]
        } else {
            plan.design.planners.iter().map(Some).collect()
        };
        let mut first = None;
        for scenario in &campaign.scenarios {
            for planner in &planners {
                match tried(set.clone(), *planner, scenario) {
                    Ok(()) => return Ok(()),
                    Err(why) => drop(first.get_or_insert(why)),
                }
            }
        }
        first.map_or(Ok(()), Err)
    };
    let bare = campaign.settings(&campaign.case(0)).set;
    let expect = bare[..plan.design.expect.len()].to_vec();
    everywhere(&expect).map_err(|why| bad_input(plan.refused(PlanKey::Expect, &why).render()))?;
    for (key, setting) in bare[plan.design.expect.len()..].iter().enumerate() {
        everywhere(&vec![setting.clone()])
            .map_err(|why| bad_input(plan.refused(PlanKey::Grid(key), &why).render()))?;
    }
    Ok(())
}
