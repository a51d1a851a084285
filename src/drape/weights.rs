//! From measured properties of cloth to masses and links, on any grid (model section 8).
//!
//! Every link stands for a piece of the cloth, shared fairly among the links of its direction, so that
//! the energy of an evenly stretched, sheared or bent cloth does not depend on the grid:
//!
//! | deformation | energy a m² | gives |
//! |---|---|---|
//! | strain ε along a yarn | ½·E·ε² | k = E·A/L² |
//! | shear γ, which stretches one diagonal by γ·dx·dy/L² | ½·G·γ² | k = G·A·L²/(dx·dy)² |
//! | curvature κ in direction i | w_i·κ² | k_b = 2·w_i·A/L |
//!
//! A is the piece's area, L the link's length. With w_d = D/(12c²s²) for both diagonals (c, s the
//! cosine and sine of their direction) and w_x = D/2 − 2c⁴·w_d, w_y = D/2 − 2s⁴·w_d, the four directions
//! together bend like an isotropic plate of Poisson's ratio ⅓, whose strip has the rigidity
//! B = D(1 − 1/9): on square cells w = D/3 each.

use super::lattice::{C_B, DIRECTIONS, K, K_B, Links};
use super::rows::Rows;

/// What is measured of a cloth, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Mass, kg/m².
    pub weight: f64,
    /// E along weft and warp: force by width and strain, N/m.
    pub stretch: (f64, f64),
    /// G: shear force by width and angle, N/m.
    pub shear: f64,
    /// B of strips cut along weft and warp, N·m.
    pub bending: (f64, f64),
    /// c_b's modulus as a multiple of the stretch moduli.
    pub buckling: f64,
    /// k_d/k, s.
    pub damping: f64,
}

/// Masses (plane 0, kg; plane 1 is 1 everywhere) and links of a cloth whose cells hold `area` m² each,
/// a row of `particles.0 − 1` at a time.
pub fn assemble(
    measured: &Measured,
    particles: (usize, usize),
    spacing: (f64, f64),
    area: &[f64],
) -> (Rows, Links) {
    let cells = Cells {
        across: particles.0.saturating_sub(1),
        down: particles.1.saturating_sub(1),
        area,
    };
    let mut links = Links::none(particles, spacing);
    links.damping = [measured.damping; 4];
    let mut mass = Rows::zero(particles.0, particles.1, 2);
    for y in 0..particles.1 {
        for x in 0..particles.0 {
            let around = [(-1, -1), (0, -1), (-1, 0), (0, 0)];
            let sum: f64 = around
                .iter()
                .map(|(i, j)| cells.at(x as isize + i, y as isize + j))
                .sum();
            *mass.get_mut(x, y, 0) = 0.25 * sum * measured.weight;
            *mass.get_mut(x, y, 1) = 1.0;
        }
    }
    let moduli = Moduli::new(measured, particles, spacing);
    let stiffest = MOST_RAISED * measured.buckling * moduli.stretch[0].max(moduli.stretch[1]);
    for direction in 0..4 {
        let length = links.length(direction);
        for hops in [1, 2] {
            let covers = covered(direction, hops);
            let exists = |x, y| {
                let inside = |(i, j): &(isize, isize)| cells.at(x + i, y + j) > 0.0;
                let (Ok(a), Ok(b)) = (usize::try_from(x), usize::try_from(y)) else {
                    return false;
                };
                let on_grid = a < particles.0 && b < particles.1;
                on_grid
                    && links.other_end((a, b), direction, hops).is_some()
                    && covers.iter().any(inside)
            };
            // How many links of this kind share each cell.
            let shared = |x: isize, y: isize| {
                let covers = covers.iter().filter(|(i, j)| exists(x - i, y - j));
                covers.count() as f64
            };
            let mut all = Vec::new();
            for y in 0..particles.1 {
                for x in 0..particles.0 {
                    let (i, j) = (x as isize, y as isize);
                    if !exists(i, j) {
                        continue;
                    }
                    let piece = |(di, dj): &(isize, isize)| {
                        let area = cells.at(i + di, j + dj);
                        if area > 0.0 {
                            area / shared(i + di, j + dj)
                        } else {
                            0.0
                        }
                    };
                    all.push((x, y, covers.iter().map(piece).sum::<f64>()));
                }
            }
            for (x, y, area) in all {
                let stiffness = &mut links.stiffness;
                if hops == 1 {
                    *stiffness.get_mut(x, y, K + direction) =
                        moduli.stretch[direction] * area / (length * length);
                } else {
                    let length = 2.0 * length;
                    let k_b = 2.0 * moduli.bending[direction] * area / length;
                    let c_b =
                        measured.buckling * moduli.stretch[direction] * area / (length * length);
                    *stiffness.get_mut(x, y, K_B + direction) = k_b;
                    *stiffness.get_mut(x, y, C_B + direction) = c_b.max(
                        buckles_soon(measured, k_b, length)
                            .min(stiffest * area / (length * length)),
                    );
                }
            }
        }
    }
    (mass, links)
}

