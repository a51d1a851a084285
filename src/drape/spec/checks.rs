//! What of a drape's description is possible, and what is wrong with the rest.

use super::{
    ColliderSpec, CreaseSpec, DrapeSpec, FURTHEST, Hold, MOST_PARTICLES, PinSpec, Place,
    SolverSpec, Start, Xyz,
};
use crate::scenario::check::{Checker, Problem};

impl DrapeSpec {
    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        let particles = at.field("particles");
        for (i, n) in [self.particles.0, self.particles.1].into_iter().enumerate() {
            particles.item(i).within(n, 2..=MOST_PARTICLES)?;
        }
        if let Some(size) = self.size_m {
            for (i, length) in [size.0, size.1].into_iter().enumerate() {
                at.field("size_m").item(i).within(length, 1e-4..=100.0)?;
            }
            self.check_cells(size, &particles)?;
        }
        self.material.check(&at.field("material"))?;
        self.start.check(&at.field("start"))?;
        for (i, pin) in self.pins.iter().enumerate() {
            pin.check(&at.field("pins").item(i))?;
        }
        for (i, collider) in self.on.iter().enumerate() {
            collider.check(&at.field("on").item(i))?;
        }
        if let Some(wind) = &self.wind {
            let at = at.field("wind");
            check_xyz(&at.field("velocity"), wind.velocity, 100.0)?;
            at.field("gusts").within(wind.gusts, 0.0..=2.0)?;
        }
        for (i, crease) in self.creases.iter().enumerate() {
            crease.check(&at.field("creases").item(i))?;
        }
        at.field("settle_s").within(self.settle_s, 0.0..=3600.0)?;
        self.solver.check(&at.field("solver"))
    }

    /// Refuses cells so long and thin that diagonals could not stand for shear.
    pub(in crate::drape) fn check_cells(
        &self,
        size: (f64, f64),
        at: &Checker,
    ) -> Result<(), Problem> {
        let (dx, dy) = (
            size.0 / (self.particles.0 - 1) as f64,
            size.1 / (self.particles.1 - 1) as f64,
        );
        if (0.6..=1.0 / 0.6).contains(&(dx / dy)) {
            return Ok(());
        }
        let fitting = (size.1 / dx).round() + 1.0;
        Err(at.problem(format!(
            "particles should be about as far apart across as down, but they are {:.3} mm and {:.3} mm \
             apart; ({}, {fitting}) would do",
            1e3 * dx,
            1e3 * dy,
            self.particles.0
        )))
    }
}

fn check_xyz(at: &Checker, (x, y, z): Xyz, most: f64) -> Result<(), Problem> {
    for (i, value) in [x, y, z].into_iter().enumerate() {
        at.item(i).within(value, -most..=most)?;
    }
    Ok(())
}

fn check_place(at: &Checker, (u, v): Place) -> Result<(), Problem> {
    at.item(0).within(u, 0.0..=1.0)?;
    at.item(1).within(v, 0.0..=1.0)
}

impl Start {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        match *self {
            Start::Flat { centre_m, turn } => {
                check_xyz(&at.field("centre_m"), centre_m, FURTHEST)?;
                at.field("turn").within(turn, -360.0..=360.0)
            }
            Start::Hanging { top_m, turn } => {
                check_xyz(&at.field("top_m"), top_m, FURTHEST)?;
                at.field("turn").within(turn, -360.0..=360.0)
            }
            Start::Sphere { centre_m, radius_m } => {
                check_xyz(&at.field("centre_m"), centre_m, FURTHEST)?;
                at.field("radius_m").within(radius_m, 1e-4..=FURTHEST)
            }
        }
    }
}

