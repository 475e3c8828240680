//! A planner that misbehaves in every way the tests can think of.
