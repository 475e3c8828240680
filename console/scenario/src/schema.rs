//! All keys of a scenario: type, unit, range and default.
//!
//! The reader checks values against these tables and compares misspelt keys with them; a test checks that they agree
//! with `docs/scenario-format.md`.

use std::fmt;

/// The range of numbers that a key accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    low: f64,
    low_is_open: bool,
    high: f64,
    /// The reason for the lower bound, if it is not obvious.
    why: Option<&'static str>,
}

/// Every number greater than `low`.
pub(crate) const fn above(low: f64) -> Span {
    Span { low, low_is_open: true, high: f64::INFINITY, why: None }
}

/// Every number that is at least `low`.
pub(crate) const fn at_least(low: f64) -> Span {
    Span { low, low_is_open: false, high: f64::INFINITY, why: None }
}

impl Span {
    /// This span with an upper bound, `high` included.
    pub(crate) const fn up_to(self, high: f64) -> Self {
        Self { high, ..self }
    }

    /// This span with the reason for its lower bound, which a message appends after a colon.
    pub(crate) const fn because(self, why: &'static str) -> Self {
        Self { why: Some(why), ..self }
    }

    /// The required range, if a number is not accepted; continues "must be".
    pub(crate) fn complaint(&self, number: f64, unit: &str) -> Option<String> {
        let gap = if unit.is_empty() { "" } else { " " };
        if self.low_is_open && number <= self.low {
            Some(format!("greater than {}{gap}{unit}", self.low))
        } else if number < self.low {
            let why = self.why.map(|why| format!(": {why}")).unwrap_or_default();
            Some(format!("at least {}{gap}{unit}{why}", self.low))
        } else if number > self.high {
            Some(format!("at most {}{gap}{unit}", self.high))
        } else {
            None
        }
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low_is_open { "> " } else { "≥ " };
        let has_low = self.low.is_finite();
        if has_low {
            write!(f, "{low}{}", self.low)?;
        }
        if self.high.is_finite() {
            write!(f, "{}≤ {}", if has_low { ", " } else { "" }, self.high)?;
        }
        Ok(())
    }
}

