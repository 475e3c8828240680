//! Drawings of a study's plans, in a folder.

use super::error::{Result, StudyError};
use planner_api::Plan;
use report::{
    drawing::{
        curves::{self, Curves},
        plan::{Drawn, svg},
    },
    leg::legs,
};
use std::{
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};
use world::{Point, World};

/// A folder of drawings, and the first reason why one could not be written.
pub struct Gallery {
    folder: PathBuf,
    failure: Mutex<Option<StudyError>>,
}

impl Gallery {
    /// A gallery in a folder, which is created if it does not exist.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn new(folder: &Path) -> Result<Self> {
        std::fs::create_dir_all(folder).map_err(|error| {
            let why = format!("the folder for the drawings cannot be created: {error}: {}", folder.display());
            StudyError::Refused(why)
        })?;
        Ok(Self { folder: folder.to_owned(), failure: Mutex::new(None) })
    }

    /// Draws the plan of a method for a case and seed into a separate file.
    pub(crate) fn add(&self, name: (&str, u64, &str), drawn: &Drawn<'_>) {
        self.write(name, &svg(drawn));
    }

    /// Draws the path of a plan among obstacles, with the preset path if there is one; `room_m` is the distance that
    /// the hull needs.
    pub(crate) fn add_path(
        &self,
        name: (&str, u64, &str),
        world: &World,
        room_m: f64,
        preset: Option<&[Point]>,
        plan: &Plan,
    ) {
        let legs = legs(plan);
        let drawn = Drawn {
            world,
            room_m,
            swath_m: 0.0,
            preset,
            anchor: None,
            path: &plan.path,
            legs: &legs,
            cuts: &plan.cuts,
            cable: &[],
        };
        self.add(name, &drawn);
    }

    /// Draws curves of a method for a case and seed into a separate file.
    pub(crate) fn add_curves(&self, name: (&str, u64, &str), curves: &Curves<'_>) {
        self.write(name, &curves::svg(curves));
    }

    fn write(&self, (case, seed, method): (&str, u64, &str), svg: &str) {
        let name = format!("{case}-{seed}-{method}.svg").replace('/', "-");
        let file = self.folder.join(name);
        if let Err(error) = std::fs::write(&file, svg) {
            let why = format!("a drawing cannot be written: {error}: {}", file.display());
            // A thread that panicked while holding the lock has already been reported.
            let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(StudyError::Refused(why));
        }
    }

    /// Reports whether everything was written.
    ///
    /// # Errors
    /// The first drawing that could not be written.
    pub fn finish(self) -> Result<()> {
        self.failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }
}
