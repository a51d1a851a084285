//! What lies beneath the window: strokes, snapshots, the timeline, undo, saving, sections, overlays.

mod common;

#[path = "session/strokes.rs"]
mod strokes;
