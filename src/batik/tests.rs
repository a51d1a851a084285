//! What the tests of several files share.

use crate::cloth::{Cloth, Parts, Weave, Yarn, Yarns};
use crate::pattern::Raster;

/// An uneven cloth in plain weave, of yarns and gaps of some cells.
pub(super) fn woven(nx: usize, ny: usize, width: usize, gap: usize) -> Cloth {
    let yarns = |cells: usize, salt: usize| Yarns {
        width,
        gap,
        yarns: (0..cells.div_ceil(width + gap))
            .map(|i| {
                let r = 0.5 + 0.5 * ((i * 37 + salt) % 17) as f64 / 16.0;
                Yarn {
                    porosity: 0.5 * r,
                    twist: 0.025 * (1.5 - r),
                    squeeze: 0.0,
                }
            })
            .collect(),
    };
    Cloth::assemble(Parts {
        cell_mm: 0.05,
        warp: yarns(nx, 3),
        weft: yarns(ny, 11),
        weave: Weave::Plain.matrix(),
        gap_porosity: [0.375; 2],
        resist: Raster::uniform(nx, ny, 0.0),
    })
}
