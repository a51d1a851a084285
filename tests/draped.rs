//! Draped cloth as it is recorded and exported, end to end.

#[path = "common/program.rs"]
mod program;

use std::fs;

use dyelapse::scenario::{Draping, Experiment, Origin};
use program::{dyelapse, folder, said};

/// A small twill with blue dye in its warp, over a ball.
const SMALL: &str = r#"(
    title: "small",
    cloth: (
        size: (Cells(60), Cells(60)),
        weave: Twill(over: 3, under: 1),
        warp: (width: Cells(3), gap: Cells(1), porosity: 0.6),
        weft: (width: Cells(3), gap: Cells(1), porosity: 0.02),
        paths: (between_layers: 0.0, across_yarn: 0.0, yarn_to_gap: 0.0),
    ),
    supply: [Hold(shape: Everywhere)],
    process: (duration: Steps(40), step_h: 0.0005),
    drape: (
        particles: (17, 17),
        size_m: (0.3, 0.3),
        start: Flat(centre_m: (0, 0.3, 0)),
        on: [Ball(centre_m: (0, 0.2, 0), radius_m: 0.08), Floor()],
        settle_s: 0.1,
    ),
    view: (pixels: (200, 150), moves_s: 0.2),
    record: (frames: 4),
)"#;

fn parse(text: &str) -> Result<Experiment, String> {
    Experiment::parse("small.ron", Origin::Memory, text.into()).map_err(|why| why.to_string())
}

#[test]
fn a_drape_is_named_or_described() {
    let own = parse(SMALL).unwrap().scenario.drape;
    assert!(matches!(own, Some(Draping::Own(spec)) if spec.particles == (17, 17)));
    let (before, rest) = SMALL.split_once("drape: (").unwrap();
    let (_, after) = rest.split_once("settle_s: 0.1,\n    ),").unwrap();
    let named = parse(&format!("{before}drape: \"tablecloth\",{after}")).unwrap();
    let drape = named.scenario.drape;
    assert_eq!(drape, Some(Draping::Bundled("tablecloth".into())));
}

#[test]
fn what_is_wrong_with_a_drape_is_told_with_its_place() {
    for (wrong, right, expected) in [
        ("radius_m: 0.08", "radius_m: -1", "drape.on[0].radius_m"),
        ("settle_s: 0.1", "setle_s: 0.1", "setle_s"),
        (
            "particles: (17, 17)",
            "particles: (1, 17)",
            "drape.particles[0]",
        ),
        (
            "moves_s: 0.2",
            "camera: Still(elevation: 95)",
            "view.camera.elevation",
        ),
        ("pixels: (200, 150)", "pixels: (200, 5)", "view.pixels[1]"),
    ] {
        let why = parse(&SMALL.replace(wrong, right)).unwrap_err();
        assert!(why.contains(expected), "{why}");
        assert!(why.contains("small.ron:"), "no place: {why}");
    }
    let (before, _) = SMALL.split_once("drape: (").unwrap();
    let why = parse(&format!("{before}drape: \"tablecloht\")")).unwrap_err();
    assert!(why.contains("did you mean `tablecloth`"), "{why}");
}

#[test]
fn a_scenario_with_a_drape_survives_being_written_and_read() {
    for text in [
        SMALL,
        dyelapse::scenario::bundled()
            .find(|b| b.name == "pulled_silk")
            .unwrap()
            .text,
    ] {
        let scenario = parse(text).unwrap().scenario;
        let written = ron::to_string(&scenario).unwrap();
        let read: dyelapse::scenario::Scenario = ron::from_str(&written).unwrap();
        assert_eq!(read, scenario);
    }
}

#[test]
fn an_unknown_drape_is_bad_input_and_the_nearest_is_named() {
    let here = folder();
    let mut export = dyelapse(&here);
    let (code, said) = said(export.args(["export", "one_drop", "--drape", "tabelcloth"]));
    assert_eq!(code, 2);
    assert!(said.contains("did you mean `tablecloth`"), "{said}");
    assert!(!here.path().join("one_drop.glb").exists());
}

#[test]
fn the_exported_cloth_is_whole_gltf_with_both_sides() {
    let here = folder();
    fs::write(here.path().join("small.ron"), SMALL).unwrap();
    dyelapse(&here)
        .args(["export", "small.ron"])
        .assert()
        .success();
    let bytes = fs::read(here.path().join("small.glb")).unwrap();
    // Reading it checks it against the standard.
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = gltf.blob.as_deref().unwrap();
    let mesh = gltf.meshes().next().unwrap();
    let mut middles = Vec::new();
    assert_eq!(mesh.primitives().len(), 2);
    for side in mesh.primitives() {
        let reader = side.reader(|_| Some(blob));
        let positions: Vec<_> = reader.read_positions().unwrap().collect();
        let normals: Vec<_> = reader.read_normals().unwrap().collect();
        let uv: Vec<_> = reader.read_tex_coords(0).unwrap().into_f32().collect();
        let tangents = reader.read_tangents().unwrap();
        let indices: Vec<_> = reader.read_indices().unwrap().into_u32().collect();
        let count = positions.len();
        assert!(normals.len() == count && uv.len() == count && tangents.len() == count);
        assert!(indices.iter().all(|i| (*i as usize) < count) && indices.len() % 3 == 0);
        let length = |v: [f32; 3]| v.iter().map(|c| c * c).sum::<f32>().sqrt();
        assert!(normals.iter().all(|n| (length(*n) - 1.0).abs() < 1e-4));
        assert!(uv.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
        // 30 cm of cloth over a ball: in metres, above the floor.
        assert!(
            positions
                .iter()
                .all(|p| p[1] > 0.0 && p[1] < 0.31 && p[0].abs() < 0.16)
        );
        let mut areas = 0.0;
        for t in indices.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| positions[i as usize]);
            let (ab, ac) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let cross = [
                ab[1] * ac[2] - ab[2] * ac[1],
                ab[2] * ac[0] - ab[0] * ac[2],
                ab[0] * ac[1] - ab[1] * ac[0],
            ];
            let normal = normals[t[0] as usize];
            assert!(
                (0..3).map(|i| cross[i] * normal[i]).sum::<f32>() > 0.0,
                "turned inside out"
            );
            areas += 0.5 * length(cross);
        }
        // Yarns do not stretch, so cloth that shears over a ball only loses area.
        assert!((0.06..0.092).contains(&areas), "{areas} m² of 0.09");
        let texture = side.material().pbr_metallic_roughness();
        let texture = texture.base_color_texture().unwrap().texture();
        assert!(side.material().normal_texture().is_some());
        let gltf::image::Source::View { view, mime_type } = texture.source().source() else {
            panic!("the picture is not in the file");
        };
        assert_eq!(mime_type, "image/png");
        let png = &blob[view.offset()..][..view.length()];
        let picture = image::load_from_memory(png).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (60, 60));
        middles.push(mean(&picture));
    }
    // The face shows mostly warp, which took the dye; the back mostly weft, which hardly did.
    assert!(middles[0][0] < middles[1][0] - 15.0, "{middles:?}");
}