impl PinSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        let place = at.field("at");
        match self.at {
            Hold::Point(u, v) => check_place(&place, (u, v))?,
            Hold::Line(from, to) => {
                check_place(&place.item(0), from)?;
                check_place(&place.item(1), to)?;
            }
            Hold::All => {}
        }
        at.field("radius_m").within(self.radius_m, 0.0..=100.0)?;
        at.field("from_s").within(self.from_s, 0.0..=1e6)?;
        if let Some(until) = self.until_s {
            at.field("until_s").within(until, self.from_s..=1e6)?;
        }
        let mut before = 0.0;
        for (i, (moment, to)) in self.path.iter().enumerate() {
            let at = at.field("path").item(i);
            at.item(0).within(*moment, 0.0..=1e6)?;
            if *moment <= before {
                let moments = format!("moments go up, but {moment} s comes after {before} s");
                return Err(at.item(0).problem(moments));
            }
            before = *moment;
            check_xyz(&at.item(1), *to, FURTHEST)?;
        }
        Ok(())
    }
}

impl ColliderSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        let check_slab = |thickness: f64, edge: f64, least: f64| {
            at.field("thickness_m").within(thickness, 1e-4..=FURTHEST)?;
            let most = 0.49 * least.min(2.0 * thickness);
            at.field("edge_m").within(edge, 0.0..=most)
        };
        match self {
            ColliderSpec::Floor { height_m } => {
                at.field("height_m").within(*height_m, -FURTHEST..=FURTHEST)
            }
            ColliderSpec::Ball { centre_m, radius_m } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                at.field("radius_m").within(*radius_m, 1e-4..=FURTHEST)
            }
            ColliderSpec::RoundTable {
                centre_m,
                radius_m,
                thickness_m,
                edge_m,
            } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                at.field("radius_m").within(*radius_m, 1e-3..=FURTHEST)?;
                check_slab(*thickness_m, *edge_m, *radius_m)
            }
            ColliderSpec::SquareTable {
                centre_m,
                size_m,
                thickness_m,
                edge_m,
            } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                for (i, length) in [size_m.0, size_m.1].into_iter().enumerate() {
                    at.field("size_m").item(i).within(length, 1e-3..=FURTHEST)?;
                }
                check_slab(*thickness_m, *edge_m, size_m.0.min(size_m.1))
            }
            ColliderSpec::Mesh {
                corners_m,
                triangles,
            } => {
                for (i, corner) in corners_m.iter().enumerate() {
                    check_xyz(&at.field("corners_m").item(i), *corner, FURTHEST)?;
                }
                if triangles.is_empty() {
                    return Err(at.field("triangles").problem("there is no triangle".into()));
                }
                let last = corners_m.len().saturating_sub(1) as u32;
                for (i, (a, b, c)) in triangles.iter().enumerate() {
                    let at = at.field("triangles").item(i);
                    for (k, corner) in [*a, *b, *c].into_iter().enumerate() {
                        at.item(k).within(corner, 0..=last)?;
                    }
                    if a == b || b == c || a == c {
                        return Err(at.problem("a triangle has three different corners".into()));
                    }
                }
                Ok(())
            }
        }
    }
}

impl CreaseSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        check_place(&at.field("from"), self.from)?;
        check_place(&at.field("to"), self.to)?;
        if self.from == self.to {
            return Err(at
                .field("to")
                .problem("a crease ends where it does not begin".into()));
        }
        // Beyond, the side would no longer be certain: see `crease`.
        at.field("angle").within(self.angle, 1.0..=160.0)?;
        match self.stiffness {
            Some(stiffness) => at.field("stiffness").within(stiffness, 0.0..=1e3),
            None => Ok(()),
        }
    }
}

impl SolverSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("step_s").within(self.step_s, 1e-6..=1.0)?;
        at.field("tolerance").within(self.tolerance, 1e-7..=0.1)?;
        at.field("iterations")
            .within(self.iterations, 1..=100_000)?;
        at.field("apart_mm").within(self.apart_mm, 0.01..=100.0)?;
        at.field("uneven_mm").within(self.uneven_mm, 0.0..=10.0)
    }
}
