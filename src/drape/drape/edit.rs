//! Going back to a moment, and changing a cloth while it moves.

use bevy::math::{DVec2, DVec3};

use super::super::collide::distance::Pair;
use super::super::crease::{Crease, press};
use super::super::hand::Hand;
use super::super::material::MaterialSpec;
use super::super::pins::Pin;
use super::super::rows::Rows;
use super::super::weights::assemble;
use super::super::wind::Wind;
use super::{Drape, Settings, Sheet, State};

/// All that a cloth needs to come back to a moment, and go on from it as it did.
#[derive(Debug, Clone)]
pub struct Snapshot {
    time: f64,
    state: State,
    pins: Vec<Pin>,
    taken: Vec<Option<Vec<DVec3>>>,
    hands: Vec<Hand>,
    wind: Wind,
    sheet: Sheet,
    settings: Settings,
    guesses: [Rows<f32>; 2],
    pairs: Vec<Pair>,
}

impl Drape {
    /// What it takes to come back to this moment.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            time: self.time,
            state: self.state.clone(),
            pins: self.pins.clone(),
            taken: self.taken.clone(),
            hands: self.hands.clone(),
            wind: self.wind.clone(),
            sheet: self.sheet.clone(),
            settings: self.settings.clone(),
            guesses: self.implicit.guesses.clone(),
            pairs: self.pairs.clone(),
        }
    }

    /// Goes to a moment of the same cloth.
    pub fn restore(&mut self, to: &Snapshot) {
        let to = to.clone();
        self.time = to.time;
        self.state = to.state;
        self.pins = to.pins;
        self.taken = to.taken;
        self.hands = to.hands;
        self.wind = to.wind;
        self.sheet = to.sheet;
        self.settings = to.settings;
        self.implicit.guesses = to.guesses;
        self.pairs = to.pairs;
    }

    /// Fixes a particle where it is, from now on.
    pub fn pin(&mut self, particle: usize) {
        if particle < self.state.x.len() {
            self.pins.push(Pin {
                particles: vec![particle],
                from: self.time,
                until: f64::INFINITY,
                path: Vec::new(),
            });
        }
    }

    /// Takes every pin off a particle; other particles of the same pins stay held.
    pub fn unpin(&mut self, particle: usize) {
        self.taken.resize(self.pins.len(), None);
        for (pin, taken) in self.pins.iter_mut().zip(&mut self.taken) {
            let Some(at) = pin.particles.iter().position(|i| *i == particle) else {
                continue;
            };
            pin.particles.remove(at);
            if let Some(taken) = taken {
                taken.remove(at);
            }
        }
    }

    /// Presses a crease between two places on the cloth (shares of its width and height), folding by
    /// `angle` radians, positive where the front is outside; `stiffness` in N·m/(m·rad). Returns how many
    /// links it crosses: none where it lies on an older crease.
    pub fn add_crease(&mut self, from: DVec2, to: DVec2, angle: f64, stiffness: f64) -> usize {
        let links = &mut self.sheet.links;
        let (nx, ny) = links.particles;
        let size = DVec2::new((nx - 1) as f64, (ny - 1) as f64) * DVec2::from(links.spacing);
        let crease = Crease {
            from: from * size,
            to: to * size,
            angle,
            stiffness,
        };
        if from == to {
            return 0;
        }
        let pressed = press(links, &[crease]);
        let count = pressed.len();
        self.sheet.creases.extend(pressed);
        count
    }

    /// Makes the cloth of another material, on the same grid and where it is. Creases stay as stiff as they
    /// were pressed.
    pub fn set_material(&mut self, material: &MaterialSpec) {
        let Sheet { links, area, .. } = &self.sheet;
        let (particles, spacing) = (links.particles, links.spacing);
        let (mass, mut links) = assemble(&material.in_si(), particles, spacing, area);
        for crease in &self.sheet.creases {
            crease.take_from(&mut links);
        }
        let size = (particles.0 as f64 * spacing.0).max(particles.1 as f64 * spacing.1);
        self.settings.friction = material.friction;
        self.settings.locks_at = material.locks_at(size);
        self.sheet.mass = mass;
        self.sheet.links = links;
    }
}
