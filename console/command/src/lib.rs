//! Code that the command lines of `tankops` and `tankops-research` share: options, start-up and failure, system limits,
//! and folders shared by several processes.

pub mod arguments;
pub mod bar;
pub mod here;
pub mod json;
pub mod machine;
pub mod shared_folder;
pub mod start;
pub mod threads;