/// c_b of a link that buckles long before it is as bent as hanging cloth is.
///
/// A link that has not buckled is a spring against compression, and as good as does not bend. It buckles at
/// 1 − r/L = 12k_b/(c_b·L³), an arc of curvature κ has 1 − r/L = (κL)²/24. So c_b about k, as the paper
/// has it, would make stiff cloth on a fine grid limp; here κ is [`EARLY`] of the curvature ∛(weight/B)
/// at which weight and bending are in balance.
fn buckles_soon(measured: &Measured, k_b: f64, length: f64) -> f64 {
    let bending = (measured.bending.0 * measured.bending.1).sqrt();
    if bending <= 0.0 {
        return 0.0;
    }
    let curvature = EARLY * libm::cbrt(9.81 * measured.weight / bending);
    288.0 * k_b / (curvature * curvature * length * length * length * length * length)
}

/// The share of its balanced curvature at which cloth has buckled.
const EARLY: f64 = 0.3;

/// c_b is raised to no more than this many times that of a yarn: a very stiff link that buckles shakes what
/// it joins.
const MOST_RAISED: f64 = 10.0;

/// Energy densities by direction: ½·stretch·ε², bending·κ².
struct Moduli {
    stretch: [f64; 4],
    bending: [f64; 4],
}

impl Moduli {
    fn new(measured: &Measured, particles: (usize, usize), (dx, dy): (f64, f64)) -> Self {
        let diagonal = dx * dx + dy * dy;
        let shear = measured.shear * diagonal * diagonal / (dx * dx * dy * dy);
        let (bx, by) = measured.bending;
        let bending = if particles.0 < 3 || particles.1 < 3 {
            // A single row of cells has no links along its diagonals.
            [0.5 * bx, 0.5 * by, 0.0, 0.0]
        } else {
            let (c2, s2) = (dx * dx / diagonal, dy * dy / diagonal);
            let of_strip = 9.0 / 8.0;
            let across = of_strip * (bx * by).sqrt() / (12.0 * c2 * s2);
            let along = |b: f64, share: f64| {
                (0.5 * of_strip * b - 2.0 * share * share * across).max(0.05 * b)
            };
            [along(bx, c2), along(by, s2), across, across]
        };
        Moduli {
            stretch: [measured.stretch.0, measured.stretch.1, shear, shear],
            bending,
        }
    }
}

/// The cells that a link covers, counted from the particle where it begins.
fn covered(direction: usize, hops: isize) -> Vec<(isize, isize)> {
    let (dx, dy) = DIRECTIONS[direction];
    let span = |d: isize| match d {
        0 => -1..1,
        d if d > 0 => 0..hops,
        _ => -hops..0,
    };
    span(dy)
        .flat_map(|j| span(dx).map(move |i| (i, j)))
        .collect()
}

struct Cells<'a> {
    across: usize,
    down: usize,
    area: &'a [f64],
}

impl Cells<'_> {
    fn at(&self, x: isize, y: isize) -> f64 {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.across && y < self.down => self.area[y * self.across + x],
            _ => 0.0,
        }
    }
}
