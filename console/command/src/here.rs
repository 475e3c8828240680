//! The program and the plugins that are here, by their digests: what they compute can be put together with what others compute.

use anyhow::{Context, anyhow};
use campaign::{Campaign, Program, table::hex};
use flight::{failure::bad_input, planners::Found};
use planner_host::{PluginDirs, Surveyor, WorkerCommand, check_limits};
use sha2::{Digest, Sha256};
use std::{fs, path::Path};

/// What flies here, found once for a process.
pub struct Here {
    /// Digests of the program and the plugins.
    pub program: Program,
    /// The planners.
    pub found: Found,
}

impl Here {
    /// Looks at the program and at every plugin.
    ///
    /// # Errors
    /// The program cannot be read, or no planner's process can be started.
    pub fn survey(plugins: &PluginDirs) -> anyhow::Result<Self> {
        check_limits(plugins).map_err(anyhow::Error::msg)?;
        let worker = WorkerCommand::default();
        let surveyor = Surveyor::new(plugins, &worker);
        let survey = surveyor.survey();
        if let Some(why) = surveyor.no_worker() {
            return Err(anyhow!("a planner plugin {why}"));
        }
        let program = std::env::current_exe().and_then(fs::read).context("reading the program itself")?;
        let sound = survey.plugins.iter().filter(|plugin| plugin.refused.is_none());
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let program = Program {
            tankops_version: env!("CARGO_PKG_VERSION").to_owned(),
            tankops_sha256: hex(&Sha256::digest(&program)),
            plugins_sha256: sound.map(|plugin| (name(&plugin.path), plugin.sha256.clone())).collect(),
        };
        Ok(Self { program, found: Found::from(&survey) })
    }

    /// Checks that a campaign was frozen with this program and these plugins.
    ///
    /// # Errors
    /// It was not; the sentence names what differs.
    pub fn check(&self, campaign: &Campaign) -> anyhow::Result<()> {
        if campaign.program == self.program {
            return Ok(());
        }
        let plugins = &self.program.plugins_sha256;
        let differs = |(name, sha256): &(&String, &String)| plugins.get(*name) != Some(*sha256);
        let other = campaign.program.plugins_sha256.iter().find(differs).map(|(name, _)| name.as_str());
        let what = match other {
            Some(plugin) => format!("plugin {plugin} is not the one"),
            None if campaign.program.tankops_sha256 != self.program.tankops_sha256 => {
                "tankops is not the one".to_owned()
            }
            None => "there are other plugins than those".to_owned(),
        };
        Err(bad_input(format!(
            "{what} that the campaign was prepared with; prepare it again, with another --out"
        )))
    }
}
