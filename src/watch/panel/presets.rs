//! Presets: yarns, dyes, isotherms, techniques, cameras.

use ron::extensions::Extensions;

use crate::scenario::{
    AdsorptionSpec, CameraSpec, Colours, Isotherm, Length, Scenario, YarnLook, YarnSpec, bundled,
};

/// Bundled scenarios whose resists can be taken.
pub(super) const RESISTS: [&str; 7] = [
    "seikaiha", "kanoko", "itajime", "arashi", "kumo", "kiku", "moonrise",
];

/// A bundled scenario.
pub(super) fn scenario(name: &str) -> Option<Scenario> {
    let found = bundled().find(|bundled| bundled.name == name)?;
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(found.text).ok()
}

/// Kinds of yarn, and how they look.
pub(super) const YARNS: [&str; 6] = [
    "fine cotton",
    "coarse cotton",
    "coarse linen",
    "silk",
    "wool",
    "slub yarn",
];

/// A yarn of one of these kinds: its cells, its fibres, and how it looks.
pub(super) fn yarn(kind: usize) -> (YarnSpec, YarnLook) {
    // width and gap in cells, porosity and its variation, twist, variation of width
    let (width, gap, porosity, vary_porosity, twist, vary_width) = match kind {
        0 => (3.0, 1.0, 0.55, (0.8, 1.0), 1.0, (1.0, 1.0)),
        1 => (8.0, 2.0, 0.5, (0.5, 1.0), 0.8, (0.9, 1.1)),
        2 => (10.0, 2.0, 0.45, (0.5, 1.0), 1.0, (0.75, 1.25)),
        3 => (3.0, 0.0, 0.6, (0.9, 1.0), 1.0, (1.0, 1.0)),
        4 => (7.0, 2.0, 0.65, (0.7, 1.0), 0.9, (0.9, 1.15)),
        _ => (6.0, 1.0, 0.5, (0.4, 1.0), 0.9, (0.5, 1.8)),
    };
    let spec = YarnSpec {
        width: Length::Cells(width),
        gap: Length::Cells(gap),
        vary_width,
        porosity,
        vary_porosity,
        twist,
        ..YarnSpec::default()
    };
    // turn, fibres, roughness, unevenness, hairiness, lustre
    let (turn, fibres, roughness, unevenness, hairiness, lustre) = match kind {
        0 => (5.0, 44, 0.25, 0.25, 0.25, 0.0),
        1 => (5.0, 60, 0.3, 0.4, 0.4, 0.0),
        2 => (7.0, 50, 0.4, 0.7, 0.3, 0.15),
        3 => (12.0, 80, 0.1, 0.1, 0.0, 0.8),
        4 => (4.0, 40, 0.35, 0.4, 0.9, 0.05),
        _ => (6.0, 44, 0.4, 1.0, 0.5, 0.0),
    };
    let look = YarnLook {
        turn,
        fibres,
        roughness,
        unevenness,
        hairiness,
        lustre,
    };
    (spec, look)
}

/// Colours beside those that have a name of their own.
pub(super) const DYES: [(&str, Colours); 9] = [
    ("indigo", Colours::Indigo),
    ("madder", Colours::Madder),
    ("walnut", Colours::Walnut),
    (
        "safflower",
        stops((38.0, 0.05, 0.97), (4.0, 0.78, 0.80), (352.0, 0.88, 0.52)),
    ),
    (
        "gardenia",
        stops((48.0, 0.06, 0.97), (44.0, 0.70, 0.95), (36.0, 0.90, 0.72)),
    ),
    (
        "gromwell",
        stops((45.0, 0.04, 0.97), (330.0, 0.45, 0.70), (310.0, 0.70, 0.28)),
    ),
    (
        "green",
        stops((60.0, 0.06, 0.97), (150.0, 0.45, 0.60), (168.0, 0.75, 0.26)),
    ),
    (
        "iron black",
        stops((40.0, 0.05, 0.97), (32.0, 0.12, 0.45), (220.0, 0.15, 0.12)),
    ),
    (
        "cochineal",
        stops((30.0, 0.03, 0.98), (340.0, 0.62, 0.78), (336.0, 0.85, 0.38)),
    ),
];

type Hsv = (f64, f64, f64);

const fn stops(lightest: Hsv, middle: Hsv, darkest: Hsv) -> Colours {
    Colours::Stops {
        lightest,
        middle,
        darkest,
    }
}

/// Dyes by their molar mass, g/mol.
pub(super) const MOLECULES: [(&str, f64); 6] = [
    ("indigo", 262.27),
    ("alizarin (madder)", 240.21),
    ("juglone (walnut)", 174.15),
    ("carthamin (safflower)", 910.78),
    ("crocin (gardenia)", 976.97),
    ("carminic acid", 492.39),
];

/// Ways in which dye binds.
pub(super) const BINDINGS: [(&str, AdsorptionSpec); 5] = [
    ("weakly", binds(Isotherm::Partition { k: 0.5 })),
    ("by partition", binds(Isotherm::Partition { k: 1.5 })),
    (
        "like a direct dye",
        binds(Isotherm::Freundlich { k: 0.6, b: 0.5 }),
    ),
    ("like an acid dye", binds(Isotherm::Langmuir { kl: 20.0 })),
    (
        "fast, then full",
        binds(Isotherm::Saturating {
            speed: 0.1,
            most: 0.5,
        }),
    ),
];

const fn binds(isotherm: Isotherm) -> AdsorptionSpec {
    AdsorptionSpec {
        rate: 0.01,
        isotherm,
    }
}

/// Cameras and their ways.
pub(super) const CAMERAS: [(&str, CameraSpec); 6] = [
    ("from the front", still(0.0, 6.0, 1.0)),
    ("from the side", still(35.0, 18.0, 1.0)),
    ("from above", still(0.0, 75.0, 1.0)),
    ("close", still(20.0, 15.0, 0.45)),
    (
        "once around",
        CameraSpec::Orbit {
            from: 0.0,
            to: 360.0,
            elevation: 18.0,
            distance: 1.1,
            at_m: None,
        },
    ),
    (
        "coming nearer",
        CameraSpec::Dolly {
            from: 1.6,
            to: 0.6,
            turn: 25.0,
            elevation: 18.0,
            at_m: None,
        },
    ),
];

const fn still(turn: f64, elevation: f64, distance: f64) -> CameraSpec {
    CameraSpec::Still {
        turn,
        elevation,
        distance,
        at_m: None,
    }
}
