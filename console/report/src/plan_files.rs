//! A plan as files for other programs.

use crate::{
    dxf::Drawing,
    geojson::{Datum, corners, feature, outline},
    plan::Planned,
};
use serde_json::json;
use std::fmt::Write;
use world::{Point, Shape, World};

/// The layers of the drawing and their colours by the numbers of the format.
const LAYERS: [(&str, u8); 4] = [("SHELL", 7), ("OBSTACLES", 5), ("PATH", 4), ("CUTS", 1)];

impl Planned {
    /// The points of the path, one a line: number of the leg, what it is for, place, and way from the start. A point where
    /// two legs meet is there for each of them.
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

    /// Shell, obstacles, the legs of the path and the cuts as one feature collection, tank frame.
    pub fn geojson(&self, drawing: &World, facts: &crate::Inspection) -> String {
        let datum = Datum::of(facts);
        let mut features =
            vec![feature(datum.polygon(&outline(&drawing.boundary)), json!({ "layer": "shell" }))];
        features.extend(drawing.obstacles.iter().map(|obstacle| {
            let geometry = match &obstacle.shape {
                Shape::Polyline { points, .. } => datum.line(points),
                shape => datum.polygon(&corners(shape)),
            };
            feature(geometry, json!({ "layer": "obstacles", "name": obstacle.name }))
        }));
        features.extend((1..).zip(&self.legs).map(|(number, leg): (usize, _)| {
            let geometry = datum.line(&self.path[leg.first..=leg.last]);
            feature(geometry, json!({ "layer": "path", "leg": number, "tag": leg.tag }))
        }));
        features.extend(self.cuts.iter().map(|cut| feature(datum.line(cut), json!({ "layer": "cuts" }))));
        let collection = json!({
            "type": "FeatureCollection",
            "crs": { "type": "name", "properties": { "name": datum.name } },
            "properties": { "planner": self.planner, "length_m": self.length_m, "complete": self.complete },
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
        for leg in &self.legs {
            dxf.polyline("PATH", &self.path[leg.first..=leg.last], false);
        }
        for cut in &self.cuts {
            dxf.polyline("CUTS", cut, false);
        }
        dxf.finish()
    }
}