/// The type of a key's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// A real number; whole numbers are also accepted.
    Number(Span),
    /// A whole number in this range, bounds included.
    Whole(i64, i64),
    /// `true` or `false`.
    Flag,
    /// Any text.
    Text,
    /// Text without blanks, which can be part of file names.
    Slug,
    /// One of the given words.
    Word(&'static [&'static str]),
    /// `[x, y]`.
    Point,
    /// `[[x, y], ...]`, with at least this many points.
    Points(usize),
    /// `[a, b]`, both in the span.
    Pair(Span),
    /// `[[from, to], ...]`: time spans.
    Times,
    /// `[[west, south, east, north], ...]`, with at least one box.
    Boxes,
    /// A list of at least one text.
    Texts,
    /// A table with its own keys.
    Table(&'static [Key]),
    /// A list of tables with their own keys.
    Tables(&'static [Key]),
    /// A table with arbitrary keys and simple values.
    Free,
}

/// The value of a key that is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Default {
    /// The key is required.
    Required,
    /// No value, or a value derived from other keys; described in words.
    Absent(&'static str),
    /// A number.
    Number(f64),
    /// A whole number.
    Whole(i64),
    /// A flag.
    Flag(bool),
    /// A word.
    Word(&'static str),
}

/// One key of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Key {
    /// The name as written; ends with the unit.
    pub name: &'static str,
    /// The unit of the key's numbers; empty for dimensionless numbers.
    pub unit: &'static str,
    /// The type of its value.
    pub kind: Kind,
    /// The value if the key is not given.
    pub default: Default,
}

const fn key(name: &'static str, unit: &'static str, kind: Kind) -> Key {
    Key { name, unit, kind, default: Default::Required }
}

const fn number(name: &'static str, unit: &'static str, span: Span) -> Key {
    key(name, unit, Kind::Number(span))
}

const fn word(name: &'static str, words: &'static [&'static str]) -> Key {
    key(name, "", Kind::Word(words))
}

const fn point(name: &'static str) -> Key {
    key(name, "m", Kind::Point)
}

impl Key {
    const fn or(self, default: f64) -> Self {
        Self { default: Default::Number(default), ..self }
    }

    const fn or_none(self, instead: &'static str) -> Self {
        Self { default: Default::Absent(instead), ..self }
    }

    const fn or_word(self, default: &'static str) -> Self {
        Self { default: Default::Word(default), ..self }
    }

    const fn or_flag(self, default: bool) -> Self {
        Self { default: Default::Flag(default), ..self }
    }

    const fn or_whole(self, default: i64) -> Self {
        Self { default: Default::Whole(default), ..self }
    }
}

const LENGTH: Span = above(0.0).up_to(1000.0);
const ANGLE: Span = at_least(-360.0).up_to(360.0);
/// Coordinates of a national or global reference system, in metres; no coordinate on Earth is outside this range.
const DATUM: Span = at_least(-1e8).up_to(1e8);
const SHARE: Span = at_least(0.0).up_to(1.0);
const ANY_LENGTH: Span = at_least(0.0);
const BY_KIND: &str = "by kind";

/// The keys of the whole file.
pub(crate) static ROOT: &[Key] = &[
    key("name", "", Kind::Slug),
    key("about", "", Kind::Text).or_none("empty"),
    key("seed", "", Kind::Whole(0, i64::MAX)).or_whole(1),
    key("continues_sha256", "", Kind::Texts).or_none("no re-scan"),
    key("tank", "", Kind::Table(TANK)),
    key("obstacles", "", Kind::Tables(OBSTACLES)).or_none("none"),
    key("random_obstacles", "", Kind::Table(RANDOM_OBSTACLES)).or_none("none"),
    key("zones", "", Kind::Tables(ZONES)).or_none("none"),
    key("plates", "", Kind::Table(PLATES)).or_none("unknown"),
    key("instrument", "", Kind::Table(INSTRUMENT)).or_none("unknown"),
    key("wear", "", Kind::Table(WEAR)).or_none("unknown"),
    key("robot", "", Kind::Table(ROBOT)).or_none("defaults"),
    key("ae", "", Kind::Table(AE)),
    key("tether", "", Kind::Table(TETHER)).or_none("none"),
    key("mission", "", Kind::Table(MISSION)),
    key("planner", "", Kind::Table(PLANNER)),
    key("vehicle", "", Kind::Table(VEHICLE)).or_none("simulated"),
    key("checklist", "", Kind::Table(CHECKLIST)).or_none("nothing to tick"),
    key("expect", "", Kind::Table(EXPECT)).or_none("no bounds"),
    key("inspection", "", Kind::Table(INSPECTION)).or_none("no facts"),
];

/// The keys of a file with facts that become known only after the run.
pub(crate) static INSPECTION_FILE: &[Key] = &[key("inspection", "", Kind::Table(INSPECTION))];

const MISSING: &str = "missing";

/// The facts that only people know about an inspection.
static INSPECTION: &[Key] = &[
    key("client", "", Kind::Text).or_none(MISSING),
    key("site", "", Kind::Text).or_none(MISSING),
    key("tank_id", "", Kind::Text).or_none(MISSING),
    key("drawing", "", Kind::Text).or_none(MISSING),
    number("nominal_thickness_mm", "mm", above(0.0).up_to(100.0)).or_none(MISSING),
    key("order", "", Kind::Text).or_none(MISSING),
    key("procedure", "", Kind::Text).or_none(MISSING),
    key("code", "", Kind::Text).or_none(MISSING),
    key("inspector", "", Kind::Text).or_none(MISSING),
    key("inspector_certificate", "", Kind::Text).or_none(MISSING),
    key("inspector_certificate_expires", "", Kind::Text).or_none(MISSING),
    key("operator", "", Kind::Text).or_none(MISSING),
    key("approver", "", Kind::Text).or_none(MISSING),
    key("robot", "", Kind::Text).or_none(MISSING),
    key("instrument", "", Kind::Text).or_none(MISSING),
    key("calibration_before", "", Kind::Text).or_none(MISSING),
    key("calibration_after", "", Kind::Text).or_none(MISSING),
    key("station_check", "", Kind::Text).or_none(MISSING),
    key("sound_speed", "", Kind::Text).or_none(MISSING),
    key("indications", "", Kind::Text).or_none(MISSING),
    key("indications_explained", "", Kind::Text).or_none(MISSING),
    key("through_accepted", "", Kind::Text).or_none(MISSING),
    key("events_reviewed_by", "", Kind::Text).or_none(MISSING),
    key("inspected_on", "", Kind::Text).or_none("the day of the run"),
    key("coverage_waiver", "", Kind::Text).or_none(MISSING),
    key("identity_corrected", "", Kind::Text).or_none(MISSING),
    key("plates_waiver", "", Kind::Text).or_none(MISSING),
    key("partial_scope_accepted", "", Kind::Text).or_none(MISSING),
    key("critical_zone_accepted", "", Kind::Text).or_none(MISSING),
    key("missed_accepted", "", Kind::Text).or_none(MISSING),
    key("remarks", "", Kind::Text).or_none(MISSING),
    key("datum_crs", "", Kind::Text).or_none("none"),
    key("datum_m", "m", Kind::Pair(DATUM)).or_none("none"),
    number("datum_north_deg", "deg", ANGLE).or_none("0"),
];

static CHECKLIST: &[Key] = &[key("items", "", Kind::Texts)];

static TANK: &[Key] = &[
    number("radius_m", "m", LENGTH).or_none("this, `vertices_m` or `map`"),
    key("vertices_m", "m", Kind::Points(3)).or_none("this, `radius_m` or `map`"),
    key("map", "", Kind::Text).or_none("this, `radius_m` or `vertices_m`"),
    number("map_tolerance_m", "m", at_least(0.0).up_to(1.0)).or_none("half a cell"),
];

static PLATES: &[Key] = &[
    number("annular_width_m", "m", at_least(0.0).up_to(100.0)).or(0.6),
    key("annular_count", "", Kind::Whole(1, 1000)).or_none("one per `plate_length_m` of shell"),
    number("plate_length_m", "m", at_least(0.1).up_to(1000.0)).or(6.0),
    number("plate_width_m", "m", at_least(0.1).up_to(1000.0)).or(1.8),
    key("outlines", "", Kind::Tables(PLATE_OUTLINES)).or_none("regular layout"),
];

static PLATE_OUTLINES: &[Key] = &[key("name", "", Kind::Text), key("vertices_m", "m", Kind::Points(3))];

static INSTRUMENT: &[Key] = &[
    word("kind", &["mfl", "ut"]),
    number("dead_band_m", "m", at_least(0.0).up_to(1.0)).or(0.0),
    number("dead_square_m", "m", at_least(0.0).up_to(2.0)).or(0.0),
    key("channels", "", Kind::Whole(1, 512)).or_none("no readings"),
    number("pitch_m", "m", at_least(0.001).up_to(1.0)).or(0.005),
    number("thickness_mm", "mm", above(0.0).up_to(100.0)).or_none("for `channels`"),
    number("sigma_mm", "mm", at_least(0.0).up_to(10.0)).or(0.3),
    number("threshold", "", above(0.0).up_to(1.0)).or(0.2),
    key("dead", "", Kind::Tables(DEAD_CHANNELS)).or_none("none"),
];

static DEAD_CHANNELS: &[Key] = &[
    key("channel", "", Kind::Whole(0, 511)),
    number("from_s", "s", at_least(0.0)),
    number("to_s", "s", above(0.0)),
];

static WEAR: &[Key] = &[
    number("thickness_mm", "mm", above(0.0).up_to(100.0)),
    key("losses", "", Kind::Tables(LOSSES)).or_none("none"),
    key("random", "", Kind::Table(RANDOM_LOSSES)).or_none("none"),
];

static LOSSES: &[Key] = &[
    point("at_m"),
    number("radius_m", "m", LENGTH),
    number("depth_mm", "mm", above(0.0).up_to(100.0)),
    word("profile", &["pit", "thinning"]).or_word("pit"),
    word("side", &["top", "underside"]).or_word("underside"),
];

static RANDOM_LOSSES: &[Key] = &[
    key("count", "", Kind::Whole(0, 10_000)),
    key("radius_m", "m", Kind::Pair(LENGTH)),
    key("depth_mm", "mm", Kind::Pair(above(0.0).up_to(100.0))),
    word("side", &["top", "underside"]).or_word("underside"),
    key("seed", "", Kind::Whole(0, i64::MAX)).or_none("the scenario's `seed`"),
];

/// The kinds of outline that an obstacle or a zone can have.
pub(crate) static OUTLINES: &[&str] = &["circle", "box", "polygon", "polyline"];

static OBSTACLES: &[Key] = &[
    key("name", "", Kind::Text).or_none("`obstacle 1`, `obstacle 2`, ..."),
    word("kind", OUTLINES),
    point("center_m").or_none(BY_KIND),
    number("radius_m", "m", LENGTH).or_none(BY_KIND),
    key("size_m", "m", Kind::Pair(LENGTH)).or_none(BY_KIND),
    number("heading_deg", "deg", ANGLE).or(0.0),
    key("vertices_m", "m", Kind::Points(3)).or_none(BY_KIND),
    key("points_m", "m", Kind::Points(2)).or_none(BY_KIND),
    number("width_m", "m", LENGTH).or_none(BY_KIND),
    key("velocity_m_per_s", "m/s", Kind::Pair(at_least(-10.0).up_to(10.0))).or_none("stationary"),
    key("waypoints_m", "m", Kind::Points(1)).or_none("stationary"),
    number("speed_m_per_s", "m/s", above(0.0).up_to(10.0)).or_none("for `waypoints_m`"),
    key("known", "", Kind::Flag).or_none("`true`; `false` if it moves"),
];

static RANDOM_OBSTACLES: &[Key] = &[
    key("count", "", Kind::Whole(0, 1000)),
    key("radius_m", "m", Kind::Pair(LENGTH)),
    word("sampling", &["disk", "square"]).or_word("disk"),
    number("min_gap_m", "m", ANY_LENGTH).or(0.0),
    number("keep_clear_m", "m", ANY_LENGTH).or(0.5),
    key("known", "", Kind::Flag).or_flag(true),
    key("seed", "", Kind::Whole(0, i64::MAX)).or_none("the scenario's `seed`"),
];

static ZONES: &[Key] = &[
    key("name", "", Kind::Text).or_none("`zone 1`, `zone 2`, ..."),
    word("kind", &["no_go", "land", "underwater"]),
    word("shape", OUTLINES),
    point("center_m").or_none(BY_KIND),
    number("radius_m", "m", LENGTH).or_none(BY_KIND),
    key("size_m", "m", Kind::Pair(LENGTH)).or_none(BY_KIND),
    number("heading_deg", "deg", ANGLE).or(0.0),
    key("vertices_m", "m", Kind::Points(3)).or_none(BY_KIND),
    key("points_m", "m", Kind::Points(2)).or_none(BY_KIND),
    number("width_m", "m", LENGTH).or_none(BY_KIND),
];

static ROBOT: &[Key] = &[
    word("motion", &["point", "unicycle", "amphibious"]).or_word("unicycle"),
    number("radius_m", "m", at_least(0.0).up_to(50.0)).or(0.25),
    number("speed_max_m_per_s", "m/s", above(0.0).up_to(10.0)).or(0.4),
    number("turn_rate_max_deg_per_s", "deg/s", above(0.0).up_to(720.0)).or(60.0),
    number("land_speed_max_m_per_s", "m/s", above(0.0).up_to(10.0)).or(0.13),
    number("land_turn_rate_max_deg_per_s", "deg/s", above(0.0).up_to(720.0)).or(6.9),
    number("underwater_speed_max_m_per_s", "m/s", above(0.0).up_to(10.0)).or(0.23),
    number("underwater_turn_rate_max_deg_per_s", "deg/s", above(0.0).up_to(720.0)).or(17.8),
    key("transition_ticks", "", Kind::Whole(0, 10_000)).or_whole(20),
    number("pressure_sigma_pa", "Pa", above(0.0).up_to(1e6))
        .or_none("no sensor; the zone at the estimated position is used"),
    number("pressure_depth_m", "m", above(0.0).up_to(100.0)).or(0.3),
    number("acceleration_m_per_s2", "m/s²", above(0.0).up_to(100.0)).or(0.5),
    number("sensing_range_m", "m", above(0.0).up_to(100.0)).or(3.0),
    point("start_m").or_none("first point of the path"),
    number("start_heading_deg", "deg", ANGLE).or_none("towards the second point of the path, or the goal"),
    number("start_sigma_m", "m", at_least(0.0).up_to(10.0)).or(0.02),
    number("start_heading_sigma_deg", "deg", at_least(0.0).up_to(180.0)).or(1.0),
    number("slip_mean", "", at_least(0.0).up_to(0.9)).or(0.0),
    number("slip_sigma", "", SHARE).or(0.0),
    number("odometry_sigma_ratio", "", SHARE).or(0.02),
    number("gyro_bias_deg_per_s", "deg/s", at_least(-10.0).up_to(10.0)).or(0.0),
    key("scanner", "", Kind::Table(SCANNER)).or_none("none; the robot sees the outlines of obstacles"),
];

static SCANNER: &[Key] = &[
    key("rays", "", Kind::Whole(18, 4096)).or_whole(360),
    number("field_of_view_deg", "deg", above(0.0).up_to(360.0)).or(360.0),
    number("range_m", "m", above(0.0).up_to(60.0)).or(8.0),
    number("rate_hz", "Hz", at_least(4.0).because("the guard must not drive blind").up_to(100.0)).or(10.0),
    number("sigma_m", "m", at_least(0.0).up_to(0.5)).or(0.02),
    number("lost_share", "", at_least(0.0).up_to(0.7)).or(0.02),
    key("offset_m", "m", Kind::Pair(at_least(-10.0).up_to(10.0))).or_none("`[0, 0]`"),
    number("heading_deg", "deg", ANGLE).or(0.0),
    key("locates", "", Kind::Flag).or_flag(false),
];

static AE: &[Key] = &[
    key("stations", "", Kind::Tables(STATIONS)),
    number("period_s", "s", above(0.0).up_to(3600.0)).or(1.0),
    key("repetitions", "", Kind::Whole(1, 1000)).or_whole(20),
    key("noise", "", Kind::Table(NOISE)).or_none("`{ model = \"uniform\", ratio = 0.05 }`"),
    number("dropout_probability", "", SHARE).or(0.0),
    key("outages_s", "s", Kind::Times).or_none("none"),
    number("ping_dropout_probability", "", SHARE).or(0.0),
    number("outlier_probability", "", SHARE).or(0.0),
    number("outlier_factor", "", at_least(1.0).up_to(100.0)).or(10.0),
    number("nlos_probability", "", SHARE).or(0.0),
    number("late_ping_probability", "", SHARE).or(0.0),
    number("excess_range_mean_m", "m", above(0.0).up_to(1000.0)).or(1.0),
    word("behind_columns", &["heard", "creeping", "late", "wall-echo", "silent"]).or_word("heard"),
    number("survey_sigma_m", "m", at_least(0.0).up_to(10.0)).or(0.0),
    number("sound_speed_error_ratio", "", at_least(-0.5).up_to(0.5)).or(0.0),
    key("faults", "", Kind::Tables(FAULTS)).or_none("none"),
    word("emission_time", &["known", "unknown"]).or_word("known"),
    number("clock_offset_sigma_m", "m", at_least(0.0).up_to(20.0)).or(0.0),
    number("clock_drift_sigma_m_per_h", "m/h", at_least(0.0).up_to(10.0)).or(0.0),
    number("pulse_rest_s", "s", above(0.0).up_to(3600.0)).or_none("the stations exchange no pulses"),
    word("solver", &["linear", "weighted-linear", "nls", "bounded", "consensus"]).or_word("nls"),
    word("aggregation", &["mean", "midrange", "trimmed-mean", "posterior"]).or_word("mean"),
    key("calibrate_sound_speed", "", Kind::Flag).or_flag(false),
    number("integrity_risk", "", above(0.0).up_to(0.01)).or_none("no protection levels, or `1e-5`"),
    number("station_faults_per_hour", "", above(0.0).up_to(1.0)).or_none("no protection levels, or `1e-4`"),
    word("session_calibration", &["off", "constant", "linear"]).or_word("off"),
    key("session_fixes", "", Kind::Whole(20, 200)).or_whole(60),
    word("biased_station", &["exclude", "correct"]).or_word("exclude"),
];

static FAULTS: &[Key] = &[
    key("station", "", Kind::Text),
    number("from_s", "s", at_least(0.0)),
    number("to_s", "s", above(0.0)),
    number("excess_range_m", "m", at_least(-1000.0).up_to(1000.0)).or_none("the station is silent"),
];

/// A pull of a cable, newtons. Below it, a figure with one decimal would say nothing.
const PULL: Span = at_least(0.1).up_to(100_000.0);

static TETHER: &[Key] = &[
    point("anchor_m").or_none("start of the robot"),
    number("reel_length_m", "m", LENGTH),
    number("wrap_max_deg", "deg", above(0.0).up_to(3600.0)).or(360.0),
    number("wrap_total_max_deg", "deg", above(0.0).up_to(36_000.0)).or(720.0),
    number("friction", "", at_least(0.0).up_to(2.0)).or(0.3),
    key("allow_uncertified", "", Kind::Flag).or_flag(false),
    number("reel_pull_n", "N", PULL).or_none("the pull is not checked"),
    number("mass_kg_per_m", "kg/m", above(0.0).up_to(20.0)).or(0.1),
    number("floor_friction", "", at_least(0.0).up_to(2.0)).or(0.3),
    number("reel_speed_m_per_s", "m/s", above(0.0).up_to(10.0)).or_none("as fast as the robot"),
    number("reel_pay_out_n", "N", at_least(0.0).up_to(100_000.0)).or(0.5),
    number("robot_pull_n", "N", PULL).or_none("not compared"),
    number("pull_ratio_max", "", above(0.0).up_to(1.0)).or(0.8),
    word("model", &["taut", "physical"]).or_word("taut"),
    number("reel_fails_at_s", "s", at_least(0.0)).or_none("never"),
    number("breaks_at_s", "s", at_least(0.0)).or_none("never"),
    number("breaks_at_n", "N", PULL).or_none("never"),
];

static STATIONS: &[Key] = &[key("name", "", Kind::Text), point("at_m")];

static NOISE: &[Key] = &[
    word("model", &["none", "uniform", "triangular", "gaussian", "heavy-tailed"]),
    number("ratio", "", above(0.0).up_to(0.9)).or_none("for `uniform`, `triangular`"),
    number("sigma_ratio", "", above(0.0).up_to(0.9)).or_none("for `gaussian`, `heavy-tailed`"),
    number("jitter_m", "m", at_least(0.0).up_to(100.0)).or(0.0),
    number("resolution_m", "m", at_least(0.0).up_to(100.0)).or(0.0),
];

/// The reason for the smallest tolerance of a goal.
const TOO_NEAR: &str = "a robot that is steered once per tick cannot stop closer to a point";

static MISSION: &[Key] = &[
    word("kind", &["goto", "follow", "cover", "survey"]),
    point("goal_m").or_none("for `goto`"),
    key("spiral", "", Kind::Table(SPIRAL)).or_none("for `follow`: this or `path_m`"),
    key("path_m", "m", Kind::Points(2)).or_none("for `follow`: this or `spiral`"),
    key("boxes_m", "m", Kind::Boxes).or_none("for `cover`: all reachable floor"),
    number("tolerance_m", "m", at_least(0.01).up_to(100.0).because(TOO_NEAR)).or(0.2),
    number("tick_s", "s", at_least(0.001).up_to(10.0)).or(0.1),
    number("time_limit_s", "s", above(0.0)).or(600.0),
    number("swath_m", "m", above(0.0).up_to(100.0)).or(0.5),
    number("overlap_m", "m", at_least(0.0).up_to(100.0)).or(0.0),
    number("clearance_m", "m", at_least(0.0).up_to(100.0)).or(0.1),
    number("cell_m", "m", at_least(0.001).up_to(10.0)).or(0.05),
    number("position_limit_m", "m", above(0.0)).or(0.5),
    number("scan_position_limit_m", "m", above(0.0)).or_none("`position_limit_m`"),
    number("position_lost_hold_s", "s", at_least(0.0)).or(2.0),
    number("stuck_s", "s", above(0.0)).or(30.0),
    word("guarantee", &["ellipse", "protection"]).or_word("ellipse"),
    word("better_plan", &["offer", "take", "off"]).or_word("offer"),
];

static SPIRAL: &[Key] = &[
    number("outer_radius_m", "m", LENGTH),
    number("inner_radius_m", "m", at_least(0.0).up_to(1000.0)).or(0.1),
    number("pitch_m", "m", LENGTH),
    number("step_deg", "deg", at_least(0.01).up_to(90.0)).or(1.0),
];

static PLANNER: &[Key] = &[
    key("id", "", Kind::Slug),
    key("parameters", "", Kind::Free).or_none("planner's defaults"),
    key("fallback", "", Kind::Table(FALLBACK)).or_none("none"),
];

static FALLBACK: &[Key] =
    &[key("id", "", Kind::Slug), key("parameters", "", Kind::Free).or_none("planner's defaults")];

static VEHICLE: &[Key] = &[
    key("at", "", Kind::Text).or_none("command line"),
    number("stop_max_s", "s", above(0.0).up_to(60.0)).or(1.5),
    key("without_contact", "", Kind::Flag).or_flag(false),
    key("without_reel", "", Kind::Flag).or_flag(false),
    key("without_ranges", "", Kind::Flag).or_flag(false),
];

const NO_BOUND: &str = "no bound";

static EXPECT: &[Key] = &[
    word("outcome", &["complete", "stuck", "collision", "time_limit", "entangled", "aborted"])
        .or_none(NO_BOUND),
    key("collisions_max", "", Kind::Whole(0, i64::MAX)).or_none(NO_BOUND),
    number("clearance_min_m", "m", at_least(-1000.0)).or_none(NO_BOUND),
    number("mission_time_max_s", "s", above(0.0)).or_none(NO_BOUND),
    number("path_length_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("coverage_reachable_min", "", SHARE).or_none(NO_BOUND),
    number("coverage_truth_min", "", SHARE).or_none(NO_BOUND),
    number("coverage_whole_min", "", SHARE).or_none(NO_BOUND),
    number("explored_min", "", SHARE).or_none(NO_BOUND),
    number("overlap_max", "", at_least(0.0)).or_none(NO_BOUND),
    number("precision_min", "", SHARE).or_none(NO_BOUND),
    number("recall_min", "", SHARE).or_none(NO_BOUND),
    number("rmse_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("cross_track_rmse_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("mean_error_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("p95_error_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("in_95_ellipse_min", "", SHARE).or_none(NO_BOUND),
    number("position_lost_max_s", "s", at_least(0.0)).or_none(NO_BOUND),
    number("tether_length_max_m", "m", above(0.0)).or_none(NO_BOUND),
    number("wrap_max_deg", "deg", above(0.0)).or_none(NO_BOUND),
    number("tether_end_length_max_m", "m", at_least(0.0)).or_none(NO_BOUND),
];

/// All sections by path, beginning with the whole file, whose path is empty.
pub(crate) fn sections() -> Vec<(String, &'static [Key])> {
    let mut found = vec![(String::new(), ROOT)];
    let mut next = 0;
    while next < found.len() {
        let (path, keys) = found[next].clone();
        for key in keys {
            if let Kind::Table(inner) | Kind::Tables(inner) = key.kind {
                found.push((joined(&path, key.name), inner));
            }
        }
        next += 1;
    }
    found
}

/// The path of a key, from the path of its section and the name of the key.
pub(crate) fn joined(section: &str, key: &str) -> String {
    if section.is_empty() { key.to_owned() } else { format!("{section}.{key}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_default_lies_in_its_own_range() {
        for (path, keys) in sections() {
            for key in keys {
                let ok = match (key.default, key.kind) {
                    (Default::Number(number), Kind::Number(span)) => span.complaint(number, "").is_none(),
                    (Default::Whole(number), Kind::Whole(low, high)) => (low..=high).contains(&number),
                    (Default::Word(word), Kind::Word(words)) => words.contains(&word),
                    (Default::Flag(_), Kind::Flag) | (Default::Required | Default::Absent(_), _) => true,
                    _ => false,
                };
                assert!(ok, "{path}.{}", key.name);
            }
        }
    }

    #[test]
    fn a_key_with_a_unit_ends_in_it() {
        let suffix = |unit: &str| unit.replace("m/s²", "m_per_s2").replace('/', "_per_").to_lowercase();
        for (_, keys) in sections() {
            for key in keys.iter().filter(|key| !key.unit.is_empty()) {
                assert!(key.name.ends_with(&format!("_{}", suffix(key.unit))), "{}", key.name);
            }
        }
    }
}
