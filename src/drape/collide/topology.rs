//! The corners, edges and triangles of the cloth, each belonging to one cell of the grid.
//!
//! A cell has the number of the particle at its first corner. Its diagonal runs one way where column +
//! row is even and the other way where it is odd, so that no direction of the cloth is preferred.

/// How the particles of a cloth make a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Topology {
    /// Particles across and down.
    pub particles: (usize, usize),
    /// Which cells are cloth, a row of `particles.0` at a time (the last column and row never are).
    cloth: Vec<bool>,
}

/// What belongs to one cell, at most.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CellParts {
    /// Its corner.
    pub corner: Option<u32>,
    /// Its edges: to the right, down, and across.
    pub edges: [Option<[u32; 2]>; 3],
    /// Its triangles, anticlockwise seen from the front.
    pub triangles: [Option<[u32; 3]>; 2],
}

impl Topology {
    /// A surface whose cells are those for which `cloth` is true.
    pub fn new(particles: (usize, usize), cloth: impl Fn(usize, usize) -> bool) -> Self {
        let (nx, ny) = particles;
        let cells = (0..nx * ny).map(|i| {
            let (x, y) = (i % nx, i / nx);
            x + 1 < nx && y + 1 < ny && cloth(x, y)
        });
        Topology {
            particles,
            cloth: cells.collect(),
        }
    }

    /// Whether a cell is cloth.
    pub fn is_cloth(&self, x: usize, y: usize) -> bool {
        let (nx, ny) = self.particles;
        x < nx && y < ny && self.cloth[y * nx + x]
    }

    /// Whether any of the cells around a particle is cloth.
    pub fn has_particle(&self, x: usize, y: usize) -> bool {
        let left = |x: usize, y: usize| self.is_cloth(x, y) || x > 0 && self.is_cloth(x - 1, y);
        left(x, y) || y > 0 && left(x, y - 1)
    }

    /// The corners of a cell; those of the last column and row come twice.
    pub fn corners(&self, cell: u32) -> [u32; 4] {
        let (nx, ny) = (self.particles.0 as u32, self.particles.1 as u32);
        let right = u32::from(cell % nx + 1 < nx);
        let below = if cell / nx + 1 < ny { nx } else { 0 };
        [cell, cell + right, cell + below, cell + right + below]
    }

    /// What belongs to a cell.
    pub fn parts(&self, cell: u32) -> CellParts {
        let nx = self.particles.0 as u32;
        let (x, y) = ((cell % nx) as usize, (cell / nx) as usize);
        let (here, right, below, beyond) = (cell, cell + 1, cell + nx, cell + nx + 1);
        let is_cloth = self.is_cloth(x, y);
        let mut parts = CellParts::default();
        if self.has_particle(x, y) {
            parts.corner = Some(here);
        }
        if is_cloth || y > 0 && self.is_cloth(x, y - 1) {
            parts.edges[0] = Some([here, right]);
        }
        if is_cloth || x > 0 && self.is_cloth(x - 1, y) {
            parts.edges[1] = Some([here, below]);
        }
        if is_cloth && (x + y).is_multiple_of(2) {
            parts.edges[2] = Some([here, beyond]);
            parts.triangles = [Some([here, below, beyond]), Some([here, beyond, right])];
        } else if is_cloth {
            parts.edges[2] = Some([right, below]);
            parts.triangles = [Some([here, below, right]), Some([right, below, beyond])];
        }
        parts
    }

    /// All triangles.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let cells = 0..self.cloth.len() as u32;
        cells
            .flat_map(|cell| self.parts(cell).triangles)
            .flatten()
            .collect()
    }
}
