//! Creases: lines along which the cloth was pressed, in any direction, folded to a kept side.
//!
//! Paper C shortens the type 2 links across the fold to L′ = 0.7·L and adds the pull of type 1 with the
//! same rest length; its fold may flip to the other side, and lies along the mesh. Here a crease is a line
//! from point to point of the cloth, an angle Θ and a side. It turns a link that it crosses in the middle
//! by Θ, so L′ = L·cos(Θ/2): 0.7·L is 91°. One that it crosses off the middle takes its share, falling to
//! none at the ends, so the links of a row turn by Θ together wherever the line runs; and a link not at
//! right angles to the line turns by the angle that its direction makes with itself folded.
//!
//! **The side** is kept by a third term. With a, b the ends of the link, m the particle between, p and q
//! its neighbours across, N the unit vector along (b − a) × (q − p), the height h = (m − ½(a + b))·N
//! has a sign, and the energy
//!
//! E = ½·k·max(0, r − L′)² + ½·k·max(0, h′ − σ·h)²,  h′ = ½·L·sin(Θ/2)
//!
//! has a single minimum over all folds: the first term, paper C's, is the same on both sides, and going
//! from the wrong side to flat it rises by ½·k·(L − L′)² at most, while the second falls by
//! ½·k·(4h′² − h′²). Being made of distances and triple products it changes neither momentum nor
//! angular momentum.

use bevy::math::{DVec2, DVec3};

use super::contact::block;
use super::lattice::{C_B, DIRECTIONS, K_B, Links};
use super::links::{Pull, bend, bend_energy, stretch, stretch_energy};
use super::response::{BLOCK, Response};
use super::rows::Rows;

/// Shares of a fold smaller than this are left to the links beside.
const LEAST_SHARE: f64 = 0.05;

/// A crease.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    /// Where it begins: metres across and down the cloth.
    pub from: DVec2,
    /// Where it ends.
    pub to: DVec2,
    /// Θ, rad: 0 flat, π folded shut. Positive where the front is outside (a mountain seen from there).
    pub angle: f64,
    /// Torque by length and angle, N·m/(m·rad).
    pub stiffness: f64,
}

/// A type 2 link that a crease crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreaseLink {
    /// The particle where it begins.
    at: (usize, usize),
    direction: usize,
    /// L′, m.
    rest: f64,
    /// σ·h′, m.
    height: f64,
    /// k, N/m.
    k: f64,
    k_b: f64,
    c_b: f64,
}

/// Presses creases into a cloth: takes the links that they cross out of `links` and returns what they
/// become. Where creases cross, the first keeps the link.
pub fn press(links: &mut Links, creases: &[Crease]) -> Vec<CreaseLink> {
    let mut pressed = Vec::new();
    for crease in creases {
        for direction in 0..4 {
            for y in 0..links.particles.1 {
                for x in 0..links.particles.0 {
                    let link = press_one(links, crease, (x, y), direction);
                    if let Some(link) = link {
                        link.take_from(links);
                        pressed.push(link);
                    }
                }
            }
        }
    }
    pressed
}

fn press_one(
    links: &Links,
    crease: &Crease,
    at: (usize, usize),
    direction: usize,
) -> Option<CreaseLink> {
    links.other_end(at, direction, 2)?;
    let k_b = links.stiffness.get(at.0, at.1, K_B + direction);
    let c_b = links.stiffness.get(at.0, at.1, C_B + direction);
    if k_b <= 0.0 {
        return None;
    }
    let spacing = DVec2::from(links.spacing);
    let begin = DVec2::new(at.0 as f64, at.1 as f64) * spacing;
    let (dx, dy) = DIRECTIONS[direction];
    let hop = DVec2::new(dx as f64, dy as f64) * spacing;
    let line = crease.to - crease.from;
    // begin + s·hop = from + t·line
    let cross = hop.perp_dot(line);
    if cross.abs() <= 1e-9 * hop.length() * line.length() {
        return None;
    }
    let s = (crease.from - begin).perp_dot(line) / cross;
    let t = (crease.from - begin).perp_dot(hop) / cross;
    let share = 1.0 - (s - 1.0).abs();
    if share < LEAST_SHARE || !(0.0..=1.0).contains(&t) {
        return None;
    }
    let along = hop.normalize();
    let across = along.perp_dot(line.normalize()).abs();
    // A direction at an angle to the line turns less than the fold.
    let folded = share * crease.angle.abs();
    let turned = libm::acos((1.0 - across * across * (1.0 - libm::cos(folded))).clamp(-1.0, 1.0));
    let length = 2.0 * links.length(direction);
    let (cos, sin) = (libm::cos(0.5 * turned), libm::sin(0.5 * turned));
    // The length of crease for which this row of links stands: those at right angles count most.
    let all: f64 = DIRECTIONS
        .into_iter()
        .map(|(dx, dy)| {
            let hop = DVec2::new(dx as f64, dy as f64) * spacing;
            let across = hop.normalize().perp_dot(line.normalize());
            across * across
        })
        .sum();
    let between_rows = spacing.x * spacing.y / hop.length();
    let stands_for = across * across / all * between_rows / across;
    let torque = crease.stiffness * stands_for / (share * across * across);
    let k = torque / (length * length * (0.25 * sin * sin + 0.0625 * cos * cos));
    Some(CreaseLink {
        at,
        direction,
        rest: length * cos,
        height: 0.5 * length * sin * crease.angle.signum(),
        k,
        k_b,
        c_b,
    })
}

