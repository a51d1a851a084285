//! The layered grid: two layers of square diffusion cells.
//!
//! One diffusion cell is Δd wide (0.05 mm in paper D §4.1). Every field of the cloth is one
//! contiguous array in the order `(layer, y, x)`, row 0 at the top of the picture.

/// One of the two layers of cells (paper D §4.1, Fig 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// Yarns that run along x. Index 0 in every array.
    Weft,
    /// Yarns that run along y. Index 1 in every array.
    Warp,
}

impl Layer {
    /// Both layers, in the order of the arrays.
    pub const BOTH: [Layer; 2] = [Layer::Weft, Layer::Warp];

    /// The other layer.
    pub fn other(self) -> Layer {
        match self {
            Layer::Weft => Layer::Warp,
            Layer::Warp => Layer::Weft,
        }
    }
}

/// The size of the layered grid, and the one place that turns positions into indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    /// Cells across (x).
    pub nx: usize,
    /// Cells down (y).
    pub ny: usize,
}

impl Grid {
    /// Cells in one layer.
    pub fn layer_len(self) -> usize {
        self.nx * self.ny
    }

    /// Cells in both layers: the length of every field.
    pub fn len(self) -> usize {
        2 * self.layer_len()
    }

    /// Whether the grid has no cells at all.
    pub fn is_empty(self) -> bool {
        self.layer_len() == 0
    }

    /// The layer, row and column of a cell of a field.
    pub fn place(self, i: usize) -> (Layer, usize, usize) {
        let (row, x) = (i / self.nx, i % self.nx);
        (Layer::BOTH[row / self.ny], row % self.ny, x)
    }

    /// Where a cell lies in a field.
    pub fn index(self, layer: Layer, y: usize, x: usize) -> usize {
        (layer as usize * self.ny + y) * self.nx + x
    }
}