fn mean(picture: &image::RgbImage) -> [f64; 3] {
    let count = f64::from(picture.width() * picture.height());
    [0, 1, 2].map(|c| picture.pixels().map(|p| f64::from(p[c])).sum::<f64>() / count)
}

#[cfg(feature = "viewer")]
mod drawn {
    use super::program::{contents, dyelapse, folder, said};
    use super::{SMALL, mean};
    use dyelapse::studio::offscreen::check_driver;
    use std::collections::BTreeSet;
    use std::fs;

    #[test]
    fn without_a_driver_the_packages_are_named_and_nothing_is_written() {
        let here = folder();
        fs::write(here.path().join("small.ron"), SMALL).unwrap();
        let nowhere = here.path().join("no_driver.json");
        let mut record = dyelapse(&here);
        record
            .env("VK_ICD_FILENAMES", &nowhere)
            .env("VK_DRIVER_FILES", &nowhere)
            .env("WGPU_BACKEND", "vulkan")
            .args(["record", "small.ron", "--view", "draped", "--out", "r"]);
        let (code, said) = said(&mut record);
        assert_eq!(code, 2);
        assert!(said.contains("mesa-vulkan-drivers"), "{said}");
        assert!(!here.path().join("r").exists());
    }

    /// Records the small scenario with changes; none where there is no driver, which is told.
    fn recorded(here: &tempfile::TempDir, name: &str, text: &str) -> Option<()> {
        if let Err(why) = check_driver() {
            eprintln!("not drawn: {why}");
            return None;
        }
        let file = format!("{name}.ron");
        fs::write(here.path().join(&file), text).unwrap();
        dyelapse(here)
            .args([
                "record", &file, "--view", "draped", "--out", name, "--quiet",
            ])
            .assert()
            .success();
        Some(())
    }

    #[test]
    fn every_frame_of_draped_cloth_is_there_none_blank_and_none_twice() {
        let here = folder();
        let Some(()) = recorded(&here, "one", SMALL) else {
            return;
        };
        let files = contents(&here.path().join("one"));
        let frames: Vec<_> = files
            .iter()
            .filter(|(name, _)| name.starts_with("frame_"))
            .collect();
        assert_eq!(frames.len(), 4);
        let different: BTreeSet<_> = frames.iter().map(|(_, bytes)| bytes).collect();
        assert_eq!(different.len(), 4);
        for (name, bytes) in frames {
            let picture = image::load_from_memory(bytes).unwrap().to_rgb8();
            assert_eq!(picture.dimensions(), (200, 150));
            let colours: BTreeSet<_> = picture.pixels().map(|p| p.0).collect();
            assert!(colours.len() > 200, "{name} is nearly blank");
        }
        recorded(&here, "two", SMALL).unwrap();
        let again = contents(&here.path().join("two"));
        assert_eq!(files.len(), again.len());
        for (name, bytes) in &files {
            let same = again.get(name).is_some_and(|again| again == bytes);
            // The manifest and the copy of the scenario differ in nothing either.
            assert!(same, "{name} differs");
        }
    }

    #[test]
    fn the_back_of_the_cloth_shows_the_yarns_that_lie_there() {
        let here = folder();
        // Hanging, so that a camera behind it sees nothing else.
        let start = SMALL.find("    drape: (").unwrap();
        let end = SMALL.find("    view: (").unwrap();
        let drape = "    drape: (particles: (9, 9), size_m: (0.2, 0.2), start: Hanging(top_m: (0, 0.3, 0)), \
                     pins: [(at: All)]),\n";
        let seen = ["0", "180"].map(|turn| {
            let camera = format!(
                "pixels: (120, 120), camera: Still(turn: {turn}, elevation: 0, distance: 0.6), \
                 light: (90, 89)"
            );
            let text = format!("{}{drape}{}", &SMALL[..start], &SMALL[end..])
                .replace("pixels: (200, 150), moves_s: 0.2", &camera);
            recorded(&here, &format!("from{turn}"), &text)?;
            let frame = here.path().join(format!("from{turn}/frame_00003.png"));
            Some(mean(&image::open(frame).unwrap().to_rgb8()))
        });
        let [Some(front), Some(back)] = seen else {
            return;
        };
        // Red tells how much blue dye is seen.
        assert!(front[0] < back[0] - 10.0, "{front:?} and {back:?}");
    }
}
