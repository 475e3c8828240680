//! Location of this user's register of signatures.

use planner_host::user_folder;
use runs::Register;

/// The register of this user's signatures.
pub fn register() -> Register {
    Register::at(user_folder("XDG_STATE_HOME", ".local/state").map(|folder| folder.join("signatures")))
}
