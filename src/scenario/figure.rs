//! Figures: several cloths side by side, each dyed to a moment and looked at in its own way.
//!
//! A figure file lists panels; a panel names a scenario and what to show of it. Panels of one
//! scenario share one run.

use std::path::Path;

use ron::extensions::Extensions;
use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};
use super::error::nearest;
use super::experiment::read;
use super::library::{bundled_figures, figure_names};
use super::locate::locate;
use super::units::{Length, MOST_STEPS, Time};
use super::{Colours, Experiment, LARGEST_SCALE, LookSpec, ScenarioError, Show, SourceError};
use super::{Origin, bundled_names};

/// The most panels that a figure has room for.
pub const MOST_PANELS: usize = 100;
/// The most pixels along one side of a panel.
pub const LARGEST_PANEL: u32 = 2000;
/// The longer side of a panel of a figure that does not say, pixels.
const PANEL: u32 = crate::record::LARGEST_TILE;

/// What a figure file says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Figure", deny_unknown_fields)]
struct FigureSpec {
    /// What it shows, in a few words.
    title: String,
    /// Panels in a row. Left out: as many as make the figure a little wider than high.
    #[serde(default)]
    columns: Option<u32>,
    /// The longer side of a panel is at most this many pixels.
    #[serde(default)]
    panel_pixels: Option<u32>,
    /// The panels, row by row.
    panels: Vec<PanelSpec>,
}

/// What a figure file says of one panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Panel", deny_unknown_fields)]
struct PanelSpec {
    /// A scenario file beside the figure, or the name of a bundled scenario.
    scenario: String,
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

/// A figure ready to be made.
#[derive(Debug, Clone)]
pub struct Figure {
    /// A short name: that of the file, without folder and ending.
    pub name: String,
    /// What it shows; empty if nobody said.
    pub title: String,
    /// Panels in a row, where someone said.
    pub columns: Option<u32>,
    /// The longer side of a panel is at most this many pixels.
    pub panel_pixels: u32,
    /// The experiments that the panels look at.
    pub experiments: Vec<Experiment>,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// A look at an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Which of the figure's experiments.
    pub experiment: usize,
    /// What stands below.
    pub label: String,
    /// At which step of the process.
    pub step: u64,
    /// How the cloth is drawn.
    pub look: LookSpec,
    /// The part that is shown; none: all of it.
    pub part: Option<Part>,
}

/// A part of the cloth, in cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The first column.
    pub x: usize,
    /// The first row.
    pub y: usize,
    /// Cells across.
    pub width: usize,
    /// Cells down.
    pub height: usize,
}

/// What a name or a file turned out to be.
#[derive(Debug, Clone)]
pub enum Loaded {
    /// A scenario, ready to run.
    Scenario(Box<Experiment>),
    /// A figure, ready to be made.
    Figure(Figure),
}

impl Loaded {
    /// Loads a figure or scenario from a file, or the bundled one of this name if there is no such
    /// file.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names the place: file, line and column, field, or picture.
    pub fn load(name_or_path: &str) -> Result<Self, ScenarioError> {
        let path = Path::new(name_or_path);
        if path.is_file() {
            let text = read(path).map_err(|why| ScenarioError::Unreadable {
                path: path.into(),
                why,
            })?;
            let origin = Origin::File(path.into());
            return if is_figure(&text) {
                Figure::parse(name_or_path, origin, &text).map(Loaded::Figure)
            } else {
                let experiment = Experiment::parse(name_or_path, origin, text)?;
                Ok(Loaded::Scenario(Box::new(experiment)))
            };
        }
        if let Some(figure) = bundled_figures().find(|figure| figure.name == name_or_path) {
            let figure = Figure::parse(figure.name, Origin::Bundled, figure.text)?;
            return Ok(Loaded::Figure(figure));
        }
        match Experiment::load(name_or_path) {
            Ok(experiment) => Ok(Loaded::Scenario(Box::new(experiment))),
            // Figures may be meant as well as scenarios.
            Err(ScenarioError::Unknown { name, .. }) => {
                let known = figure_names().into_iter().chain(bundled_names());
                let nearest = nearest(&name, known).map(Into::into);
                Err(ScenarioError::Unknown { name, nearest })
            }
            Err(other) => Err(other),
        }
    }
}

impl Figure {
    /// Puts figures and scenarios, files or bundled ones, into one figure, in their order. A single
    /// figure stays as it is; of a scenario, the end of the process is shown.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names the place: file, line and column, field, or picture.
    pub fn of<S: AsRef<str>>(names: &[S]) -> Result<Self, ScenarioError> {
        let mut parts = names.iter().map(|name| Figure::load(name.as_ref()));
        let mut whole = parts.next().transpose()?.unwrap_or_else(Figure::empty);
        if names.len() > 1 {
            (whole.title, whole.columns) = (String::new(), None);
        }
        for part in parts {
            whole.append(part?);
        }
        Ok(whole)
    }

    fn empty() -> Self {
        Figure {
            name: "sheet".into(),
            title: String::new(),
            columns: None,
            panel_pixels: PANEL,
            experiments: Vec::new(),
            panels: Vec::new(),
        }
    }

