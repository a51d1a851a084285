//! From what a scenario says to a cloth that can move.

use std::f64::consts::{FRAC_PI_2, TAU};

use bevy::math::{DQuat, DVec2, DVec3};

use super::collide::colliders::{Colliders, Exact};
use super::collide::mesh::Mesh;
use super::collide::topology::Topology;
use super::crease::{Crease, press};
use super::drape::{Drape, Settings, Sheet};
use super::exact::{crossings, sunk};
use super::pins::Pin;
use super::spec::{ColliderSpec, DrapeSpec, Fold, Hold, Outline, Start, Xyz};
use super::weights::assemble;
use super::wind::{AIR_DENSITY, Wind};
use crate::chance::{Chance, Purpose};
use crate::scenario::check::{Checker, Problem};

/// Flat pieces around a round table.
const AROUND: usize = 96;

/// Flat pieces over a rounded edge.
const OVER_EDGE: usize = 4;

/// Cells are cut by the outline with this many strips.
const STRIPS: usize = 16;

fn vector((x, y, z): Xyz) -> DVec3 {
    DVec3::new(x, y, z)
}

impl DrapeSpec {
    /// The cloth, ready to move. `dyed_m` is the size of the dyed cloth, which it has unless it says
    /// otherwise; `at` is where the spec stands, for messages.
    ///
    /// # Errors
    /// A [`Problem`] if a value is not possible, or the cloth begins inside something.
    pub fn build(&self, dyed_m: (f64, f64), seed: u64, at: &Checker) -> Result<Drape, Problem> {
        self.check(at)?;
        let size = self.size_m.unwrap_or(dyed_m);
        self.check_cells(size, &at.field("particles"))?;
        let (nx, ny) = self.particles;
        let spacing = (size.0 / (nx - 1) as f64, size.1 / (ny - 1) as f64);
        let area = self.cell_areas(size, spacing);
        let measured = self.material.measured();
        let (mass, mut links) = assemble(&measured.in_si(), self.particles, spacing, &area);
        let topology = Topology::new(self.particles, |x, y| area[y * (nx - 1) + x] > 0.0);
        let creases: Vec<Crease> = self
            .creases
            .iter()
            .map(|crease| {
                let on_cloth = |(u, v): (f64, f64)| DVec2::new(u * size.0, v * size.1);
                let mean = 0.5 * (measured.bending.0 + measured.bending.1);
                let side = match crease.fold {
                    Fold::Mountain => 1.0,
                    Fold::Valley => -1.0,
                };
                Crease {
                    from: on_cloth(crease.from),
                    to: on_cloth(crease.to),
                    angle: side * crease.angle.to_radians(),
                    stiffness: crease.stiffness.unwrap_or(mean / 0.002),
                }
            })
            .collect();
        let creases = press(&mut links, &creases);
        let x = self.start_positions(size, seed);
        let colliders = self.colliders();
        self.check_start(&x, &topology, &colliders, &at.field("start"))?;
        let solver = &self.solver;
        let settings = Settings {
            integrator: solver.integrator,
            step: solver.step_s,
            tolerance: solver.tolerance,
            iterations: solver.iterations,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            air: if solver.air { AIR_DENSITY } else { 0.0 },
            thickness: 1e-3 * solver.apart_mm,
            friction: measured.friction,
            itself: solver.itself,
            locks_at: measured.locks_at(size.0.max(size.1)),
        };
        let sheet = Sheet {
            links,
            creases,
            mass,
            topology,
            area,
        };
        let pins = self.pins(size, &sheet);
        let mut drape = Drape::new(settings, sheet, x, colliders);
        drape.pins = pins;
        if let Some(wind) = &self.wind {
            drape.wind = Wind::new(vector(wind.velocity), wind.gusts, seed);
        }
        Ok(drape)
    }

    /// How much cloth there is in every cell, m².
    fn cell_areas(&self, size: (f64, f64), (dx, dy): (f64, f64)) -> Vec<f64> {
        let (across, down) = (self.particles.0 - 1, self.particles.1 - 1);
        let cell = |i: usize| {
            let (x, y) = ((i % across) as f64, (i / across) as f64);
            match self.outline {
                Outline::Rectangle => dx * dy,
                Outline::Ellipse => {
                    let strips = (0..STRIPS).map(|strip| {
                        let v = dy * (y + (strip as f64 + 0.5) / STRIPS as f64) / size.1;
                        let half = (0.25 - (v - 0.5) * (v - 0.5)).max(0.0).sqrt();
                        let (left, right) = (size.0 * (0.5 - half), size.0 * (0.5 + half));
                        (right.min((x + 1.0) * dx) - left.max(x * dx)).max(0.0)
                    });
                    strips.sum::<f64>() * dy / STRIPS as f64
                }
            }
        };
        let areas: Vec<f64> = (0..across * down).map(cell).collect();
        // Slivers would be too light to compute with.
        let least = 0.05 * dx * dy;
        areas
            .into_iter()
            .map(|a| if a < least { 0.0 } else { a })
            .collect()
    }

