//! What the programs `tankops` and `tankops-research` share at their command line: options, how they begin and fail, what the
//! machine must grant, folders that several processes work in.

pub mod arguments;
pub mod bar;
pub mod here;
pub mod json;
pub mod machine;
pub mod shared_folder;
pub mod start;
pub mod threads;