    fn append(&mut self, other: Figure) {
        let before = self.experiments.len();
        self.name = format!("{}_{}", self.name, other.name);
        self.panel_pixels = self.panel_pixels.max(other.panel_pixels);
        self.experiments.extend(other.experiments);
        self.panels.extend(other.panels.into_iter().map(|panel| {
            let experiment = before + panel.experiment;
            Panel {
                experiment,
                ..panel
            }
        }));
    }

    fn load(name: &str) -> Result<Self, ScenarioError> {
        Ok(match Loaded::load(name)? {
            Loaded::Figure(figure) => figure,
            Loaded::Scenario(experiment) => Figure::of_scenario(*experiment),
        })
    }

    /// The end of one experiment.
    fn of_scenario(experiment: Experiment) -> Self {
        let scenario = &experiment.scenario;
        Figure {
            name: experiment.name.clone(),
            panels: vec![Panel {
                experiment: 0,
                label: scenario.title.clone(),
                step: scenario.process.steps(),
                look: scenario.look,
                part: None,
            }],
            experiments: vec![experiment],
            ..Figure::empty()
        }
    }

    /// Reads a figure's text. `name` stands in messages: the path, or the bundled name.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names line and column, of the figure or of a scenario in it.
    pub fn parse(name: &str, origin: Origin, text: &str) -> Result<Self, ScenarioError> {
        // Some editors begin a file with a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let source = |error| ScenarioError::Source(Box::new(error));
        let spec: FigureSpec = options
            .from_str(text)
            .map_err(|error| source(SourceError::from_ron(name, text, &error)))?;
        let problem = |problem| source(SourceError::from_problem(name, text, &problem));
        spec.check().map_err(problem)?;
        let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str());
        let mut figure = Figure {
            name: stem.unwrap_or("figure").into(),
            title: spec.title,
            columns: spec.columns,
            panel_pixels: spec.panel_pixels.unwrap_or(PANEL),
            experiments: Vec::new(),
            panels: Vec::new(),
        };
        let mut loaded: Vec<&str> = Vec::new();
        for (i, panel) in spec.panels.iter().enumerate() {
            let at = Checker::root().field("panels").item(i);
            let known = loaded.iter().position(|name| *name == panel.scenario);
            let experiment = match known {
                Some(experiment) => experiment,
                None => {
                    let experiment = load_beside(&origin, &panel.scenario, &at);
                    figure.experiments.push(experiment.map_err(|why| match why {
                        Refused::Here(what) => problem(what),
                        Refused::There(why) => why,
                    })?);
                    loaded.push(&panel.scenario);
                    loaded.len() - 1
                }
            };
            let of = &figure.experiments[experiment];
            let panel = panel.of(of, &at).map_err(problem)?;
            figure.panels.push(Panel {
                experiment,
                ..panel
            });
        }
        Ok(figure)
    }

    /// Shows all panels at a step.
    ///
    /// # Errors
    /// What is wrong with the step.
    pub fn show_at(&mut self, step: u64) -> Result<(), String> {
        if step > MOST_STEPS {
            return Err(format!("0 to {MOST_STEPS} is allowed, but this is {step}"));
        }
        for panel in &mut self.panels {
            panel.step = step;
        }
        Ok(())
    }

    /// Draws all panels at so many pixels a cell.
    ///
    /// # Errors
    /// What is wrong with the number.
    pub fn show_scaled(&mut self, scale: u32) -> Result<(), String> {
        if !(1..=LARGEST_SCALE).contains(&scale) {
            let allowed = format!("1 to {LARGEST_SCALE} pixels a cell is allowed");
            return Err(format!("{allowed}, but this is {scale}"));
        }
        for panel in &mut self.panels {
            panel.look.pixels_per_cell = scale;
        }
        Ok(())
    }
}

/// Whether a text means to be a figure: it has panels and no cloth.
fn is_figure(text: &str) -> bool {
    let whole = locate(text, "");
    let has = |field| {
        let found = locate(text, field);
        found.is_some() && found != whole
    };
    has("panels") && !has("cloth")
}

/// Why the scenario of a panel was refused.
enum Refused {
    /// What the figure says of it is wrong.
    Here(Problem),
    /// It is wrong itself.
    There(ScenarioError),
}

/// Loads the scenario of a panel: a file beside the figure, or a bundled one.
fn load_beside(origin: &Origin, name: &str, at: &Checker) -> Result<Experiment, Refused> {
    let path = match origin {
        Origin::File(figure) => figure.parent().unwrap_or(Path::new("")).join(name),
        Origin::Bundled | Origin::Memory => name.into(),
    };
    let in_a_file = matches!(origin, Origin::File(_)) && path.is_file();
    if !in_a_file && let Some(bundled) = Experiment::bundled(name) {
        return bundled.map_err(Refused::There);
    }
    if !in_a_file {
        let what = format!(
            "there is no file {} and no bundled scenario named `{name}`{}",
            path.display(),
            super::error::did_you_mean(nearest(name, bundled_names()))
        );
        return Err(Refused::Here(at.field("scenario").problem(what)));
    }
    Experiment::load(&path.to_string_lossy()).map_err(Refused::There)
}

impl FigureSpec {
    fn check(&self) -> Result<(), Problem> {
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
    fn of(&self, experiment: &Experiment, at: &Checker) -> Result<Panel, Problem> {
        let scenario = &experiment.scenario;
        let process = &scenario.process;
        let mut look = scenario.look;
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
