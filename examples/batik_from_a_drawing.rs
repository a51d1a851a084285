//! Batik from a drawing, step by step, with a picture of every step.
//!
//! `cargo run --release --example batik_from_a_drawing -- [FOLDER [DRAWING]]`
//!
//! Pictures go to FOLDER, or to a new one beside the system's temporary files. DRAWING is any line
//! drawing, PNG or JPEG; what is drawn is dyed. Without one a flower is drawn.

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};
use std::time::Instant;

use dyelapse::batik::crackle::{Crackle, CrackleSpec};
use dyelapse::batik::crossings::Crossings;
use dyelapse::batik::drawing::{Drawing, Ground, Waxed};
use dyelapse::batik::ellipse::{EllipseSpec, EllipseWeave};
use dyelapse::batik::mixing::{Dyestuff, Mixture};
use dyelapse::batik::permeation::{PermeationSpec, permeation};
use dyelapse::batik::picture::Colours;
use dyelapse::batik::sweep::{BathSpec, Dye, Exchange, ExchangeSpec, PixelDiffusing};
use dyelapse::batik::wax::{WaxLayer, WaxLook};
use dyelapse::chance::Chance;
use dyelapse::pattern::Raster;
use dyelapse::prelude::*;
use dyelapse::texture::{self, Rgb};
use image::{GrayImage, RgbImage};

/// Cells across and down.
const SIDE: usize = 1024;
/// Scans after which the cloth is looked at: paper B's two.
const SCANS: [usize; 2] = [4, 16];
const SEED: u64 = 3;

/// Paper B's cloth: yarns five cells wide and one apart, P = 0.5r, τ₁ = 0.025r.
const CLOTH: &str = r#"(
    title: "Paper B's cloth",
    cloth: (
        size: (Cells(1024), Cells(1024)),
        warp: (
            width: Cells(5), gap: Cells(1),
            porosity: 0.5, vary_porosity: (0.5, 1.0), twist: 0.025, vary_twist: (0.5, 1.0),
        ),
    ),
    supply: [],
    process: (duration: Steps(1)),
)"#;

/// Undyed cotton, and cotton full of indigo.
const COTTON: Rgb = [0.96, 0.945, 0.90];
const INDIGO: Rgb = [0.09, 0.17, 0.36];

/// A flower of two rings of petals around a seed head: 1 where it is drawn, soft over one cell.
fn flower() -> Raster {
    let soft = |inside: f64| (inside + 0.5).clamp(0.0, 1.0);
    Raster::from_rule(SIDE, SIDE, |x, y| {
        let middle = SIDE as f64 / 2.0;
        let (dx, dy) = (x - middle, y - middle);
        let (radius, angle) = ((dx * dx + dy * dy).sqrt(), libm::atan2(dy, dx));
        // How far inside the edge of a ring of eight petals, in cells.
        let petals = |reach: f64, turn: f64| {
            let edge = reach * (0.7 + 0.3 * libm::cos(4.0 * angle + turn).abs());
            edge - radius
        };
        let (outer, inner) = (petals(420.0, 0.0), petals(250.0, FRAC_PI_2));
        // A vein of wax along the middle of every outer petal.
        let vein = radius * libm::sin(4.0 * angle).abs() / 4.0 - 4.0;
        let vein = if (270.0..370.0).contains(&radius) {
            soft(vein)
        } else {
            1.0
        };
        let ring = soft(outer) * soft(-inner - 9.0) * vein + soft(inner) * soft(radius - 95.0);
        let seeds = soft(82.0 - radius) * soft(18.0 * libm::cos(12.0 * angle) - radius + 62.0);
        (ring + seeds).min(1.0) as f32
    })
}

/// Writes pictures into a folder.
struct Album {
    folder: PathBuf,
}

impl Album {
    fn grey(&self, name: &str, raster: &Raster) -> Result<(), Box<dyn Error>> {
        let bytes = raster.values.iter().map(|v| (255.0 * v + 0.5) as u8);
        let image = GrayImage::from_raw(raster.nx as u32, raster.ny as u32, bytes.collect());
        Ok(image.ok_or("another size")?.save(self.file(name))?)
    }

    fn colours(&self, name: &str, picture: &Colours) -> Result<(), Box<dyn Error>> {
        let (width, height) = (picture.width as u32, picture.height as u32);
        let image = RgbImage::from_raw(width, height, picture.bytes());
        Ok(image.ok_or("another size")?.save(self.file(name))?)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.png"))
    }
}

/// Does something and says how long it took.
fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let result = work();
    println!("{:>7.1} ms  {what}", 1e3 * begin.elapsed().as_secs_f64());
    result
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().map(PathBuf::from);
    let folder = folder.unwrap_or_else(|| std::env::temp_dir().join("dyelapse_batik"));
    std::fs::create_dir_all(&folder)?;
    let album = Album { folder };
    let drawing = match arguments.next() {
        Some(file) => Drawing::load(Path::new(&file), Ground::Detect)?,
        None => Drawing { drawn: flower() },
    };
    let app = dyeing_app(Experiment::from_scenario("batik", ron::from_str(CLOTH)?)?);
    let cloth = app.world().resource::<Cloth>();

    let open = timed("the drawing becomes wax", || {
        drawing.wax(SIDE, SIDE, Waxed::Ground)
    });
    let crackle = timed("the wax cracks", || {
        Crackle::grow(&open, &CrackleSpec::default(), None, Chance(SEED))
    });
    let wax = crackle.over(&open);
    let p = timed("how well it lets dye through", || {
        permeation(&wax, &PermeationSpec::default())
    });
    album.grey("1_drawing", &open)?;
    album.grey("2_crackled", &wax)?;
    album.grey("3_permeation", &p)?;

    let exchange = timed("what cells exchange", || {
        Exchange::of(cloth, &ExchangeSpec::default(), SEED)
    });
    let bath = BathSpec::default();
    let mut diffusing = timed("into the bath", || {
        PixelDiffusing::new(&exchange, &p, &bath, &Dye::none(SIDE, SIDE))
    });
    let full = (1.0 + bath.most_bound) as f32;
    let dye = Dyestuff::of_colour(INDIGO, COTTON, full);
    let mixture = Mixture::new(COTTON, vec![dye]);
    let crossings = Crossings::of(cloth);
    let weave = timed("the weave", || {
        let spec = EllipseSpec::default();
        EllipseWeave::new(&crossings, |y, x| cloth.warp_up(y, x), spec, 1, SEED)
    });
    let layer = timed("the wax as it is seen", || {
        WaxLayer::new(&wax, WaxLook::default(), SEED)
    });
    let mut done = 0;
    for scans in SCANS {
        timed(&format!("{} more scans", scans - done), || {
            (done..scans).for_each(|_| diffusing.scan());
        });
        done = scans;
        let dye = diffusing.dye();
        let picture = timed("the picture", || {
            weave.draw(|y, x| {
                let i = cloth.grid.index(texture::seen(cloth, y, x), y, x);
                mixture.colour(&[dye.free[i] + dye.bound[i]])
            })
        });
        let waxed = timed("with the wax", || layer.over(&picture));
        album.colours(&format!("4_in_wax_after_{scans}_scans"), &waxed)?;
        album.colours(&format!("5_dyed_{scans}_scans"), &picture)?;
        let account = diffusing.account();
        println!(
            "after {scans} scans: {:.0} supplied, {:.0} made in place, {:.0} in the cloth, {} truncated",
            account.supplied,
            account.made,
            dye.total(),
            account.truncated
        );
    }
    println!("pictures are in {}", album.folder.display());
    Ok(())
}