/// The particles of a link and where they are.
struct Fold {
    a: DVec3,
    m: DVec3,
    b: DVec3,
    p: DVec3,
    q: DVec3,
}

impl Fold {
    /// The height of m, and how it changes as a, m, b, p, q move.
    fn height(&self) -> (f64, [DVec3; 5]) {
        let s = self.m - 0.5 * (self.a + self.b);
        let (e, g) = (self.b - self.a, self.q - self.p);
        let n = e.cross(g);
        let size = n.length();
        if size <= 0.0 {
            return (0.0, [DVec3::ZERO; 5]);
        }
        let n = n / size;
        let h = s.dot(n);
        let t = (s - h * n) / size;
        let (of_e, of_g) = (g.cross(t), t.cross(e));
        (h, [-0.5 * n - of_e, n, -0.5 * n + of_e, -of_g, of_g])
    }
}

impl CreaseLink {
    /// Takes the link that it replaces out of `links`.
    pub fn take_from(&self, links: &mut Links) {
        for plane in [K_B, C_B] {
            *links
                .stiffness
                .get_mut(self.at.0, self.at.1, plane + self.direction) = 0.0;
        }
    }

    /// a, m, b, p and q on the grid. p and q lie across so that N points out of the front; at the edge
    /// of the cloth, the particle between stands for the one that is missing.
    fn places(&self, (nx, ny): (usize, usize)) -> [(usize, usize); 5] {
        let (dx, dy) = DIRECTIONS[self.direction];
        let go = |(x, y): (usize, usize), dx: isize, dy: isize| {
            let x = x.checked_add_signed(dx).filter(|x| *x < nx);
            let y = y.checked_add_signed(dy).filter(|y| *y < ny);
            x.zip(y)
        };
        let m = go(self.at, dx, dy).unwrap_or(self.at);
        let b = go(self.at, 2 * dx, 2 * dy).unwrap_or(m);
        let p = go(m, -dy, dx).unwrap_or(m);
        let q = go(m, dy, -dx).unwrap_or(m);
        [self.at, m, b, p, q]
    }

    fn fold(&self, x: &Rows, places: [(usize, usize); 5]) -> Fold {
        let _ = self;
        let [a, m, b, p, q] = places.map(|(i, j)| x.vector(i, j));
        Fold { a, m, b, p, q }
    }

    /// How far the fold is from its side and height, m; nothing beyond.
    fn lacks(&self, h: f64) -> f64 {
        (self.height.abs() - h * self.height.signum()).max(0.0)
    }

    /// The energy of the link, J.
    pub fn energy(&self, x: &Rows) -> f64 {
        let fold = self.fold(x, self.places((x.nx, x.ny)));
        let r = (fold.b - fold.a).length();
        let lacks = self.lacks(fold.height().0);
        stretch_energy(r, self.rest, self.k)
            + bend_energy(r, self.rest, self.k_b, self.c_b)
            + 0.5 * self.k * lacks * lacks
    }

    /// The turning of the cloth at the link, rad, positive where the front is outside.
    pub fn turned(&self, x: &Rows) -> f64 {
        let fold = self.fold(x, self.places((x.nx, x.ny)));
        let (one, two) = (fold.m - fold.a, fold.b - fold.m);
        let cos = one.dot(two) / (one.length() * two.length());
        libm::acos(cos.clamp(-1.0, 1.0)) * fold.height().0.signum()
    }

    /// Adds the link's forces to `force` (N), and to `response` its blocks for an implicit step with
    /// α, leaving out what would make it indefinite.
    pub fn respond(&self, x: &Rows, force: &mut Rows, response: &mut Response, alpha: f64) {
        let places = self.places((x.nx, x.ny));
        let fold = self.fold(x, places);
        let along = fold.b - fold.a;
        let r = along.length();
        let n = along.normalize_or_zero();
        let (pull, push) = (
            stretch(r, self.rest, self.k),
            bend(r, self.rest, self.k_b, self.c_b),
        );
        let Pull {
            force: f,
            stiffness,
        } = Pull {
            force: pull.force + push.force,
            stiffness: pull.stiffness + push.stiffness,
        };
        let mut add = |(i, j): (usize, usize), by: DVec3| {
            let old = force.vector(i, j);
            force.set_vector(i, j, old + by);
        };
        add(places[0], f * n);
        add(places[2], -f * n);
        let (h, slopes) = fold.height();
        let lacks = self.lacks(h);
        let strength = self.k * lacks * self.height.signum();
        for (place, slope) in places.into_iter().zip(slopes) {
            add(place, strength * slope);
        }
        let chord = block(n, alpha * stiffness, alpha * f.max(0.0) / r.max(1e-12));
        let side = if lacks > 0.0 {
            block(slopes[1].normalize_or_zero(), alpha * self.k, 0.0)
        } else {
            [0.0; BLOCK]
        };
        let (ax, ay) = places[0];
        let (mx, my) = places[1];
        for plane in 0..BLOCK {
            let at = BLOCK * self.direction + plane;
            *response.bend_blocks.get_mut(ax, ay, at) += (chord[plane] - 0.25 * side[plane]) as f32;
            *response.stretch_blocks.get_mut(ax, ay, at) += (0.5 * side[plane]) as f32;
            *response.stretch_blocks.get_mut(mx, my, at) += (0.5 * side[plane]) as f32;
        }
    }
}
