//! The cells that the maps show.

use crate::drawing::{frame::Fixtures, plates::PlateLines};
use account::{Evidence, Judge, Scanned, plate_map, together};
use mission::{RunOpened, TaskConfig};
use world::{Floor, FloorClass, Plate, PlateMap, Point, ShellStretch};

/// Smallest missed area with a number, square metres.
const LEAST_M2: f64 = 0.01;

/// The floor of a report.
pub(crate) struct Layers<'a> {
    /// The last run, as it was opened.
    pub(crate) run: &'a RunOpened,
    /// The cells that were scanned.
    pub(crate) scanned: &'a Scanned,
    evidence: &'a Evidence,
    /// The plates, if their layout is known.
    pub(crate) plates: Option<PlateLines>,
    /// The listed missed areas, the largest first: a position in each, and its cells.
    pub(crate) gaps: Vec<(Point, Vec<usize>)>,
    plate_map: Option<PlateMap>,
    /// Whether scanning was the task of the runs.
    pub(crate) is_to_scan: bool,
    /// The class of each cell.
    classes: Vec<FloorClass>,
}

impl<'a> Layers<'a> {
    /// Builds the layers of the floor that the runs scanned; `places` are the positions of the listed missed areas, in
    /// order.
    pub(crate) fn new(
        run: &'a RunOpened,
        scanned: &'a Scanned,
        evidence: &'a Evidence,
        places: &[Point],
    ) -> Self {
        let floor = scanned.believed().floor();
        let map = plate_map(run, floor);
        let plates = run
            .plates
            .as_ref()
            .zip(map.as_ref())
            .map(|(layout, map)| PlateLines::new(layout, &run.world.boundary, floor, map));
        let classes = (0..floor.len()).map(|cell| scanned.class(cell).when_over()).collect();
        let (gaps, plate_map) = (Vec::new(), map);
        let is_to_scan = true;
        let mut layers = Self { run, scanned, evidence, plates, gaps, plate_map, is_to_scan, classes };
        layers.gaps = layers.gaps_at(places);
        layers
    }

    /// Sets whether scanning was the task, and returns the layers. If scanning was not the task, no floor counts as
    /// missed or unreachable.
    pub(super) fn of_scan(mut self, is_to_scan: bool) -> Self {
        self.is_to_scan = is_to_scan;
        if !is_to_scan {
            self.gaps.clear();
            for class in self.classes.iter_mut().filter(|class| !class.is_scanned()) {
                *class = FloorClass::Outside;
            }
        }
        self
    }

    fn gaps_at(&self, places: &[Point]) -> Vec<(Point, Vec<usize>)> {
        let floor = self.floor();
        let missed = (0..floor.len()).filter(|cell| self.is(*cell, FloorClass::Missed));
        let is_listed = |cells: &Vec<usize>| cells.len() as f64 * floor.cell_m2() >= LEAST_M2;
        let mut groups: Vec<Vec<usize>> = together(floor, missed).into_iter().filter(is_listed).collect();
        for cells in &mut groups {
            cells.sort_unstable();
        }
        let cells_of = |place: &Point| {
            let cell = floor.cell_at(*place)?;
            let group = groups.iter().find(|cells| cells.binary_search(&cell).is_ok())?;
            Some((*place, group.clone()))
        };
        places.iter().filter_map(cells_of).collect()
    }

