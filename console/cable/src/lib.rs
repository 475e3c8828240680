//! A cable with weight: it lies where it was dragged, rubs on the floor and on columns, and goes slack if the reel is too
//! weak for it.
//!
//! Model: a chain of links that can fold but not stretch, from the robot to a reel at the anchor. The motion is slow, so
//! forces balance at every moment. Friction is Coulomb's, on the floor and on everything that the cable bears on. The
//! links bear only tension. Stiffness, cable on cable and the third dimension are not in the model.
//!
//! Read the files in this order: `law` (the properties of cable and reel), `surfaces` (the solid objects), `feed` (the reel), `solve` (the
//! forces of one step), `banded` (its system of equations), `chain` (the cable over time).

mod banded;
mod chain;
mod feed;
mod law;
mod solve;
mod surfaces;

pub use chain::Chain;
pub use law::Law;
pub use surfaces::Surfaces;

#[cfg(test)]
mod tests;
