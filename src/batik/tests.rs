//! What the tests of several files share.

use crate::cloth::{Cloth, Parts, Weave, Yarn, Yarns};
use crate::pattern::Raster;

/// An uneven cloth in plain weave, of yarns and gaps of some cells.
pub(super) fn woven(nx: usize, ny: usize, width: usize, gap: usize) -> Cloth {
    let yarns = |cells: usize, salt: usize| {
        Yarns::lay(cells, |i| {
            let r = 0.5 + 0.5 * ((i * 37 + salt) % 17) as f64 / 16.0;
            let yarn = Yarn {
                porosity: 0.5 * r,
                twist: 0.025 * (1.5 - r),
                ..Yarn::default()
            };
            (yarn, width, gap)
        })
    };
    Cloth::assemble(Parts {
        cell_mm: 0.05,
        warp: yarns(nx, 3),
        weft: yarns(ny, 11),
        weave: Weave::Plain.matrix(),
        mask: None,
        gap_porosity: [0.375; 2],
        resist: Raster::uniform(nx, ny, 0.0),
    })
}
