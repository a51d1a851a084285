//! Figures: several cloths side by side, each dyed to a moment and looked at in its own way.
//!
//! A figure file lists panels; a panel names a scenario and what to show of it. Panels of one
//! scenario share one run.

mod spec;

use std::path::Path;

use ron::extensions::Extensions;

use super::check::{Checker, Problem};
use super::error::{did_you_mean, nearest};
use super::experiment::read;
use super::library::{bundled_figures, figure_names};
use super::locate::locate;
use super::units::MOST_STEPS;
use super::{
    Experiment, LARGEST_SCALE, LookSpec, Origin, ScenarioError, SourceError, bundled_names,
};
use spec::FigureSpec;

/// The most panels that a figure has room for.
pub const MOST_PANELS: usize = 100;
/// The most pixels along one side of a panel.
pub const LARGEST_PANEL: u32 = 2000;
/// The longer side of a panel of a figure that does not say, pixels.
const PANEL: u32 = crate::record::LARGEST_TILE;

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
                look: scenario.look.clone(),
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
            did_you_mean(nearest(name, bundled_names()))
        );
        return Err(Refused::Here(at.field("scenario").problem(what)));
    }
    Experiment::load(&path.to_string_lossy()).map_err(Refused::There)
}
