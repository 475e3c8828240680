//! Finds obstacles in scans: points that neither the drawing nor the chart explains are grouped, tracked and fitted.
//!
//! The crate is pure. The same scans and poses give the same obstacles; the state does not grow with time. Poses and
//! obstacles are in the tank frame, scans in the robot frame; metres, radians, seconds.
//!
//! In each scan, the pose is first corrected by the drawing, as far as its covariance allows. The correction places the
//! obstacles. If the scanner is to locate the robot ([`Sensor::locates`]), [`Perception::matched`] is the pose that the scan
//! alone shows; otherwise scans do not change the estimated position. Points within 3 standard deviations of something on
//! the drawing are removed. The remaining points either belong to objects seen before, or form groups that begin new
//! tracks. A track that enough scans have shown is an obstacle: a disc with a centre and a radius or, if it does not
//! look like one, a convex outline that grows view by view, or a line if it is thin.
#![forbid(unsafe_code)]

mod check;
mod disc;
mod drawing;
mod drift;
mod groups;
mod layout;
mod matching;
mod outline;
mod pairs;
mod rays;
mod sensor;
mod through;
mod track;
mod tracker;
mod trouble;
mod uncertain;

pub use drift::Drift;
pub use matching::Matched;
pub use outline::change_m;
pub use sensor::Sensor;
pub use track::OUT_OF_SIGHT_S;
pub use tracker::{FIRST_ID, Looked, Perception, Seen, View};
pub use trouble::{Shown, Trouble};

#[cfg(test)]
mod tests;
