//! A plan as files for other programs.

use crate::{
    dxf::Drawing,
    geojson::{Datum, feature, outline, rounded},
    leg::Leg,
    plan::Planned,
};
use serde_json::json;
use std::fmt::Write;
use world::{Point, World};

/// The layers of the drawing and their DXF colour numbers.
const LAYERS: [(&str, u8); 4] = [("SHELL", 7), ("OBSTACLES", 5), ("PATH", 4), ("CUTS", 1)];

impl Planned {
    /// The points of the path, one per line: number of the leg, its purpose, position, and distance from the start. A
    /// point where two legs meet is listed once for each of them.
    pub fn csv(&self) -> String {
        let mut text = String::from("leg,tag,x_m,y_m,along_m\n");
        let mut along_m = vec![0.0];
        along_m.extend(self.path.windows(2).scan(0.0, |way_m, ends| {
            *way_m += (ends[1] - ends[0]).norm();
            Some(*way_m)
        }));
        for (number, leg) in (1..).zip(&self.legs) {
            let number: usize = number;
            for index in leg.first..=leg.last {
                let Point { coords: at } = self.path[index];
                let along_m = along_m[index];
                // Writing to a String cannot fail.
                let _ = writeln!(text, "{number},{},{:.4},{:.4},{along_m:.4}", leg.tag, at.x, at.y);
            }
        }
        text
    }

    /// Shell, obstacles, the legs of the path and the cuts as one feature collection in the tank frame.
    pub fn geojson(&self, drawing: &World, facts: &account::Inspection) -> String {
        let datum = Datum::of(facts);
        let mut features =
            vec![feature(datum.polygon(&outline(&drawing.boundary)), json!({ "layer": "shell" }))];
        features.extend(drawing.obstacles.iter().map(|obstacle| {
            feature(datum.shape(&obstacle.shape), json!({ "layer": "obstacles", "name": obstacle.name }))
        }));
        features.extend(self.lines().map(|(number, leg, line)| {
            feature(datum.line(line), json!({ "layer": "path", "leg": number, "tag": leg.tag }))
        }));
        features.extend(self.cuts.iter().map(|cut| feature(datum.line(cut), json!({ "layer": "cuts" }))));
        let collection = json!({
            "type": "FeatureCollection",
            "crs": datum.crs(),
            "properties": {
                "coordinates": datum.words(), "planner": self.planner, "length_m": rounded(self.length_m),
                "complete": self.complete,
            },
            "features": features,
        });
        collection.to_string() + "\n"
    }

    /// A drawing with the layers SHELL, OBSTACLES, PATH (a polyline for each leg) and CUTS.
    pub fn dxf(&self, drawing: &World) -> String {
        let mut dxf = Drawing::new(&LAYERS);
        dxf.boundary("SHELL", &drawing.boundary);
        for obstacle in &drawing.obstacles {
            dxf.shape("OBSTACLES", &obstacle.shape);
        }
        for (.., line) in self.lines() {
            dxf.polyline("PATH", line, false);
        }
        for cut in &self.cuts {
            dxf.polyline("CUTS", cut, false);
        }
        dxf.finish()
    }

    /// The legs, numbered from 1, with their lines. A leg of zero length is omitted, because other programs refuse
    /// such a line.
    fn lines(&self) -> impl Iterator<Item = (usize, &Leg, &[Point])> {
        let numbered = (1..).zip(&self.legs);
        let lines = numbered.map(|(number, leg)| (number, leg, &self.path[leg.first..=leg.last]));
        lines.filter(|(.., line)| line.iter().any(|point| *point != line[0]))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::{plan::Made, samples::round_tank};
    use planner_api::{LegTag, Plan};

    #[test]
    fn a_leg_in_one_place_is_no_line() {
        let run = round_tank(0.05);
        let path = [(0.0, 0.0), (0.0, 0.0), (1.0, 0.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let leg = |first, last| planner_api::Leg { first, last, tag: LegTag::Travel };
        let plan = Plan { path, legs: vec![leg(0, 1), leg(1, 2)], ..Plan::default() };
        let made = Made { plan, plan_time_ms: 1.0, reason: None, warnings: vec![] };
        let planned = Planned::new(&run, made);
        let numbers: Vec<usize> = planned.lines().map(|(number, ..)| number).collect();
        assert_eq!(numbers, [2]);
        let text = planned.geojson(&run.world, &account::Inspection::default());
        assert_eq!(text.matches("\"layer\":\"path\"").count(), 1, "{text}");
    }
}
