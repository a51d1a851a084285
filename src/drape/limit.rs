//! Yarns lock: where a proposed move would stretch one beyond a limit, it is taken back.
//!
//! Woven cloth gives easily only until the crimp is out of its yarns; beyond a few per cent it hardly
//! gives at all (KES-FB1 curves turn steeply up). The links are straight lines instead, and one implicit
//! step, linear in them, may overshoot where slack cloth is suddenly caught. So the moves of the two
//! ends of an over-long warp or weft link are drawn together along it, by their masses, which changes no
//! momentum (after Provot, *Deformation Constraints in a Mass-Spring Model*, 1995), a few times over.

use bevy::math::DVec3;

use super::lattice::{K, Links};

/// Strain at which yarns lock.
pub const LOCKED: f64 = 0.03;

/// How often over-long links are looked for, and how often each is drawn together before that.
const ROUNDS: usize = 6;
const SWEEPS: usize = 4;

/// A link that became too long: its ends, and the most it may measure.
struct Long {
    ends: [usize; 2],
    most: f64,
}

/// The strain at which yarns of a cloth lock: [`LOCKED`], or more where its own weight stretches it that
/// much. `load` is the largest force by width, N/m; `stretch` the softer modulus, N/m.
pub fn locks_at(load: f64, stretch: f64) -> f64 {
    LOCKED.max(10.0 * load / stretch)
}

/// Draws together what `moves` would stretch beyond the strain `most`; marks what it changed.
pub fn limit(
    links: &Links,
    most: f64,
    mobility: &[f64],
    x: &[DVec3],
    moves: &mut [DVec3],
    changed: &mut [bool],
) {
    for _ in 0..ROUNDS {
        let long = too_long(links, most, mobility, x, moves);
        if long.is_empty() {
            return;
        }
        for _ in 0..SWEEPS {
            for link in &long {
                let [a, b] = link.ends;
                let apart = (x[b] + moves[b]) - (x[a] + moves[a]);
                let r = apart.length();
                if r <= link.most {
                    continue;
                }
                let by = apart * ((r - link.most) / (r * (mobility[a] + mobility[b])));
                moves[a] += mobility[a] * by;
                moves[b] -= mobility[b] * by;
                changed[a] |= mobility[a] > 0.0;
                changed[b] |= mobility[b] > 0.0;
            }
        }
    }
}

fn too_long(links: &Links, most: f64, mobility: &[f64], x: &[DVec3], moves: &[DVec3]) -> Vec<Long> {
    let (nx, ny) = links.particles;
    let mut found = Vec::new();
    for direction in 0..2 {
        let hop = [1, nx][direction];
        let (across, down) = [(nx - 1, ny), (nx, ny - 1)][direction];
        let longest = links.length(direction) * (1.0 + most);
        let squared = longest * longest;
        for row in 0..down {
            for a in row * nx..row * nx + across {
                let b = a + hop;
                let apart = (x[b] + moves[b]) - (x[a] + moves[a]);
                let is_long = apart.length_squared() > squared && mobility[a] + mobility[b] > 0.0;
                if is_long && links.stiffness.get(a % nx, row, K + direction) > 0.0 {
                    found.push(Long {
                        ends: [a, b],
                        most: longest,
                    });
                }
            }
        }
    }
    found
}
