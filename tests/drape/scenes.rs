//! The bundled drapes.

use std::sync::Mutex;

use bevy::math::DVec3;
use dyelapse::drape::drape::Drape;
use dyelapse::drape::scenes::{names, parse, text};
use dyelapse::scenario::check::Checker;

use super::{advance, assert_whole};

/// A bundled drape, with every `coarser`th of its particles.
fn scene(name: &str, coarser: usize) -> Drape {
    let mut spec = parse(text(name).expect("it is bundled")).expect("it can be read");
    let (nx, ny) = spec.particles;
    spec.particles = ((nx - 1) / coarser + 1, (ny - 1) / coarser + 1);
    spec.build((0.8, 0.9), 1, &Checker::root())
        .expect("it can be made")
}

fn is_whole_after_ten_seconds(name: &str, coarser: usize) {
    let mut cloth = scene(name, coarser);
    let mut most = 0.0_f64;
    for second in 0..10 {
        advance(&mut cloth, 1.0);
        assert_whole(&cloth, &format!("{name} after {} s", second + 1));
        most = most.max(cloth.stretched());
    }
    println!(
        "{name}, 1/{coarser}: stretched by {:.2} % at most",
        100.0 * most
    );
    assert!(most <= 0.05, "{name}: {most}");
}

#[test]
fn every_bundled_drape_is_whole_after_ten_seconds() {
    assert!(names().len() >= 6);
    for name in names() {
        is_whole_after_ten_seconds(name, 4);
    }
}

#[test]
#[ignore = "takes a minute: cargo test --release --no-default-features --test drape -- --ignored"]
fn every_bundled_drape_with_all_its_particles_is_whole_after_ten_seconds() {
    // A thread for each scene costs less than all threads for one; two are as many as memory feeds.
    let mut left = names();
    // What takes longest comes first.
    left.sort_by_key(|name| scene(name, 1).positions().len());
    let left = Mutex::new(left);
    let one_after_another = || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.expect("a thread");
        loop {
            let next = left.lock().expect("no scene has failed").pop();
            let Some(name) = next else { break };
            pool.install(|| is_whole_after_ten_seconds(name, 1));
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(one_after_another);
        scope.spawn(one_after_another);
    });
}

#[test]
fn cloth_on_two_pegs_sags_between_them() {
    let mut cloth = scene("hanging", 2);
    advance(&mut cloth, 3.0);
    let nx = cloth.sheet().links.particles.0;
    let edge = &cloth.positions()[..nx];
    let pegs = 0.5 * (edge[0].y + edge[nx - 1].y);
    let sag = pegs - edge[nx / 2].y;
    assert!((0.05..0.3).contains(&sag), "{sag}");
}

#[test]
fn a_tablecloth_hangs_in_folds() {
    let mut cloth = scene("tablecloth", 2);
    advance(&mut cloth, 3.0);
    // Around the table, 5 cm below its edge, the cloth comes and goes.
    let mut ring: Vec<(f64, f64)> = cloth
        .positions()
        .iter()
        .filter(|x| (0.62..0.68).contains(&x.y))
        .map(|x| (x.z.atan2(x.x), DVec3::new(x.x, 0.0, x.z).length()))
        .collect();
    ring.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = ring.iter().map(|r| r.1).sum::<f64>() / ring.len() as f64;
    let crossings = ring.windows(9).filter(|w| {
        let side = |r: &[(f64, f64)]| r.iter().map(|r| r.1).sum::<f64>() > mean * r.len() as f64;
        side(&w[..8]) != side(&w[1..])
    });
    assert!(crossings.count() >= 8, "folds");
}

#[test]
fn pulled_cloth_wrinkles_and_does_not_only_stretch() {
    let mut cloth = scene("pulled", 2);
    advance(&mut cloth, 2.5);
    // Off the table at many places, not only at the point that is pulled.
    let raised = cloth.positions().iter().filter(|x| x.y > 0.755).count();
    assert!(raised * 20 > cloth.positions().len(), "{raised}");
    assert!(cloth.stretched() < 0.05);
}
