//! Facts of an inspection that only people know: `[inspection]` of the scenario, or of a file that is written after
//! the run.

mod dates;
mod words;

pub use dates::Date;
pub use words::{is_placeholder, says_nothing};

use serde::{Deserialize, Serialize};

/// The facts that only people know. Absent facts are printed as missing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Inspection {
    /// The client of the inspection.
    pub client: Option<String>,
    /// Site of the tank.
    pub site: Option<String>,
    /// Number of the tank.
    pub tank_id: Option<String>,
    /// Number of the drawing.
    pub drawing: Option<String>,
    /// Nominal thickness of the floor, millimetres.
    pub nominal_thickness_mm: Option<f64>,
    /// Number of the order.
    pub order: Option<String>,
    /// Inspection procedure.
    pub procedure: Option<String>,
    /// Applicable code and edition.
    pub code: Option<String>,
    /// The inspector who signs.
    pub inspector: Option<String>,
    /// Number and validity of the inspector's certificate.
    pub inspector_certificate: Option<String>,
    /// Last day on which that certificate is valid, as `2027-03-31` or `2027-03`.
    pub inspector_certificate_expires: Option<String>,
    /// The person who operated the robot.
    pub operator: Option<String>,
    /// The person who approves the report.
    pub approver: Option<String>,
    /// Make and serial number of the robot.
    pub robot: Option<String>,
    /// Method, make and serial number of the scanning instrument.
    pub instrument: Option<String>,
    /// Calibration of the instrument before the run: time, reference, result, and person.
    pub calibration_before: Option<String>,
    /// Calibration of the instrument after the run, with the same details.
    pub calibration_after: Option<String>,
    /// Survey and pulse test of the stations: time, result, and person.
    pub station_check: Option<String>,
    /// Speed of sound in metres per second, and its source: product and temperature, or a measurement.
    pub sound_speed: Option<String>,
    /// A statement that nothing was indicated, or a reference to the report of the indications.
    pub indications: Option<String>,
    /// The reason why that statement is true beside the indications that the readings show.
    pub indications_explained: Option<String>,
    /// The reason why the report is issued with losses that can go through the floor.
    pub through_accepted: Option<String>,
    /// The person who reviewed alarms, holds and faults.
    pub events_reviewed_by: Option<String>,
    /// Day of the inspection, as `2026-11-24`. Located readings need it: the names of their runs contain only the time at
    /// which the readings were located. For missions, the default is the day of the run.
    pub inspected_on: Option<String>,
    /// The reason why no coverage is stated, for readings that do not show when the tool was on.
    pub coverage_waiver: Option<String>,
    /// The reason why these facts about the floor contradict the scenario of the run.
    pub identity_corrected: Option<String>,
    /// The reason why coverage is not stated plate by plate, if the plate layout is not known.
    pub plates_waiver: Option<String>,
    /// The reason why the record of an incomplete mission is accepted.
    pub partial_scope_accepted: Option<String>,
    /// The reason why a critical zone that is not fully scanned is accepted.
    pub critical_zone_accepted: Option<String>,
    /// The reason why missed areas are accepted: left unscanned, re-scanned, or inspected by hand.
    pub missed_accepted: Option<String>,
    /// Remarks of the inspector.
    pub remarks: Option<String>,
    /// Name of the coordinate system of [`Inspection::datum_m`], such as `EPSG:25832`.
    pub datum_crs: Option<String>,
    /// Origin of the tank frame in that system, east and north, metres.
    pub datum_m: Option<[f64; 2]>,
    /// Clockwise angle from north in the system to north in the tank frame, degrees.
    pub datum_north_deg: Option<f64>,
}

impl Inspection {
    /// Merges facts from a later file; each replaces the earlier fact with the same key.
    #[must_use]
    pub fn updated(self, later: Self) -> Self {
        Self {
            client: later.client.or(self.client),
            site: later.site.or(self.site),
            tank_id: later.tank_id.or(self.tank_id),
            drawing: later.drawing.or(self.drawing),
            nominal_thickness_mm: later.nominal_thickness_mm.or(self.nominal_thickness_mm),
            order: later.order.or(self.order),
            procedure: later.procedure.or(self.procedure),
            code: later.code.or(self.code),
            inspector: later.inspector.or(self.inspector),
            inspector_certificate: later.inspector_certificate.or(self.inspector_certificate),
            inspector_certificate_expires: later
                .inspector_certificate_expires
                .or(self.inspector_certificate_expires),
            operator: later.operator.or(self.operator),
            approver: later.approver.or(self.approver),
            robot: later.robot.or(self.robot),
            instrument: later.instrument.or(self.instrument),
            calibration_before: later.calibration_before.or(self.calibration_before),
            calibration_after: later.calibration_after.or(self.calibration_after),
            station_check: later.station_check.or(self.station_check),
            sound_speed: later.sound_speed.or(self.sound_speed),
            indications: later.indications.or(self.indications),
            indications_explained: later.indications_explained.or(self.indications_explained),
            through_accepted: later.through_accepted.or(self.through_accepted),
            events_reviewed_by: later.events_reviewed_by.or(self.events_reviewed_by),
            inspected_on: later.inspected_on.or(self.inspected_on),
            coverage_waiver: later.coverage_waiver.or(self.coverage_waiver),
            identity_corrected: later.identity_corrected.or(self.identity_corrected),
            plates_waiver: later.plates_waiver.or(self.plates_waiver),
            partial_scope_accepted: later.partial_scope_accepted.or(self.partial_scope_accepted),
            critical_zone_accepted: later.critical_zone_accepted.or(self.critical_zone_accepted),
            missed_accepted: later.missed_accepted.or(self.missed_accepted),
            remarks: later.remarks.or(self.remarks),
            datum_crs: later.datum_crs.or(self.datum_crs),
            datum_m: later.datum_m.or(self.datum_m),
            datum_north_deg: later.datum_north_deg.or(self.datum_north_deg),
        }
    }
}
