//! Batik.

pub mod crackle;
pub mod crossings;
pub mod distance;
pub mod drawing;
pub mod ellipse;
pub mod mixing;
mod noise;
pub mod permeation;
pub mod picture;
pub mod sweep;
pub mod wax;

#[cfg(test)]
mod tests;
