//! What lies beneath the window, and needs none: moments to go back to, undo, saving, sections.

pub mod course;
pub mod overlay;
pub mod section;
pub mod snapshot;
pub mod timeline;
