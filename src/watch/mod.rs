//! The window in which dyeing is watched, and played with.

pub mod panel;
