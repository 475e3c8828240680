//! What only people know of an inspection: `[inspection]` of the scenario, or of a file that is written after the run.

mod dates;
mod words;

pub use dates::Date;
pub use words::{is_placeholder, says_nothing};

use serde::{Deserialize, Serialize};

/// What only people know. What is absent is printed as missing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Inspection {
    /// Who ordered the inspection.
    pub client: Option<String>,
    /// Where the tank stands.
    pub site: Option<String>,
    /// Number of the tank.
    pub tank_id: Option<String>,
    /// Number of the drawing.
    pub drawing: Option<String>,
    /// Nominal thickness of the floor, millimetres.
    pub nominal_thickness_mm: Option<f64>,
    /// Number of the order.
    pub order: Option<String>,
    /// Procedure by which the inspection is done.
    pub procedure: Option<String>,
    /// Code and edition that apply.
    pub code: Option<String>,
    /// Who inspects and signs.
    pub inspector: Option<String>,
    /// Number and validity of the inspector's certificate.
    pub inspector_certificate: Option<String>,
    /// Last day on which that certificate is valid, as `2027-03-31` or `2027-03`.
    pub inspector_certificate_expires: Option<String>,
    /// Who operated the robot.
    pub operator: Option<String>,
    /// Who approves the report.
    pub approver: Option<String>,
    /// Make and serial number of the robot.
    pub robot: Option<String>,
    /// Method, make and serial number of the scanning instrument.
    pub instrument: Option<String>,
    /// Calibration of the instrument before the run: when, on what, with what result, by whom.
    pub calibration_before: Option<String>,
    /// The same after the run.
    pub calibration_after: Option<String>,
    /// Survey and pulse test of the stations: when, result, by whom.
    pub station_check: Option<String>,
    /// Speed of sound in metres per second, and how it was determined: product and temperature, or measured.
    pub sound_speed: Option<String>,
    /// A statement that there are no indications, or where they are reported.
    pub indications: Option<String>,
    /// Who has reviewed alarms, holds and faults.
    pub events_reviewed_by: Option<String>,
    /// Day of the inspection, as `2026-11-24`, for readings that were located: the names of their runs say when that was done.
    pub inspected_on: Option<String>,
    /// Why no coverage is stated, for readings that do not say when the tool was on.
    pub coverage_waiver: Option<String>,
    /// Why the facts say something else about the floor than the scenario that was flown.
    pub identity_corrected: Option<String>,
    /// Why coverage is not stated plate by plate, if the layout of the plates is not known.
    pub plates_waiver: Option<String>,
    /// Why the record of a mission that did not end complete is accepted.
    pub partial_scope_accepted: Option<String>,
    /// Why a critical zone that is not wholly scanned is accepted.
    pub critical_zone_accepted: Option<String>,
    /// Why missed areas are accepted: left, scanned again, or inspected by hand.
    pub missed_accepted: Option<String>,
    /// Remarks of the inspector.
    pub remarks: Option<String>,
    /// Name of the coordinate system of [`Inspection::datum_m`], such as `EPSG:25832`.
    pub datum_crs: Option<String>,
    /// Where the origin of the tank frame lies in it, east and north, metres.
    pub datum_m: Option<[f64; 2]>,
    /// By how much north of the tank frame is turned clockwise from north of the system, degrees.
    pub datum_north_deg: Option<f64>,
}

impl Inspection {
    /// The facts with those of a later file in place of the same ones before.
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
