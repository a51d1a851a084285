//! What a saved scenario says beside its fields.

use super::tree::Node;

/// The owner of what is in a list: it has no field of its own, and says only what it is.
pub(super) const ITEM: &str = "[]";

/// Fields of which nothing is to be said beside what pattern they hold.
const SAID_BY_KIND: [&str; 3] = ["of", "cut", "pattern"];

/// The comment of a field, by the name of what it belongs to: a section (`warp`), or a variant (`Hold`).
pub(super) fn comment(owner: &str, field: &str, value: &Node) -> Option<String> {
    let kind = of_kind(value);
    if owner == ITEM || (kind.is_some() && SAID_BY_KIND.contains(&field)) {
        return kind.map(Into::into);
    }
    let found = FIELDS.iter().find(|(of, name, _)| {
        *name == field && (of.is_empty() || of.split(' ').any(|of| of == owner))
    });
    match (found, kind) {
        (Some((_, _, said)), Some(kind)) => Some(format!("{said}: {kind}")),
        (Some((_, _, said)), None) => Some((*said).into()),
        (None, kind) => kind.map(Into::into),
    }
}

/// What a pattern, an isotherm or a weave is, by the name of its variant.
fn of_kind(value: &Node) -> Option<&'static str> {
    let (Node::Fields(Some(name), _) | Node::Tuple(Some(name), _)) = value else {
        return None;
    };
    let found = KINDS.iter().find(|(of, _)| of == name);
    found.map(|(_, said)| *said)
}

const KINDS: &[(&str, &str)] = &[
    ("Dose", "given once"),
    ("Hold", "kept up while it lasts"),
    ("Bath", "taken up through wax or other cover"),
    ("Wax", "wax is laid on, and cracks"),
    ("Dye", "the cloth hangs in a bath"),
    ("Sections", "dyed in sections"),
    ("Image", "the brightness of a picture beside this file"),
    ("Disc", "a round spot"),
    ("Discs", "spots in rows"),
    ("Rectangle", "a rectangle"),
    ("Stripes", "stripes; an angle of 0° runs down, 90° across"),
    ("Rings", "rings around a middle"),
    ("Rays", "rays from a middle"),
    ("Radial", "a patch that fades outwards"),
    ("Ramp", "from nothing at one edge to all at the other"),
    ("Noise", "clouds of chance"),
    ("Seikaiha", "waves of the blue sea"),
    ("Strokes", "strokes of a brush along their paths"),
    ("Union", "all that is in any of these"),
    ("Intersection", "only what is in all of these"),
    ("Without", "one pattern with another cut out"),
    ("Invert", "the other way round"),
    ("Blur", "with soft edges"),
    ("Strength", "every value multiplied"),
    ("Partition", "in proportion to free dye"),
    ("Freundlich", "k·φᵇ: much even from thin dye"),
    ("Langmuir", "until the fibre is full"),
    ("Saturating", "ever more slowly as fibre fills"),
    ("Twill", "over so many picks and under so many"),
    ("Satin", "one crossing in every so many shafts"),
    ("InWater", "mm²/h"),
    ("MolarMass", "by its molar mass, g/mol"),
];

