//! Fixtures shared by several tests.

use mission::PlannerInfo;

/// A planner with the id `apf` and no parameters.
pub(crate) fn info() -> PlannerInfo {
    PlannerInfo {
        id: "apf".into(),
        name: String::new(),
        version: String::new(),
        about: String::new(),
        plugin: String::new(),
        sha256: "ab".into(),
        abi: String::new(),
        covers: false,
        snapshots: true,
        sandbox: None,
        parameters: Vec::new(),
    }
}
