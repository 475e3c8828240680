//! Plans of a study, drawn into a folder.

use crate::failure::bad_input;
use ::reproduce::{Picture, Study};
use report::{
    drawing::plan::{Drawn, svg},
    leg::legs,
};
use std::{
    path::{Path, PathBuf},
    sync::Mutex,
};

/// A folder of pictures, and the first reason why one could not be written.
pub(super) struct Gallery {
    folder: PathBuf,
    failure: Mutex<Option<anyhow::Error>>,
}

impl Gallery {
    /// A gallery in a folder, which is made if it does not exist.
    ///
    /// # Errors
    /// The study has no plans to draw, or the folder cannot be made.
    pub(super) fn new(study: &Study, folder: &Path) -> anyhow::Result<Self> {
        if !study.has_pictures() {
            let why = "--svg draws plans of whole floors; `pan-maps` and `coverage-suite` make such";
            return Err(bad_input(format!("{}: {why}", study.name)));
        }
        std::fs::create_dir_all(folder).map_err(|error| {
            bad_input(format!("the folder for the drawings cannot be made: {error}: {}", folder.display()))
        })?;
        Ok(Self { folder: folder.to_owned(), failure: Mutex::new(None) })
    }

    /// Draws a plan into a file of its own.
    pub(super) fn hang(&self, picture: &Picture<'_>) {
        let file = self.folder.join(file_name(picture));
        if let Err(error) = std::fs::write(&file, drawn(picture)) {
            let error = bad_input(format!("a drawing cannot be written: {error}: {}", file.display()));
            // A thread that panicked while holding the lock has already been reported.
            let mut failure = self.failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            failure.get_or_insert(error);
        }
    }

    /// Whether everything was written.
    ///
    /// # Errors
    /// The first picture that could not be written.
    pub(super) fn close(self) -> anyhow::Result<()> {
        let failure = self.failure.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        failure.map_or(Ok(()), Err)
    }
}

fn file_name(picture: &Picture<'_>) -> String {
    format!("{}-{}-{}.svg", picture.case, picture.seed, picture.method.replace('/', "-"))
}

fn drawn(picture: &Picture<'_>) -> String {
    svg(&Drawn {
        world: picture.world,
        room_m: picture.room_m,
        swath_m: picture.swath_m,
        preset: None,
        anchor: Some(picture.anchor),
        path: &picture.plan.path,
        legs: &legs(picture.plan),
        cuts: &picture.plan.cuts,
        cable: picture.cable,
    })
}