/// (owner, field, what it says). An empty owner stands for any.
const FIELDS: &[(&str, &str, &str)] = &[
    ("", "title", "what it shows"),
    (
        "",
        "seed",
        "another number gives another cloth of the same kind",
    ),
    // The larger parts.
    ("", "supply", "where and when dye is given"),
    ("", "resist", "where it is squeezed, 0 free to 1 shut"),
    ("", "adsorption", "how dye binds to fibre"),
    ("", "process", "how long it takes, and how it is computed"),
    ("", "look", "how the cloth is drawn"),
    ("", "record", "what a recording keeps"),
    ("", "drape", "how the cloth hangs or lies"),
    ("", "view", "how the draped cloth is seen"),
    ("", "batik", "wax and baths, one after the other"),
    ("", "dye", "the dye in the bath"),
    // Cloth.
    (
        "batik",
        "cloth",
        "colour of the undyed cloth: hue °, saturation, value",
    ),
    ("", "cloth", "the cloth before it is dyed"),
    ("cloth Rectangle", "size", "across and down"),
    (
        "Ellipses",
        "size",
        "shares of a cloth cell along and across the upper yarn",
    ),
    ("", "cell_mm", "side of a cell, mm"),
    ("", "weave", "which yarn lies on top"),
    (
        "kasuri",
        "warp",
        "how the yarns that run down were dyed before they were woven",
    ),
    (
        "kasuri",
        "weft",
        "how the yarns that run across were dyed before they were woven",
    ),
    ("", "warp", "the yarns that run down"),
    (
        "",
        "weft",
        "the yarns that run across; left out, they are as the warp",
    ),
    (
        "",
        "gap_porosity",
        "share of a gap that dye can move in, 0 to 1",
    ),
    (
        "",
        "paths",
        "1: dye goes straight through, 0: no way through",
    ),
    ("", "kasuri", "yarns that were dyed before they were woven"),
    ("warp weft", "width", "of a yarn"),
    ("warp weft", "gap", "to the next yarn"),
    (
        "",
        "vary_width",
        "each yarn has its width times a factor between these",
    ),
    (
        "warp weft",
        "porosity",
        "share of a yarn that is pores, 0 to 1",
    ),
    (
        "",
        "vary_porosity",
        "each yarn has its porosity times a factor between these",
    ),
    (
        "",
        "twist",
        "1: straight fibres, towards 0 the harder the twist",
    ),
    (
        "",
        "vary_twist",
        "each yarn has its twist times a factor between these",
    ),
    (
        "",
        "squeeze",
        "each yarn is squeezed by a share between these",
    ),
    ("", "dive", "where a yarn dives under the next one"),
    ("", "between_layers", "between a warp and a weft yarn"),
    ("", "across_yarn", "across a yarn"),
    ("", "yarn_to_gap", "between a yarn and a gap"),
    ("", "gap_to_gap", "from gap to gap"),
    ("", "along_yarn", "along a yarn"),
    ("warp weft Wax", "pattern", "where, 0 to 1"),
    (
        "warp weft",
        "amount",
        "share of what fibre can bind that is bound there, 0 to 1",
    ),
    ("", "shift", "the farthest that a yarn lies from its place"),
    ("", "bleed", "how far dye crept under the binding"),
    // Dye.
    ("", "diffusivity", "how fast it spreads in water"),
    (
        "",
        "equilibrium",
        "thicker dye than this moves more slowly, 0 to 1",
    ),
    (
        "adsorption",
        "rate",
        "how fast it binds, as a share of how fast it spreads",
    ),
    ("", "isotherm", "how much fibre binds"),
    // Supply.
    ("", "shape", "where"),
    ("", "dose", "concentration of the liquid, 0 to 1"),
    (
        "Bath",
        "speed",
        "share of what the cloth lacks that a step makes up, 0 to 0.5",
    ),
    ("Dose", "at", "when"),
    ("Hold Bath", "from", "from when"),
    ("Hold Bath", "until", "until when; left out, to the end"),
    // Patterns.
    ("Noise", "seed", "another number gives other clouds"),
    ("Disc Discs", "diameter", "across a spot"),
    ("", "pitch", "from spot to spot"),
    (
        "",
        "staggered",
        "whether every other row is moved by half a pitch",
    ),
    ("", "centre", "shares of the cloth, across and down"),
    ("Stripes Rings", "width", "of a stripe or a ring"),
    ("Stripes Rings", "gap", "between them"),
    ("Blur", "radius", "how soft: standard deviation"),
    ("Seikaiha", "radius", "of a fan"),
    ("", "arcs", "open arcs in a fan"),
    ("", "open", "the share of a ring that its arc leaves open"),
    ("", "offset", "where the first one begins"),
    ("", "angle", "degrees"),
    ("", "count", "how many"),
    ("", "share", "of the circle, 0 to 1"),
    ("Radial", "from", "all of it up to here"),
    ("Radial", "to", "nothing beyond"),
    ("", "grain", "the size of a cloud"),
    ("", "octaves", "finer and finer clouds on top of each other"),
    ("", "file", "a file beside this one"),
    ("", "fit", "Exact, or Stretch where it has another size"),
    ("", "measures", "whose widths the yarns have"),
    ("", "over", "picks that the warp floats over"),
    ("", "under", "picks that it dives under"),
    ("", "shafts", "ends and picks in a repeat"),
    ("", "counter", "the move from pick to pick"),
    ("", "face", "which yarn covers the face"),
    ("", "k", "bound per free dye"),
    ("", "b", "the smaller, the more binds from thin dye"),
    ("", "kl", "the larger, the sooner fibre is full"),
    ("Saturating", "speed", "how fast, 0 to 1"),
    ("Saturating", "most", "the most that fibre binds, 0 to 1"),
    ("", "reading", "of paper B's Table 1"),
    ("PixelDiffusing", "step", "how much a scan spreads"),
    ("Without Blur Strength", "of", "of what"),
    ("", "cut", "what is cut away"),
    ("", "by", "the factor, 0 to 1"),
    ("Strokes", "radius", "of the brush"),
    (
        "",
        "hardness",
        "share of the radius up to which it is whole, 0 to 1",
    ),
    ("", "strength", "how much there is in its middle, 0 to 1"),
    (
        "",
        "path",
        "where it went: shares of the cloth, across and down",
    ),
    // Batik.
    ("batik", "steps", "what is done, in order"),
    ("batik", "solver", "how dye moves through waxed cloth"),
    ("batik", "show", "what is shown"),
    ("", "show_wax", "whether wax is seen until it is boiled off"),
    ("Wax", "drawing", "a line drawing beside this file"),
    ("", "ground", "which colour of the drawing is its ground"),
    ("", "waxed", "whether the drawing is waxed or its ground"),
    ("", "crackle", "how the wax breaks"),
    ("Wax", "edge", "how it thins out"),
    ("", "density", "how many cracks"),
    ("crackle", "width", "of a crack, cells"),
    ("", "thinning", "how much thinner later cracks are, 0 to 1"),
    ("", "jitter", "how uneven they are, 0 to 1"),
    ("", "folds", "how much they follow folds, 0 to 1"),
    ("", "direction", "of the folds, °"),
    ("", "crumple", "how unevenly they are spread, 0 to 1"),
    ("", "crumple_size", "of a crumple, cells"),
    ("", "reach", "how far, cells"),
    ("edge", "drawing", "the share of the drawing itself, 0 to 1"),
    (
        "Dye",
        "colour",
        "of cloth full of this dye: hue °, saturation, value",
    ),
    ("", "lasts", "how long the cloth hangs in the bath"),
    ("", "bath", "the bath"),
    ("", "rinse", "whether what has not bound is washed out"),
    ("bath", "concentration", "0 to 1"),
    (
        "bath",
        "supply",
        "share of what is missing that comes in at once, 0 to 0.5",
    ),
    ("bath", "binding", "how fast dye binds, 0 to 1"),
    ("", "most_bound", "the most that fibre binds, 0 to 1"),
    // Process.
    ("", "duration", "from the first dye to the end"),
    ("process", "step_h", "length of a step, h"),
    (
        "process",
        "solver",
        "Accelerated, or Explicit: one step at a time",
    ),
    (
        "process",
        "tolerance",
        "the largest error of a leap, as a share of full",
    ),
    // Look.
    (
        "look",
        "show",
        "FreeAndBound, or BoundOnly: the cloth after rinsing",
    ),
    ("", "colours", "from the lightest to the darkest"),
    ("look", "path", "the way from colour to colour"),
    ("", "lightest", "undyed: hue °, saturation, value"),
    ("", "middle", "half dyed: hue °, saturation, value"),
    ("", "darkest", "fully dyed: hue °, saturation, value"),
    (
        "",
        "darkest_at",
        "the amount of dye with the darkest colour, 0 to 1",
    ),
    ("", "pixels_per_cell", "pixels along one side of a cell"),
    ("", "side", "which side of the cloth is seen"),
    ("", "texture", "what undyed cloth looks like"),
    ("", "yarn", "how shaded yarns look"),
    (
        "",
        "turn",
        "yarn widths for one turn of the twist; negative: S twist",
    ),
    ("", "fibres", "fibres around a yarn"),
    ("", "roughness", "0 smooth to 1 rough"),
    (
        "",
        "unevenness",
        "slubs, and differences between yarns, 0 to 1",
    ),
    ("", "hairiness", "loose fibres, 0 to 1"),
    ("", "lustre", "0 cotton to 1 silk"),
    ("", "threshold", "how much of a curve has colour, 0 to 1"),
    ("", "unit_yarns", "unit yarns in a yarn"),
    (
        "",
        "contrast",
        "how much paler a place without colour is, 0 to 1",
    ),
    ("", "relief", "how round yarns are seen, 0 flat to 1"),
    ("", "paler", "0 to 1"),
    ("", "lighter", "0 to 1"),
    ("", "shade", "0 to 1"),
    ("", "cell_noise", "0 to 1"),
    ("", "pixel_noise", "0 to 1"),
    ("", "blur", "pixels"),
    // Record.
    ("", "frames", "of the time-lapse"),
    ("", "sheet", "the moments on the contact sheet"),
    // View.
    ("", "pixels", "of a frame, across and down"),
    ("", "camera", "where it is seen from"),
    (
        "",
        "field_of_view",
        "between the upper and the lower edge, °",
    ),
    (
        "view",
        "ground",
        "colour of the ground: hue °, saturation, value",
    ),
    (
        "",
        "light",
        "where it comes from: ° around the upright, ° above the horizon",
    ),
    (
        "",
        "moves_s",
        "how long the cloth moves while it is dyed, s",
    ),
    // Drape.
    ("", "particles", "across and down"),
    ("", "size_m", "width and height, m"),
    ("", "outline", "rectangle or ellipse"),
    ("drape", "material", "what it is made of"),
    ("drape", "start", "how it begins"),
    ("drape", "pins", "what holds it"),
    ("drape", "on", "what it falls on"),
    ("drape", "wind", "the wind"),
    ("drape", "creases", "where it was pressed"),
    (
        "",
        "settle_s",
        "how long it moves before anything is shown, s",
    ),
];
