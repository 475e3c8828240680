//! The thickness of each plate.

use super::Judge;
use crate::accuracy::nearest_rank;
use serde::{Deserialize, Serialize};
use world::PlateMap;

/// The thickness of a plate where it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateThickness {
    /// Name of the plate.
    pub plate: String,
    /// Number of readings.
    pub readings: u64,
    /// The smallest thickness that a reading shows, millimetres.
    pub least_mm: f64,
    /// The thickness that 95 % of the cells exceed, taking the mean of the readings in each cell, millimetres.
    pub p5_mm: f64,
    /// Mean of all readings, millimetres.
    pub mean_mm: f64,
}

impl Judge {
    /// The thickness of each plate with readings, in the order of the plates.
    pub fn plates(&self, map: &PlateMap, cells: usize) -> Vec<PlateThickness> {
        // Hundredths of a millimetre, as positive numbers that sort.
        let mut means: Vec<Vec<u16>> = vec![Vec::new(); map.plates.len()];
        let mut sums = vec![(0_u64, 0.0, f64::INFINITY); map.plates.len()];
        for cell in 0..cells {
            let Some(((plate, mean_mm), least_mm)) =
                map.plate_of(cell).zip(self.mean_mm(cell)).zip(self.least_mm(cell))
            else {
                continue;
            };
            let count = u64::from(self.count(cell));
            means[plate].push((100.0 * mean_mm).round() as u16);
            let (readings, sum_mm, least) = &mut sums[plate];
            *readings += count;
            *sum_mm += count as f64 * mean_mm;
            *least = least.min(least_mm);
        }
        let read = map.plates.iter().zip(means).zip(sums);
        let thickness =
            |((plate, mut means), (readings, sum_mm, least_mm)): ((&world::Plate, Vec<u16>), _)| {
                means.sort_unstable();
                let p5_mm = f64::from(nearest_rank(&means, 0.05)?) / 100.0;
                let mean_mm = sum_mm / readings as f64;
                Some(PlateThickness { plate: plate.name.clone(), readings, least_mm, p5_mm, mean_mm })
            };
        read.filter_map(thickness).collect()
    }
}