    fn start_positions(&self, (width, height): (f64, f64), seed: u64) -> Vec<DVec3> {
        let (nx, ny) = self.particles;
        let uneven = Uneven::new(1e-3 * self.solver.uneven_mm, width.max(height), seed);
        let place = |i: usize| {
            let u = (i % nx) as f64 / (nx - 1) as f64 - 0.5;
            let v = (i / nx) as f64 / (ny - 1) as f64;
            let (x, y) = (u * width, v * height);
            let off = uneven.at(x, y);
            match self.start {
                Start::Flat { centre_m, turn } => {
                    let flat = DVec3::new(x, off, y - 0.5 * height);
                    vector(centre_m) + DQuat::from_rotation_y(turn.to_radians()) * flat
                }
                Start::Hanging { top_m, turn } => {
                    let upright = DVec3::new(x, -y, off);
                    vector(top_m) + DQuat::from_rotation_y(turn.to_radians()) * upright
                }
                Start::Sphere { centre_m, radius_m } => {
                    let longitude = x / radius_m;
                    let latitude = ((0.5 * height - y) / radius_m).clamp(-FRAC_PI_2, FRAC_PI_2);
                    let (sin, cos) = (libm::sin(latitude), libm::cos(latitude));
                    let out =
                        DVec3::new(cos * libm::sin(longitude), sin, cos * libm::cos(longitude));
                    vector(centre_m) + radius_m * out
                }
            }
        };
        (0..nx * ny).map(place).collect()
    }

    fn colliders(&self) -> Colliders {
        let (mut exact, mut mesh) = (Vec::new(), Mesh::default());
        for collider in &self.on {
            match collider {
                ColliderSpec::Floor { height_m } => exact.push(Exact::Floor(*height_m)),
                ColliderSpec::Ball { centre_m, radius_m } => exact.push(Exact::Ball {
                    centre: vector(*centre_m),
                    radius: *radius_m,
                }),
                ColliderSpec::RoundTable {
                    centre_m,
                    radius_m,
                    thickness_m,
                    edge_m,
                } => {
                    let ring = |inwards: f64| round(*radius_m - inwards);
                    mesh.add(&table(ring, *thickness_m, *edge_m).moved(vector(*centre_m)));
                }
                ColliderSpec::SquareTable {
                    centre_m,
                    size_m,
                    thickness_m,
                    edge_m,
                } => {
                    let ring = |inwards: f64| rectangle(*size_m, *edge_m, inwards);
                    mesh.add(&table(ring, *thickness_m, *edge_m).moved(vector(*centre_m)));
                }
                ColliderSpec::Mesh {
                    corners_m,
                    triangles,
                } => mesh.add(&Mesh {
                    corners: corners_m.iter().map(|corner| vector(*corner)).collect(),
                    triangles: triangles.iter().map(|(a, b, c)| [*a, *b, *c]).collect(),
                }),
            }
        }
        Colliders::new(exact, mesh)
    }

    /// Nothing passes through anything if nothing does in the beginning.
    fn check_start(
        &self,
        x: &[DVec3],
        topology: &Topology,
        colliders: &Colliders,
        at: &Checker,
    ) -> Result<(), Problem> {
        let triangles = topology.triangles();
        if !sunk(x, &triangles, colliders).is_empty() {
            let what = "the cloth begins inside a floor or a ball; it must begin outside";
            return Err(at.problem(what.into()));
        }
        if !crossings(x, &triangles, &colliders.mesh).is_empty() {
            let what =
                "the cloth begins in the way of itself or of a table or mesh; it must begin free";
            return Err(at.problem(what.into()));
        }
        Ok(())
    }

