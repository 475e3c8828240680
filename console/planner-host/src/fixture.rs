//! What several tests need.

use mission::PlannerInfo;

/// A planner `apf` without parameters.
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