    /// The floor.
    pub(crate) fn floor(&self) -> &'a Floor {
        self.scanned.believed().floor()
    }

    /// The scanned state of the critical zone, stretch by stretch along the shell.
    pub(crate) fn shell(&self) -> Vec<ShellStretch> {
        self.evidence.shell()
    }

    /// The obstacles in the tank, as known.
    pub(crate) fn fixtures(&self) -> Fixtures<'a> {
        let world = &self.run.world;
        let anchor = match (&self.run.mission.tether, &self.run.mission.task) {
            (Some(tether), _) => tether.anchor,
            (None, TaskConfig::Cover { anchor, .. } | TaskConfig::Survey { anchor, .. }) => *anchor,
            (None, _) => self.run.mission.start.position,
        };
        Fixtures {
            boundary: &world.boundary,
            drawn: world
                .obstacles
                .iter()
                .filter(|obstacle| obstacle.known)
                .map(|obstacle| &obstacle.shape)
                .collect(),
            found: self.evidence.found().map(|(_, solid)| &solid.shape).collect(),
            stations: &world.stations,
            zones: &world.zones,
            anchor: Some(anchor),
        }
    }

    /// The plates that cover any floor, each with its cells in ascending order; empty if the layout is not known.
    pub(crate) fn plate_cells(&self) -> Vec<(&Plate, Vec<usize>)> {
        let Some(map) = &self.plate_map else { return Vec::new() };
        let mut plates: Vec<(&Plate, Vec<usize>)> =
            map.plates.iter().map(|plate| (plate, Vec::new())).collect();
        for cell in 0..self.floor().len() {
            if let Some(plate) = map.plate_of(cell) {
                plates[plate].1.push(cell);
            }
        }
        plates.retain(|(_, cells)| !cells.is_empty());
        plates
    }

    /// The plate at a position, if the layout is known.
    pub(crate) fn plate_at(&self, place: Point) -> Option<String> {
        let map = self.plate_map.as_ref()?;
        Some(map.plates[map.plate_of(self.floor().cell_at(place)?)?].name.clone())
    }

    /// The plate of each cell, if the layout is known.
    pub(crate) fn plate_map(&self) -> Option<&PlateMap> {
        self.plate_map.as_ref()
    }

    /// Whether a cell of floor was scanned.
    pub(crate) fn is_scanned(&self, cell: usize) -> bool {
        self.classes[cell].is_scanned()
    }

    /// Whether the tool could not test some of the floor because of the welds.
    pub(crate) fn has_untestable(&self) -> bool {
        self.classes.contains(&FloorClass::Untestable)
    }

    /// Whether a cell belongs to a class.
    pub(crate) fn is(&self, cell: usize, class: FloorClass) -> bool {
        self.classes[cell] == class
    }

    /// Whether the tool passed over a cell that it can test, but gave no reading of it.
    pub(crate) fn is_unread(&self, cell: usize, judge: &Judge) -> bool {
        self.is_scanned(cell) && !self.is(cell, FloorClass::Untestable) && judge.count(cell) == 0
    }

    /// Whether a cell was scanned for every position of the robot within the 95 % error.
    pub(crate) fn is_guaranteed(&self, cell: usize) -> bool {
        self.is_scanned(cell) && self.scanned.passes().is_guaranteed(cell)
    }

    /// Areas where most surrounding cells were scanned more than once; for display only.
    pub(crate) fn smoothed_twice(&self) -> Vec<bool> {
        let width = self.floor().width;
        let at = |cell: Option<usize>| {
            cell.and_then(|cell| self.classes.get(cell))
                .map_or(0, |class| u8::from(*class == FloorClass::Again))
        };
        // The first step adds up three cells along each row. The first and last cell of a row are never scanned.
        let across = |cell: usize| at(cell.checked_sub(1)) + at(Some(cell)) + at(Some(cell + 1));
        let rows: Vec<u8> = (0..self.classes.len()).map(across).collect();
        let row = |cell: Option<usize>| cell.and_then(|cell| rows.get(cell)).copied().unwrap_or(0);
        let most =
            |cell: usize| row(cell.checked_sub(width)) + row(Some(cell)) + row(Some(cell + width)) >= 5;
        (0..rows.len()).map(|cell| self.is_scanned(cell) && most(cell)).collect()
    }

    /// Four error limits that divide the scanned floor into five classes, metres, and the class of each cell. The
    /// classes are smoothed for display; `u8::MAX` means that the cell was not scanned.
    pub(crate) fn error_classes(&self) -> ([f64; 4], Vec<u8>) {
        let (floor, passes) = (self.floor(), self.scanned.passes());
        let error_mm = |cell: usize| passes.error_mm(cell).filter(|_| self.is_scanned(cell));
        let mut counts = vec![0_usize; usize::from(u16::MAX) + 1];
        (0..floor.len()).filter_map(error_mm).for_each(|mm| counts[usize::from(mm)] += 1);
        let quantile = |share: f64| {
            let wanted = share * counts.iter().sum::<usize>() as f64;
            let mut below = 0;
            let found = counts.iter().position(|count| {
                below += count;
                below as f64 >= wanted
            });
            found.unwrap_or(0) as f64
        };
        let (low, high) = (quantile(0.02), quantile(0.985));
        let step = [2.0, 5.0, 10.0, 20.0, 25.0, 50.0].into_iter().find(|step| (high - low) / step <= 4.2);
        let step = step.unwrap_or(100.0);
        let first = (low / step).ceil() * step;
        let edges_mm = [0.0, 1.0, 2.0, 3.0].map(|k| first + k * step);
        let class = |cell: usize| {
            let above = |mm: u16| edges_mm.iter().filter(|edge| f64::from(mm) > **edge).count() as u8;
            error_mm(cell).map_or(u8::MAX, above)
        };
        let rough: Vec<u8> = (0..floor.len()).map(class).collect();
        // The median of three by three cells: a single cell tells little about accuracy.
        let median = |cell: usize| {
            if rough[cell] == u8::MAX {
                return u8::MAX;
            }
            let mut near = [u8::MAX; 9];
            let mut count = 0;
            // No cell on the edge of the grid is scanned.
            for row in [cell.saturating_sub(floor.width), cell, cell + floor.width] {
                for class in rough.get(row.saturating_sub(1)..row + 2).into_iter().flatten() {
                    near[count] = *class;
                    count += usize::from(*class != u8::MAX);
                }
            }
            if near[..count].iter().all(|class| *class == rough[cell]) {
                return rough[cell];
            }
            near[..count].sort_unstable();
            near[count / 2]
        };
        (edges_mm.map(|mm| mm / 1000.0), (0..floor.len()).map(median).collect())
    }
}
