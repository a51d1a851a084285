//! What a scenario says about the cloth: its size, its yarns, its weave, its paths for dye.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};
use super::units::Length;
use crate::cloth::Weave;
use crate::pattern::Pattern;

/// The most cells a cloth may have along one side.
pub const LONGEST_SIDE: usize = 1 << 20;

/// The least porosity: yarn with fewer pores than this takes up no dye.
const LEAST_POROSITY: f64 = 0.001;

/// The cloth (paper D §4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Cloth", deny_unknown_fields)]
pub struct ClothSpec {
    /// Across and down.
    pub size: (Length, Length),
    /// Side of one diffusion cell Δd, mm.
    #[serde(default = "default_cell_mm")]
    pub cell_mm: f64,
    /// Which yarn lies on top at every crossing.
    #[serde(default)]
    pub weave: Weave,
    /// The yarns that run down.
    #[serde(default)]
    pub warp: YarnSpec,
    /// The yarns that run across. Left out: the same as the warp.
    #[serde(default)]
    pub weft: Option<YarnSpec>,
    /// Porosity of the gaps between yarns. Left out: that of the yarns of the same layer.
    #[serde(default)]
    pub gap_porosity: Option<f64>,
    /// How straight the paths are that dye takes from cell to cell.
    #[serde(default)]
    pub paths: Paths,
    /// Yarns that were dyed in sections before they were woven.
    #[serde(default)]
    pub kasuri: Kasuri,
}

/// Which yarns were dyed before weaving; both for double kasuri.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Kasuri {
    /// The warp.
    pub warp: Option<KasuriSpec>,
    /// The weft.
    pub weft: Option<KasuriSpec>,
}

/// How the yarns of one direction were dyed before weaving.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Sections", deny_unknown_fields)]
pub struct KasuriSpec {
    /// Where the woven cloth is to show dyed yarn.
    pub pattern: Pattern,
    /// How much of what fibre can bind is bound there, 0 to 1.
    #[serde(default = "default_amount")]
    pub amount: f64,
    /// The farthest that a yarn lies from where it was planned.
    #[serde(default = "default_shift")]
    pub shift: Length,
    /// How far dye bled under the binding: standard deviation along the yarn.
    #[serde(default = "default_bleed")]
    pub bleed: Length,
}

fn default_amount() -> f64 {
    0.9
}

fn default_shift() -> Length {
    Length::Cells(4.0)
}

fn default_bleed() -> Length {
    Length::Cells(2.0)
}

/// The yarns of one direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Yarn", deny_unknown_fields, default)]
pub struct YarnSpec {
    /// Width of a yarn.
    pub width: Length,
    /// Width of the gap to the next yarn.
    pub gap: Length,
    /// Each yarn multiplies its width by a random factor between these two.
    pub vary_width: (f64, f64),
    /// P: the share of a yarn that is pores, over 0 to 1.
    pub porosity: f64,
    /// Each yarn multiplies its porosity by a random factor between these two
    /// (0.5 to 1 for the "0.5r" of paper D's Table 1).
    pub vary_porosity: (f64, f64),
    /// τ₁: 1 where the fibres lie straight, towards 0 the harder the yarn is twisted.
    pub twist: f64,
    /// Each yarn multiplies its τ₁ by a random factor between these two.
    pub vary_twist: (f64, f64),
    /// Each yarn is squeezed by a random volume ratio B between these two.
    pub squeeze: (f64, f64),
}

impl Default for YarnSpec {
    fn default() -> Self {
        YarnSpec {
            width: Length::Cells(8.0),
            gap: Length::Cells(2.0),
            vary_width: (1.0, 1.0),
            porosity: 0.5,
            vary_porosity: (1.0, 1.0),
            twist: 1.0,
            vary_twist: (1.0, 1.0),
            squeeze: (0.0, 0.0),
        }
    }
}

/// Tortuosity factors, 0 (no way through) to 1 (a straight path): paper D §4.2a, Fig 4.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Paths {
    /// τ₂: along the cloth where a yarn dives from the face to the back or rises again.
    pub dive: f64,
    /// τ₃ class I: between a warp and a weft yarn.
    pub between_layers: f64,
    /// τ₃ class II: across a yarn.
    pub across_yarn: f64,
    /// τ₃ class III: between a yarn and a gap.
    pub yarn_to_gap: f64,
    /// τ₃ class IV: from gap to gap.
    pub gap_to_gap: f64,
    /// τ₃ class V: along a yarn.
    pub along_yarn: f64,
}

impl Default for Paths {
    fn default() -> Self {
        Paths {
            dive: 0.47,
            between_layers: 1.0,
            across_yarn: 1.0,
            yarn_to_gap: 1.0,
            gap_to_gap: 1.0,
            along_yarn: 1.0,
        }
    }
}

