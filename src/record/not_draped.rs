//! Frames of the draped cloth, in a build that cannot draw them.

use bevy::prelude::App;

use super::RecordError;
use crate::scenario::{Draping, Experiment, ViewSpec};
use crate::texture::Picture;

/// There is no studio here.
pub enum Draped {}

impl Draped {
    /// Tells that there is no studio.
    ///
    /// # Errors
    /// Always [`RecordError::NoViewer`].
    pub fn check() -> Result<(), RecordError> {
        Err(RecordError::NoViewer)
    }

    /// As [`check`](Draped::check).
    ///
    /// # Errors
    /// Always [`RecordError::NoViewer`].
    pub fn add_plugins(_: &mut App) -> Result<(), RecordError> {
        Draped::check()
    }

    /// As [`check`](Draped::check).
    ///
    /// # Errors
    /// Always [`RecordError::NoViewer`].
    pub fn start(
        _: &mut App,
        _: &Experiment,
        _: ViewSpec,
        _: Option<&Draping>,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Self, RecordError> {
        Err(RecordError::NoViewer)
    }

    /// Cannot be called.
    ///
    /// # Errors
    /// None.
    pub fn see(
        &mut self,
        _: &mut App,
        _: f64,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Picture, RecordError> {
        match *self {}
    }
}
