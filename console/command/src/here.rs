//! The installed program and plugins, identified by their digests. Results with equal digests can be combined.

use anyhow::{Context, anyhow};
use campaign::{Campaign, Program};
use flight::{failure::bad_input, planners::Found};
use planner_host::{PluginDirs, Surveyor, WorkerCommand, check_limits};
use sha2::{Digest, Sha256};
use std::{fs, path::Path};

/// The installed program and planners, surveyed once per process.
pub struct Here {
    /// The digests of the program and the plugins.
    pub program: Program,
    /// The available planners.
    pub found: Found,
}

impl Here {
    /// Surveys the program and every plugin.
    ///
    /// # Errors
    /// The program cannot be read, or planner processes cannot be started.
    pub fn survey(plugins: &PluginDirs) -> anyhow::Result<Self> {
        check_limits(plugins).map_err(anyhow::Error::msg)?;
        let worker = WorkerCommand::default();
        let surveyor = Surveyor::new(plugins, &worker);
        let survey = surveyor.survey();
        if let Some(why) = surveyor.no_worker() {
            return Err(anyhow!("a planner plugin {why}"));
        }
        let program = std::env::current_exe().and_then(fs::read).context("reading the program's own file")?;
        let sound = survey.plugins.iter().filter(|plugin| plugin.refused.is_none());
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let program = Program {
            tankops_version: env!("CARGO_PKG_VERSION").to_owned(),
            tankops_sha256: hex::encode(Sha256::digest(&program)),
            plugins_sha256: sound.map(|plugin| (name(&plugin.path), plugin.sha256.clone())).collect(),
        };
        Ok(Self { program, found: Found::from(&survey) })
    }

    /// Checks that a campaign was frozen with this program and these plugins.
    ///
    /// # Errors
    /// The campaign was frozen with a different program or plugins; the message names the difference.
    pub fn check(&self, campaign: &Campaign) -> anyhow::Result<()> {
        if campaign.program == self.program {
            return Ok(());
        }
        let plugins = &self.program.plugins_sha256;
        let differs = |(name, sha256): &(&String, &String)| plugins.get(*name) != Some(*sha256);
        let other = campaign.program.plugins_sha256.iter().find(differs).map(|(name, _)| name.as_str());
        let what = match other {
            Some(plugin) => format!("plugin {plugin} differs from the one"),
            None if campaign.program.tankops_sha256 != self.program.tankops_sha256 => {
                "tankops differs from the one".to_owned()
            }
            None => "the set of plugins differs from the one".to_owned(),
        };
        Err(bad_input(format!(
            "{what} that the campaign was prepared with; prepare it again with a different --out"
        )))
    }
}
