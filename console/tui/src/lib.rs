//! The console's screens: a pure model, update and view.