    fn pins(&self, (width, height): (f64, f64), sheet: &Sheet) -> Vec<Pin> {
        let (nx, ny) = self.particles;
        let is_there = |i: &usize| sheet.topology.has_particle(i % nx, i / nx);
        let place = |i: usize| {
            let (x, y) = ((i % nx) as f64, (i / nx) as f64);
            DVec2::new(x / (nx - 1) as f64 * width, y / (ny - 1) as f64 * height)
        };
        let on_cloth = |(u, v): (f64, f64)| DVec2::new(u * width, v * height);
        self.pins
            .iter()
            .map(|pin| {
                let distance = |i: usize| match pin.at {
                    Hold::All => 0.0,
                    Hold::Point(u, v) => place(i).distance(on_cloth((u, v))),
                    Hold::Line(from, to) => from_line(place(i), on_cloth(from), on_cloth(to)),
                };
                let all = (0..nx * ny).filter(is_there);
                let nearest = all.clone().map(distance).fold(f64::INFINITY, f64::min);
                let reach = pin.radius_m.max(nearest * (1.0 + 1e-9));
                let path = pin.path.iter();
                Pin {
                    particles: all.filter(|i| distance(*i) <= reach).collect(),
                    from: pin.from_s,
                    until: pin.until_s.unwrap_or(f64::INFINITY),
                    path: path.map(|(moment, to)| (*moment, vector(*to))).collect(),
                }
            })
            .collect()
    }
}

/// How far a place is from a straight line.
fn from_line(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let ab = b - a;
    let length = ab.length_squared();
    let share = if length > 0.0 {
        ((p - a).dot(ab) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a + share * ab)
}

/// A circle, clockwise seen from above.
fn round(radius: f64) -> Vec<(f64, f64)> {
    let turn = |i: usize| TAU * i as f64 / AROUND as f64;
    (0..AROUND)
        .map(|i| (radius * libm::cos(turn(i)), radius * libm::sin(turn(i))))
        .collect()
}

/// A rectangle with corners rounded by `edge`, moved inwards, clockwise seen from above.
fn rectangle((width, depth): (f64, f64), edge: f64, inwards: f64) -> Vec<(f64, f64)> {
    let (x, z) = (0.5 * width - edge, 0.5 * depth - edge);
    let radius = edge - inwards;
    let corners = [(x, z, 0.0), (-x, z, 1.0), (-x, -z, 2.0), (x, -z, 3.0)];
    let corner = |(x, z, quarter): (f64, f64, f64)| {
        (0..=OVER_EDGE).map(move |i| {
            let turn = FRAC_PI_2 * (quarter + i as f64 / OVER_EDGE as f64);
            (x + radius * libm::cos(turn), z + radius * libm::sin(turn))
        })
    };
    if edge > 0.0 {
        corners.into_iter().flat_map(corner).collect()
    } else {
        corners.into_iter().map(|(x, z, _)| (x, z)).collect()
    }
}

/// A slab whose upper and lower edges are rounded, its upper side at height 0.
fn table(ring: impl Fn(f64) -> Vec<(f64, f64)>, thickness: f64, edge: f64) -> Mesh {
    // Rounding that would bring the points of a ring together stops short of it.
    let most = 0.98 * edge;
    let mut profile = Vec::new();
    if edge > 0.0 {
        for i in 0..=OVER_EDGE {
            let turn = FRAC_PI_2 * i as f64 / OVER_EDGE as f64;
            let inwards = (edge * (1.0 - libm::sin(turn))).min(most);
            profile.push((inwards, -edge * (1.0 - libm::cos(turn))));
        }
        let below = |(inwards, height): &(f64, f64)| (*inwards, -thickness - height);
        let lower: Vec<_> = profile.iter().rev().map(below).collect();
        profile.extend(lower);
    } else {
        profile.extend([(0.0, 0.0), (0.0, -thickness)]);
    }
    Mesh::slab(ring, &profile)
}

/// Slight waves of cloth that is never quite flat.
struct Uneven {
    waves: Vec<(f64, DVec2, f64)>,
}

impl Uneven {
    fn new(height: f64, size: f64, seed: u64) -> Self {
        const WAVES: usize = 8;
        let mut draw = Chance(seed).sequence(Purpose::Unevenness);
        let waves = (0..WAVES).map(|i| {
            let number = TAU * (1.0 + i as f64) / size;
            let (turn, phase) = (TAU * draw.unit(), TAU * draw.unit());
            let way = DVec2::new(libm::cos(turn), libm::sin(turn));
            (height / WAVES as f64, number * way, phase)
        });
        Uneven {
            waves: waves.collect(),
        }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let place = DVec2::new(x, y);
        let wave = |(height, number, phase): &(f64, DVec2, f64)| {
            height * libm::sin(number.dot(place) + phase)
        };
        self.waves.iter().map(wave).sum()
    }
}
