//! Artificial potential field planners.
