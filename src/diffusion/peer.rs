//! Explicit steps on the made-up cloth of `benches/peers`, which other programs step on as well.

use super::held::Held;
use super::lanes::{LANES, Lanes, Ways};
use super::passage::Law;
use super::steps::{Ground, State};
use crate::cloth::{Grid, Layer};

/// A cloth without yarns whose conductances follow a simple formula.
#[derive(Debug)]
pub struct Peer {
    lanes: Lanes,
    ways: Vec<Ways>,
    state: State,
}

/// c, and the conductances to the east and south, of the `i`th cell of a `(layer, y, x)` field.
fn cell(i: usize) -> [f32; 3] {
    let [c, east, south] = [i * 7919 % 1000, i % 13, i % 7].map(|n| n as f64);
    [c / 1000.0, 0.1 + east * 0.005, 0.1 + south * 0.005].map(|n| n as f32)
}

impl Peer {
    /// A cloth of this size.
    pub fn new(nx: usize, ny: usize) -> Self {
        let grid = Grid { nx, ny };
        let lanes = Lanes::new(grid);
        let mut state = State::new(lanes);
        let mut ways = vec![Ways::SHUT; lanes.len()];
        for layer in Layer::BOTH {
            for y in 0..ny {
                for x in 0..nx {
                    let i = grid.index(layer, y, x);
                    let (block, l, lane) =
                        (y * lanes.blocks + x / LANES, layer as usize, x % LANES);
                    let [c, east, south] = cell(i);
                    state.c[0][block].0[l][lane] = c;
                    let way = &mut ways[block];
                    way.east[l][lane] = if x + 1 < nx { east } else { 0.0 };
                    way.south[l][lane] = if y + 1 < ny { south } else { 0.0 };
                    way.beside[lane] = 0.1;
                    way.per_capacity[l][lane] = 1.0;
                }
            }
        }
        Peer { lanes, ways, state }
    }

    /// Takes steps.
    pub fn advance(&mut self, steps: usize) {
        let ground = Ground {
            lanes: self.lanes,
            ways: &self.ways,
            law: Law::Fick,
            held: &Held::nothing(self.lanes),
        };
        self.state.advance(ground, steps);
    }

    /// The largest error, after so many steps, against the plainest loop in double precision.
    pub fn error_after(&self, steps: usize) -> f64 {
        let Grid { nx, ny } = self.lanes.grid;
        let n = 2 * nx * ny;
        let mut c: Vec<f64> = (0..n).map(|i| f64::from(cell(i)[0])).collect();
        for _ in 0..steps {
            let next = (0..n).map(|i| {
                let (x, y, other) = (i % nx, i / nx % ny, (i + n / 2) % n);
                let mut flow = f64::from(0.1_f32) * (c[other] - c[i]);
                let mut face = |g: f32, j: usize| flow += f64::from(g) * (c[j] - c[i]);
                if x + 1 < nx {
                    face(cell(i)[1], i + 1);
                }
                if x > 0 {
                    face(cell(i - 1)[1], i - 1);
                }
                if y + 1 < ny {
                    face(cell(i)[2], i + nx);
                }
                if y > 0 {
                    face(cell(i - nx)[2], i - nx);
                }
                c[i] + flow
            });
            c = next.collect();
        }
        let errors = c.iter().enumerate().map(|(i, c)| {
            let (block, layer, lane) = self.lanes.place(i);
            (c - f64::from(self.state.c[0][block].0[layer][lane])).abs()
        });
        errors.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::Peer;

    #[test]
    fn steps_agree_with_the_plainest_loop_in_double_precision() {
        for (nx, ny) in [(40, 90), (33, 17), (1, 60), (5, 1)] {
            let mut peer = Peer::new(nx, ny);
            peer.advance(50);
            let error = peer.error_after(50);
            assert!(error < 2e-6, "{nx}×{ny}: {error}");
        }
    }
}