/// Δd of paper D's Table 1, mm.
fn default_cell_mm() -> f64 {
    0.05
}

impl ClothSpec {
    /// The weft yarns, which are the warp's where the scenario leaves them out.
    pub fn weft(&self) -> &YarnSpec {
        self.weft.as_ref().unwrap_or(&self.warp)
    }

    /// Cells across and down.
    pub fn cells(&self) -> (usize, usize) {
        (
            self.size.0.whole_cells(self.cell_mm),
            self.size.1.whole_cells(self.cell_mm),
        )
    }

    pub(super) fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("cell_mm").within(self.cell_mm, 1e-4..=100.0)?;
        let longest = LONGEST_SIDE as f64;
        let size = at.field("size");
        self.size
            .0
            .check(&size.item(0), self.cell_mm, 1.0, longest)?;
        self.size
            .1
            .check(&size.item(1), self.cell_mm, 1.0, longest)?;
        self.weave.check(&at.field("weave"))?;
        self.warp.check(&at.field("warp"), self.cell_mm)?;
        self.weft().check(&at.field("weft"), self.cell_mm)?;
        if let Some(porosity) = self.gap_porosity {
            at.field("gap_porosity")
                .within(porosity, LEAST_POROSITY..=1.0)?;
        }
        self.paths.check(&at.field("paths"))?;
        if matches!(self.weave, Weave::Mask { .. }) {
            for (name, yarn) in [("warp", &self.warp), ("weft", self.weft())] {
                if yarn.gap.whole_cells(self.cell_mm) > 0 {
                    return Err(at.field(name).field("gap").problem(
                        "a cloth from a photograph has no gaps (paper D §4.3.1); \
                         write `gap: Cells(0)`"
                            .into(),
                    ));
                }
            }
        }
        self.kasuri.check(&at.field("kasuri"), self.cell_mm)
    }
}

impl Kasuri {
    /// The weft's and the warp's, in the order of the layers.
    pub fn layers(&self) -> [Option<KasuriSpec>; 2] {
        [self.weft.clone(), self.warp.clone()]
    }

    /// Whether any yarn was dyed.
    pub fn is_there(&self) -> bool {
        self.warp.is_some() || self.weft.is_some()
    }

    /// The patterns, each with its place in the scenario.
    pub(super) fn patterns(&self, at: &Checker) -> Vec<(&Pattern, Checker)> {
        let both = [("warp", &self.warp), ("weft", &self.weft)];
        let each = both.into_iter().filter_map(|(name, spec)| {
            let pattern = &spec.as_ref()?.pattern;
            Some((pattern, at.field(name).field("pattern")))
        });
        each.collect()
    }

    fn check(&self, at: &Checker, cell_mm: f64) -> Result<(), Problem> {
        for (name, spec) in [("warp", &self.warp), ("weft", &self.weft)] {
            let (Some(spec), at) = (spec, at.field(name)) else {
                continue;
            };
            spec.pattern.check(&at.field("pattern"), cell_mm)?;
            at.field("amount").within(spec.amount, 0.0..=1.0)?;
            let longest = LONGEST_SIDE as f64;
            spec.shift
                .check(&at.field("shift"), cell_mm, 0.0, longest)?;
            spec.bleed.check(&at.field("bleed"), cell_mm, 0.0, 200.0)?;
        }
        Ok(())
    }
}

impl YarnSpec {
    fn check(&self, at: &Checker, cell_mm: f64) -> Result<(), Problem> {
        let widest = LONGEST_SIDE as f64;
        self.width.check(&at.field("width"), cell_mm, 1.0, widest)?;
        self.gap.check(&at.field("gap"), cell_mm, 0.0, widest)?;
        at.field("vary_width").range(self.vary_width, 0.1..=10.0)?;
        at.field("porosity")
            .within(self.porosity, LEAST_POROSITY..=1.0)?;
        at.field("vary_porosity")
            .range(self.vary_porosity, 0.01..=1.0)?;
        at.field("twist").within(self.twist, 0.0..=1.0)?;
        at.field("vary_twist").range(self.vary_twist, 0.0..=1.0)?;
        at.field("squeeze").range(self.squeeze, 0.0..=1.0)
    }
}

impl Paths {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        for (name, value) in [
            ("dive", self.dive),
            ("between_layers", self.between_layers),
            ("across_yarn", self.across_yarn),
            ("yarn_to_gap", self.yarn_to_gap),
            ("gap_to_gap", self.gap_to_gap),
            ("along_yarn", self.along_yarn),
        ] {
            at.field(name).within(value, 0.0..=1.0)?;
        }
        Ok(())
    }
}
