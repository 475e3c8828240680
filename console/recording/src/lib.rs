//! Events to a rerun recording and to the journal, and back.
