//! Planners for the preset spiral.
