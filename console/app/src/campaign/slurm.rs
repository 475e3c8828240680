//! Runs a campaign as a Slurm job array, one task per block.

use super::{folder::Folder, results::list};
use anyhow::{Context, bail};
use campaign::shell;
use planner_host::PluginDirs;
use std::{fs, path::PathBuf, process::Command};

/// Writes the script of the job array and returns its path.
pub(crate) fn script(
    folder: &Folder,
    name: &str,
    blocks: &[u64],
    plugins: &PluginDirs,
) -> anyhow::Result<PathBuf> {
    let folder =
        Folder::new(&fs::canonicalize(folder.path()).with_context(|| folder.path().display().to_string())?);
    fs::create_dir_all(folder.path().join("slurm")).context("creating a folder for Slurm's output")?;
    let program = std::env::current_exe().context("locating the program's own file")?;
    let quoted = |path: &std::path::Path| shell(&path.display().to_string());
    let folders = plugins.folders.iter().filter_map(|folder| fs::canonicalize(folder).ok());
    let plugin_dirs =
        folders.map(|folder| format!(" --plugin-dir {}", quoted(&folder))).collect::<Vec<_>>().concat();
    let sandbox = if plugins.requires_sandbox { " --require-sandbox" } else { "" };
    let here = folder.path();
    let text = format!(
        "#!/bin/sh\n\
         #SBATCH --job-name={}\n\
         #SBATCH --array={}\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --requeue\n\
         #SBATCH --open-mode=append\n\
         #SBATCH --output={}/slurm/%a.log\n\
         exec {} campaign work {} --block \"$SLURM_ARRAY_TASK_ID\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"{plugin_dirs}{sandbox}\n",
        name.replace(|c: char| !c.is_ascii_alphanumeric(), "-"),
        list(blocks),
        here.display(),
        quoted(&program),
        quoted(here),
    );
    folder.publish(std::path::Path::new("slurm.sh"), text.as_bytes())?;
    Ok(here.join("slurm.sh"))
}

/// Submits the script; returns the job number.
pub(crate) fn submit(script: &std::path::Path) -> anyhow::Result<String> {
    let sbatch = Command::new("sbatch").arg("--parsable").arg(script).output();
    let answer =
        sbatch.context("cannot start sbatch; use --print to write the script without submitting it")?;
    if !answer.status.success() {
        bail!("sbatch: {}", String::from_utf8_lossy(&answer.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&answer.stdout).trim().to_owned())
}
