//! Events folded into the summary of a run.
