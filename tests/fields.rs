//! The NumPy archives: every array that is promised, in the promised shape, and enough to compute
//! the next state from.
#![allow(clippy::disallowed_methods)] // A test may use the platform's own functions.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use dyelapse::record::{Options, record};
use dyelapse::scenario::{Experiment, Origin};
use npyz::{Deserialize, NpyFile};
use zip::ZipArchive;

fn array<T: Deserialize>(file: &Path, name: &str) -> (Vec<u64>, Vec<T>) {
    let mut archive = ZipArchive::new(File::open(file).unwrap()).unwrap();
    let mut bytes = Vec::new();
    let mut entry = archive.by_name(&format!("{name}.npy")).unwrap();
    entry.read_to_end(&mut bytes).unwrap();
    let npy = NpyFile::new(&bytes[..]).unwrap();
    (npy.shape().to_vec(), npy.into_vec().unwrap())
}

fn field(file: &Path, name: &str, shape: &[u64]) -> Vec<f64> {
    let (found, values) = array::<f32>(file, name);
    assert_eq!(found, shape, "{name}");
    values.into_iter().map(f64::from).collect()
}

fn scalar(file: &Path, name: &str) -> f64 {
    let (shape, values) = array::<f64>(file, name);
    assert!(shape.is_empty(), "{name}");
    values[0]
}

const NX: usize = 33;
const NY: usize = 21;

fn recorded(folder: &Path) {
    let text = "(
        title: \"fields\", seed: 11,
        cloth: (
            size: (Cells(33), Cells(21)), weave: Satin(shafts: 5, counter: 2),
            warp: (width: Cells(3), gap: Cells(1), vary_porosity: (0.5, 1.0)),
            weft: (width: Cells(2), gap: Cells(1), twist: 0.7),
            paths: (between_layers: 0.4, across_yarn: 0.5, yarn_to_gap: 0.3),
        ),
        supply: [Hold(shape: Disc(diameter: Cells(9)), dose: 0.9, until: Steps(40))],
        resist: Strength(of: Noise(grain: Cells(5)), by: 0.9),
        process: (duration: Steps(80), solver: Explicit),
        record: (frames: 3),
    )";
    let experiment = Experiment::parse("fields", Origin::Memory, text.into()).unwrap();
    let options = Options {
        out: folder.into(),
        fields: true,
        ..Options::default()
    };
    record(&experiment, &options, |_| true).unwrap();
}

#[test]
fn one_state_and_the_cloth_are_enough_to_compute_the_next_state() {
    let folder = tempfile::tempdir().unwrap();
    recorded(folder.path());
    let cloth = folder.path().join("cloth.npz");
    let (nx, ny) = (NX as u64, NY as u64);
    let face_x = field(&cloth, "face_x", &[2, ny, nx - 1]);
    let face_y = field(&cloth, "face_y", &[2, ny - 1, nx]);
    let face_z = field(&cloth, "face_z", &[ny, nx]);
    let v_u = field(&cloth, "capacity_free", &[2, ny, nx]);
    let scale = scalar(&cloth, "dt_h") / scalar(&cloth, "cell_mm").powi(2);
    let state = |i: usize| folder.path().join(format!("state_{i:05}.npz"));
    let whole = [2, ny, nx];

    let layer = NX * NY;
    for (from, to, is_held) in [(0, 1, true), (1, 2, false)] {
        let mut phi = field(&state(from), "free", &whole);
        let held = field(&state(from), "held", &whole);
        assert_eq!(held.iter().any(|amount| !amount.is_nan()), is_held);
        for _ in 0..40 {
            let c: Vec<f64> = phi.iter().zip(&v_u).map(|(phi, v)| phi / v).collect();
            let mut flow = |i: usize, j: usize, d: f64| {
                let amount = scale * d * v_u[i].min(v_u[j]) * (c[j] - c[i]);
                phi[i] += amount;
                phi[j] -= amount;
            };
            for l in 0..2 {
                for y in 0..NY {
                    for x in 0..NX {
                        let i = l * layer + y * NX + x;
                        if x + 1 < NX {
                            flow(i, i + 1, face_x[(l * NY + y) * (NX - 1) + x]);
                        }
                        if y + 1 < NY {
                            flow(i, i + NX, face_y[(l * (NY - 1) + y) * NX + x]);
                        }
                        if l == 0 {
                            flow(i, i + layer, face_z[y * NX + x]);
                        }
                    }
                }
            }
            for (phi, held) in phi.iter_mut().zip(&held) {
                if !held.is_nan() {
                    *phi = *held;
                }
            }
        }
        for (computed, recorded) in phi.iter().zip(field(&state(to), "free", &whole)) {
            assert!(
                (computed - recorded).abs() < 1e-6,
                "{computed} and {recorded}"
            );
        }
    }
}

#[test]
fn the_cloth_archive_describes_the_cloth() {
    let folder = tempfile::tempdir().unwrap();
    recorded(folder.path());
    let cloth = folder.path().join("cloth.npz");
    let whole = [2, NY as u64, NX as u64];
    let porosity = field(&cloth, "porosity", &whole);
    let resist = field(&cloth, "resist", &whole);
    let v_u = field(&cloth, "capacity_free", &whole);
    let v_d = field(&cloth, "capacity_bound", &whole);
    let (shape, fibre) = array::<bool>(&cloth, "fibre");
    assert_eq!(shape, whole);
    let (shape, warp_up) = array::<bool>(&cloth, "warp_up");
    assert_eq!(shape, [NY as u64, NX as u64]);
    for i in 0..porosity.len() {
        let (y, x) = (i / NX % NY, i % NX);
        let is_weft = i < NX * NY;
        // Three of four columns are warp yarn, two of three rows weft yarn.
        let yarn = if is_weft { y % 3 < 2 } else { x % 4 < 3 };
        assert_eq!(fibre[i], yarn);
        assert!((v_u[i] - porosity[i] * (1.0 - resist[i])).abs() < 1e-6);
        let bound = if yarn { 1.0 - porosity[i] } else { 0.0 };
        assert!((v_d[i] - bound).abs() < 1e-6);
        let (e, p) = (x / 4, y / 3);
        assert_eq!(warp_up[y * NX + x], e % 5 == 2 * p % 5);
    }
    let (_, step) = array::<i64>(&folder.path().join("state_00002.npz"), "step");
    assert_eq!(step, [80]);
    assert_eq!(
        scalar(&folder.path().join("state_00002.npz"), "time_h"),
        0.04
    );
}
