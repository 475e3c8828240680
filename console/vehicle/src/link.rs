//! The state of the link to a vehicle, from the stamps of its messages.
