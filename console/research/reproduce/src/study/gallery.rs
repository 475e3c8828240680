//! Plans of a study, drawn into a folder.

use super::error::{Result, StudyError};
use planner_api::Plan;
use std::{
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};
use world::{Point, World};

/// A plan of one planner for one tank.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The case of the tank, as in the rows.
    pub case: &'a str,
    /// Its seed.
    pub seed: u64,
    /// The planner and its mode, as in the rows.
    pub method: &'a str,
    /// The tank.
    pub world: &'a World,
    /// Where the tether comes in.
    pub anchor: Point,
    /// Room that the middle of the hull needs, metres.
    pub room_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    /// What was planned.
    pub plan: &'a Plan,
    /// The cable when it is longest, from the anchor to the robot.
    pub cable: &'a [Point],
}

/// A folder of pictures, and the first reason why one could not be written.
pub struct Gallery {
    folder: PathBuf,
    svg: fn(&Picture<'_>) -> String,
    failure: Mutex<Option<StudyError>>,
}

impl Gallery {
    /// A gallery in a folder, which is created if it does not exist; `svg` draws the pictures.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn new(folder: &Path, svg: fn(&Picture<'_>) -> String) -> Result<Self> {
        std::fs::create_dir_all(folder).map_err(|error| {
            let why = format!("the folder for the drawings cannot be created: {error}: {}", folder.display());
            StudyError::Refused(why)
        })?;
        Ok(Self { folder: folder.to_owned(), svg, failure: Mutex::new(None) })
    }

    /// Draws a plan into a file of its own.
    pub(crate) fn add(&self, picture: &Picture<'_>) {
        let Picture { case, seed, method, .. } = picture;
        let file = self.folder.join(format!("{case}-{seed}-{}.svg", method.replace('/', "-")));
        if let Err(error) = std::fs::write(&file, (self.svg)(picture)) {
            let why = format!("a drawing cannot be written: {error}: {}", file.display());
            // A thread that panicked while holding the lock has already been reported.
            let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(StudyError::Refused(why));
        }
    }

    /// Whether everything was written.
    ///
    /// # Errors
    /// The first picture that could not be written.
    pub fn finish(self) -> Result<()> {
        self.failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }
}
