//! Force laws shared by the potential-field planners.
