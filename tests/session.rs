
mod common;

#[path = "session/cloths.rs"]
mod cloths;
#[path = "session/snapshots.rs"]
mod snapshots;
#[path = "session/strokes.rs"]
mod strokes;
#[path = "session/timelines.rs"]
mod timelines;
