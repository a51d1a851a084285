//! Photographs of cloth: which yarn lies on top at every pixel (paper D §4.3.1b, Figs 7 and 14), and
//! the colours of dyed cloth (§4.3.1).

pub mod draw;
mod error;
pub(crate) mod file;
mod mask;
pub mod palette;
mod photograph;
mod plane;
pub mod segment;

pub use error::PhotoError;
pub use mask::{Mask, WARP, WEFT};
pub use photograph::Photo;
