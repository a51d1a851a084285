//! What lies beneath the window: strokes, snapshots, the timeline, undo, saving, sections, overlays.

mod common;

#[path = "session/changes.rs"]
mod changes;
#[path = "session/cloths.rs"]
mod cloths;
#[path = "session/saving.rs"]
mod saving;
#[path = "session/sessions.rs"]
mod sessions;
#[path = "session/snapshots.rs"]
mod snapshots;
#[path = "session/strokes.rs"]
mod strokes;
#[path = "session/timelines.rs"]
mod timelines;
#[path = "session/views.rs"]
mod views;
