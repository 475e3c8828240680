//! The messages between the console and an adapter: one JSON object a line.
