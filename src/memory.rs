//! Refusing a cloth that does not fit in memory, before anything is allocated for it.

use sysinfo::System;
use thiserror::Error;

use crate::scenario::{Scenario, TextureLook};

/// Bytes of the program itself.
const BYTES_AT_LEAST: u128 = 20_000_000;
/// Bytes of every field kept for one cell of a layer, with the solver that keeps most: three of free
/// dye, two and a half of conductances along the cloth and between the layers, the inverse of
/// capacities, half of the resist, which cell is seen, and four that solvers step between.
const BYTES_PER_CELL: u128 = 46;
/// Bytes of bound dye, of the three fields that solvers step between, and of capacities.
const BYTES_PER_BINDING_CELL: u128 = 24;
/// Bytes of a batik for one cell: the sweeps, what cells exchange, the dye that is gathered from them,
/// and half of the drawing, the permeation and the cracks of a wax.
const BYTES_PER_BATIK_CELL: u128 = 64;
/// Bytes for one cell of what is kept of each dye, and for each of its waxes two numbers a place.
const BYTES_PER_BATIK_STEP: u128 = 4;
/// Bytes for one pixel of an enlarged photograph, as it is made and as it is kept.
const BYTES_PER_PHOTO_PIXEL: u128 = 3 + 3 * 4;
/// Bytes for one pixel of a picture that is mixed of several dyes, or blurred, in float32.
const BYTES_PER_MIXED_PIXEL: u128 = 4 + 3 * 12;
/// Bytes for one pixel of the picture: its shade, and its colour six times over: now, while it is
/// made smaller for the contact sheet, and in the four frames that are on their way to the disk.
const BYTES_PER_PIXEL: u128 = 2 + 6 * 3;
/// Bytes of the contact sheet for each of its places, and again for the sheet as a whole.
const BYTES_PER_SHEET_PLACE: u128 = 2 * 3 * (crate::record::LARGEST_TILE as u128).pow(2);
/// Bytes for one cell of the fields that are recorded, free, bound and held, five times over: being
/// taken, and in the four states that are on their way to the disk.
const BYTES_PER_RECORDED_CELL: u128 = 5 * 3 * 4;

/// The most cells a layer may have: a cell is named by 32 bits.
const MOST_CELLS: u128 = 1 << 31;

/// A cloth that is too large.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MemoryError {
    /// It does not fit in memory.
    #[error(
        "a cloth of {nx}×{ny}×2 cells drawn at {scale} pixels a cell needs {} of memory, \
         but only {} is free", gigabytes(*.needed), gigabytes(u128::from(*.free))
    )]
    DoesNotFit {
        /// Cells across.
        nx: usize,
        /// Cells down.
        ny: usize,
        /// Pixels along one side of a cell.
        scale: u32,
        /// Bytes needed.
        needed: u128,
        /// Bytes free.
        free: u64,
    },
    /// It would fit, but has more cells than can be counted.
    #[error("a cloth of {nx}×{ny}×2 cells has more than {MOST_CELLS} in a layer")]
    TooManyCells {
        /// Cells across.
        nx: usize,
        /// Cells down.
        ny: usize,
    },
}

/// What is made of a cloth beyond dyeing it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Use {
    /// Pixels along one side of a cell.
    pub scale: u32,
    /// Whether the fields are recorded.
    pub fields: bool,
}

impl Use {
    /// Pictures at the scenario's own scale.
    pub fn of(scenario: &Scenario) -> Self {
        Use {
            scale: scenario.look.pixels_per_cell,
            fields: false,
        }
    }
}

/// Bytes that dyeing, drawing and recording a scenario takes at most.
pub fn needed(scenario: &Scenario, Use { scale, fields }: Use) -> u128 {
    let (nx, ny) = scenario.cloth.cells();
    let cells = 2 * nx as u128 * ny as u128;
    let pixels = nx as u128 * ny as u128 * u128::from(scale) * u128::from(scale);
    let patterns = scenario.patterns();
    let rasters = patterns
        .iter()
        .map(|(pattern, _)| pattern.rasters_at_once())
        .max()
        .unwrap_or(0);
    // A held cell is listed with its place and dose: in its hold, for its end, among all that are
    // held, and twice over while those are sorted out.
    let held = 5 * 8 * scenario.supply.len() as u128;
    // Images are kept as rasters beside the ones that are drawn.
    let images = scenario.pictures().len();
    let per_layer_cell = 4 * (rasters + images) as u128;
    let recorded = if fields { BYTES_PER_RECORDED_CELL } else { 0 };
    let bound = scenario.adsorption.is_some() || scenario.cloth.kasuri.is_there();
    let binding = if bound { BYTES_PER_BINDING_CELL } else { 0 };
    let batik = scenario.batik.as_ref().map_or(0, |batik| {
        BYTES_PER_BATIK_CELL + BYTES_PER_BATIK_STEP * batik.steps.len() as u128
    });
    let mixed =
        scenario.batik.is_some() || matches!(scenario.look.texture, TextureLook::Ellipses(_));
    let mixed = if mixed { BYTES_PER_MIXED_PIXEL } else { 0 };
    let looks = match scenario.look.texture {
        TextureLook::Photo { .. } => BYTES_PER_PHOTO_PIXEL,
        _ => 0,
    };
    let places = scenario.record.sheet.len().max(8) as u128;
    BYTES_AT_LEAST
        + cells * (BYTES_PER_CELL + held + recorded + binding + batik)
        + cells / 2 * per_layer_cell
        + pixels * (BYTES_PER_PIXEL + mixed + looks)
        + places * BYTES_PER_SHEET_PLACE.min(40 * pixels)
}

/// Refuses a scenario whose cloth is too large.
///
/// # Errors
/// A [`MemoryError`] with both figures.
pub fn check(scenario: &Scenario, made: Use) -> Result<(), MemoryError> {
    let (nx, ny) = scenario.cloth.cells();
    let needed = needed(scenario, made);
    let free = free();
    if needed > u128::from(free) {
        return Err(MemoryError::DoesNotFit {
            nx,
            ny,
            scale: made.scale,
            needed,
            free,
        });
    }
    if nx as u128 * ny as u128 > MOST_CELLS {
        return Err(MemoryError::TooManyCells { nx, ny });
    }
    Ok(())
}

/// What is taken to be free where the system does not tell, bytes.
const UNKNOWN_MEMORY: u64 = 4 << 30;

/// Bytes of memory that this process may still take.
pub(crate) fn free() -> u64 {
    let Ok(mut system) = System::new() else {
        return UNKNOWN_MEMORY;
    };
    system.refresh_memory();
    let machine = match system.available_memory() {
        0 => UNKNOWN_MEMORY,
        bytes => bytes,
    };
    match system.cgroup_limits() {
        Some(group) => machine.min(group.free_memory),
        None => machine,
    }
}

fn gigabytes(bytes: u128) -> String {
    format!("{:.1} GB", bytes as f64 / 1e9)
}
