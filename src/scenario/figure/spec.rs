//! What a figure file says, and what of it is possible.

use serde::{Deserialize, Serialize};

use super::{LARGEST_PANEL, MOST_PANELS, Panel, Part};
use crate::scenario::check::{Checker, Problem};
use crate::scenario::units::{Length, Time};
use crate::scenario::{Colours, Experiment, Show};

/// What a figure file says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Figure", deny_unknown_fields)]
pub(super) struct FigureSpec {
    /// What it shows, in a few words.
    pub title: String,
    /// Panels in a row. Left out: as many as make the figure a little wider than high.
    #[serde(default)]
    pub columns: Option<u32>,
    /// The longer side of a panel is at most this many pixels.
    #[serde(default)]
    pub panel_pixels: Option<u32>,
    /// The panels, row by row.
    pub panels: Vec<PanelSpec>,
}

/// What a figure file says of one panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Panel", deny_unknown_fields)]
pub(super) struct PanelSpec {
    /// A scenario file beside the figure, or the name of a bundled scenario.
    pub scenario: String,
    /// What stands below. Left out: the title of the scenario.
    #[serde(default)]
    label: Option<String>,
    /// When. Left out: at the end of the process.
    #[serde(default)]
    at: Option<Time>,
    /// Which dye is shown. This and all below, left out: as in the scenario.
    #[serde(default)]
    show: Option<Show>,
    /// The colours.
    #[serde(default)]
    colours: Option<Colours>,
    /// The amount of dye that has the darkest colour.
    #[serde(default)]
    darkest_at: Option<f64>,
    /// Pixels along one side of a cell.
    #[serde(default)]
    pixels_per_cell: Option<u32>,
    /// The part of the cloth that is shown. Left out: all of it.
    #[serde(default)]
    crop: Option<CropSpec>,
}

/// A part of the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Crop", deny_unknown_fields)]
struct CropSpec {
    /// Across and down.
    size: (Length, Length),
    /// Where its middle is, as shares of the cloth across and down. It is moved until no part of it
    /// lies outside the cloth.
    #[serde(default = "middle")]
    centre: (f64, f64),
}

fn middle() -> (f64, f64) {
    (0.5, 0.5)
}

impl FigureSpec {
    pub fn check(&self) -> Result<(), Problem> {
        let at = Checker::root();
        let most = MOST_PANELS as u32;
        if let Some(columns) = self.columns {
            at.field("columns").within(columns, 1..=most)?;
        }
        if let Some(pixels) = self.panel_pixels {
            at.field("panel_pixels")
                .within(pixels, 16..=LARGEST_PANEL)?;
        }
        let panels = self.panels.len();
        if !(1..=MOST_PANELS).contains(&panels) {
            let what = format!("a figure has 1 to {MOST_PANELS} panels, but this lists {panels}");
            return Err(at.field("panels").problem(what));
        }
        Ok(())
    }
}

impl PanelSpec {
    /// What this panel shows of an experiment.
    pub fn of(&self, experiment: &Experiment, at: &Checker) -> Result<Panel, Problem> {
        let scenario = &experiment.scenario;
        let process = &scenario.process;
        let mut look = scenario.look.clone();
        look.show = self.show.unwrap_or(look.show);
        look.colours = self.colours.unwrap_or(look.colours);
        look.darkest_at = self.darkest_at.or(look.darkest_at);
        look.pixels_per_cell = self.pixels_per_cell.unwrap_or(look.pixels_per_cell);
        look.check(at)?;
        let step = match self.at {
            None => process.steps(),
            Some(time) => {
                let at = at.field("at");
                time.check(&at, process.step_h)?;
                let step = time.steps(process.step_h);
                if step > process.steps() {
                    return Err(at.problem(format!(
                        "the process ends at step {}, but this asks for {time:?}",
                        process.steps()
                    )));
                }
                step
            }
        };
        let crop = self.crop.map(|crop| crop.of(experiment, &at.field("crop")));
        Ok(Panel {
            experiment: 0,
            label: self.label.clone().unwrap_or(scenario.title.clone()),
            step,
            look,
            part: crop.transpose()?,
        })
    }
}

impl CropSpec {
    /// The cells of this part of an experiment's cloth.
    fn of(&self, experiment: &Experiment, at: &Checker) -> Result<Part, Problem> {
        let cloth = &experiment.scenario.cloth;
        let (nx, ny) = cloth.cells();
        let (size, centre) = (at.field("size"), at.field("centre"));
        let along = |i: usize, length: Length, share: f64, cells: usize| {
            length.check(&size.item(i), cloth.cell_mm, 1.0, cells as f64)?;
            centre.item(i).within(share, 0.0..=1.0)?;
            let extent = length.whole_cells(cloth.cell_mm).clamp(1, cells);
            let first = (share * cells as f64 - extent as f64 / 2.0)
                .round()
                .max(0.0) as usize;
            Ok((first.min(cells - extent), extent))
        };
        let (x, width) = along(0, self.size.0, self.centre.0, nx)?;
        let (y, height) = along(1, self.size.1, self.centre.1, ny)?;
        Ok(Part {
            x,
            y,
            width,
            height,
        })
    }
}
