//! Entity paths of the recording.

/// The property that states how the run ended.
pub(crate) const END: &str = "__properties/end";
/// Root of the map's view.
pub(crate) const MAP: &str = "map";
/// The tank frame, flipped for the viewer.
pub(crate) const WORLD: &str = "map/world";
pub(crate) const TANK: &str = "map/world/tank";
pub(crate) const START: &str = "map/world/start";
pub(crate) const OBSTACLES_KNOWN: &str = "map/world/obstacles/known";
pub(crate) const OBSTACLES_HIDDEN: &str = "map/world/obstacles/hidden";
pub(crate) const OBSTACLES_FOUND: &str = "map/world/obstacles/found";
/// The points of the last scan, placed by the estimated pose.
pub(crate) const SCAN: &str = "map/world/scan";
pub(crate) const ZONES: &str = "map/world/zones";
pub(crate) const PLATES: &str = "map/world/plates";
pub(crate) const PLATE_NAMES: &str = "map/world/plates/names";
/// The largest missed areas, with labels, and the smaller ones, without.
pub(crate) const MISSED: &str = "map/world/missed";
pub(crate) const MISSED_MORE: &str = "map/world/missed/more";
/// The key to the colours.
pub(crate) const KEY: &str = "map/world/key";
pub(crate) const KEY_NAMES: &str = "map/world/key/names";
pub(crate) const STATIONS: &str = "map/world/ae/stations";
pub(crate) const RANGES: &str = "map/world/ae/ranges";
pub(crate) const FIX: &str = "map/world/ae/fix";
pub(crate) const PRESET: &str = "map/world/path/preset";
pub(crate) const GOAL: &str = "map/world/path/goal";
pub(crate) const PLANNED: &str = "map/world/path/planned";
/// The way of a robot that drives back by order.
pub(crate) const WAY_BACK: &str = "map/world/path/back";
pub(crate) const CUTS: &str = "map/world/path/cuts";
pub(crate) const TARGET: &str = "map/world/path/target";
pub(crate) const WAY_TRUE: &str = "map/world/way/true";
pub(crate) const WAY_ESTIMATE: &str = "map/world/way/est";
/// The true pose; everything below it moves with it.
pub(crate) const TRUE: &str = "map/world/robot/true";
pub(crate) const HEADING: &str = "map/world/robot/true/heading";
pub(crate) const HULL: &str = "map/world/robot/true/hull";
/// The scanning tool.
pub(crate) const SWATH: &str = "map/world/robot/true/swath";
/// The estimated position, rotated like its 95 % ellipse.
pub(crate) const ESTIMATE: &str = "map/world/robot/est";
/// Arrows of planners, one entity per layer below it.
pub(crate) const FORCES: &str = "map/world/forces";
/// Circles and lines of planners, one entity per layer and kind below it.
pub(crate) const DRAWN: &str = "map/world/drawn";
/// The taut cable according to the estimate, and its contacts.
pub(crate) const TETHER: &str = "map/world/tether";
pub(crate) const TETHER_ANCHOR: &str = "map/world/tether/anchor";
pub(crate) const TETHER_CABLE: &str = "map/world/tether/cable";
pub(crate) const TETHER_CONTACTS: &str = "map/world/tether/contacts";
pub(crate) const COVERAGE: &str = "map/world/coverage";
/// The map of a survey: its cells, columns and frontiers.
pub(crate) const EXPLORED: &str = "map/world/explored";
pub(crate) const COLUMNS: &str = "map/world/explored_columns";
pub(crate) const FRONTIERS: &str = "map/world/frontiers";
pub(crate) const CORROSION: &str = "map/world/corrosion";

pub(crate) const SCALARS: &str = "scalars";
pub(crate) const ERROR: &str = "scalars/position_error";
pub(crate) const ERROR_95: &str = "scalars/position_error_95";
pub(crate) const PROTECTION: &str = "scalars/protection_level";
pub(crate) const COVERED: &str = "scalars/coverage_reachable";
pub(crate) const EXPLORED_SHARE: &str = "scalars/explored";
pub(crate) const SPEED: &str = "scalars/speed";
pub(crate) const SPEED_SENT: &str = "scalars/speed_commanded";
pub(crate) const CLEARANCE: &str = "scalars/clearance";
pub(crate) const CROSS_TRACK: &str = "scalars/cross_track";
/// Residuals of the ranges, one entity per station below it.
pub(crate) const RESIDUALS: &str = "scalars/residual";
pub(crate) const FORCE_SIZES: &str = "scalars/forces";
/// Figures reported by planners, one entity per name below it.
pub(crate) const PLANNER_SCALARS: &str = "scalars/planner";

pub(crate) const TETHER_OUT: &str = "scalars/tether/out";
pub(crate) const TETHER_OUT_TRUE: &str = "scalars/tether/out_true";
pub(crate) const TETHER_HOME: &str = "scalars/tether/return_path";
pub(crate) const TETHER_WRAP: &str = "scalars/tether_wrap/largest";
pub(crate) const TETHER_SUM: &str = "scalars/tether_wrap/sum";
pub(crate) const TETHER_PULL: &str = "scalars/tether_pull/needed";
pub(crate) const TETHER_PULL_MEASURED: &str = "scalars/tether_pull/measured";
pub(crate) const TETHER_SLACK: &str = "scalars/tether/slack";

/// Lanes of the timeline of states.
pub(crate) const STATE: &str = "state";
pub(crate) const STATE_PLANNER: &str = "state/planner";
pub(crate) const STATE_MISSION: &str = "state/mission";
pub(crate) const STATE_POSITION: &str = "state/position";
/// The event log, one entity per source below it.
pub(crate) const LOG: &str = "log";
pub(crate) const SUMMARY: &str = "mission/summary";
pub(crate) const SCENARIO: &str = "mission/scenario";
