//! An experiment: a scenario that has been read, checked and given its pictures, ready to run.

use std::fs;
use std::path::{Path, PathBuf};

use ron::extensions::Extensions;
use sha2::{Digest, Sha256};

use super::error::nearest;
use super::{Beside, Images, Scenario, ScenarioError, SourceError, bundled, bundled_names};
use crate::memory::{self, Use};

/// The longest scenario file that is read, bytes.
const LONGEST_TEXT: u64 = 16 << 20;

/// Where a scenario came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// One that comes with the program.
    Bundled,
    /// A file; its pictures lie beside it.
    File(PathBuf),
    /// A program made it.
    Memory,
}

/// A scenario ready to run.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// A short name: that of the file, without folder and ending.
    pub name: String,
    /// Where the scenario came from.
    pub origin: Origin,
    /// The text of the scenario in RON.
    pub text: String,
    /// What the text says.
    pub scenario: Scenario,
    /// The pictures that it names.
    pub images: Images,
}

impl Experiment {
    /// Loads a scenario from a file, or the bundled one of this name if there is no such file.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names the place: file, line and column, field, or picture.
    pub fn load(name_or_path: &str) -> Result<Self, ScenarioError> {
        let path = Path::new(name_or_path);
        if !path.is_file()
            && let Some(experiment) = Experiment::bundled(name_or_path)
        {
            return experiment;
        }
        let looks_like_path = path.components().count() > 1 || path.extension().is_some();
        if !path.exists() && !looks_like_path {
            return Err(ScenarioError::Unknown {
                name: name_or_path.into(),
                nearest: nearest(name_or_path, bundled_names()).map(Into::into),
            });
        }
        let text = read(path).map_err(|why| ScenarioError::Unreadable {
            path: path.into(),
            why,
        })?;
        Experiment::parse(name_or_path, Origin::File(path.into()), text)
    }

    /// The bundled scenario of a name; none if there is none.
    pub(super) fn bundled(name: &str) -> Option<Result<Self, ScenarioError>> {
        let found = bundled().find(|scenario| scenario.name == name)?;
        Some(Experiment::parse(
            found.name,
            Origin::Bundled,
            found.text.to_owned(),
        ))
    }

    /// Makes an experiment of a scenario that a program has put together.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names the field.
    pub fn from_scenario(name: &str, scenario: Scenario) -> Result<Self, ScenarioError> {
        scenario.check()?;
        memory::check(&scenario, Use::of(&scenario))?;
        let images = Images::load(&scenario, &Beside::of(&Origin::Memory))?;
        let text = ron::ser::to_string_pretty(&scenario, ron::ser::PrettyConfig::default())
            .unwrap_or_default();
        Ok(Experiment {
            name: name.into(),
            origin: Origin::Memory,
            text,
            scenario,
            images,
        })
    }

    /// Reads a scenario's text. `name` stands in messages: the path, or the bundled name.
    ///
    /// # Errors
    /// A [`ScenarioError`] that names line and column.
    pub fn parse(name: &str, origin: Origin, text: String) -> Result<Self, ScenarioError> {
        // Some editors begin a file with a byte order mark.
        let text = match text.strip_prefix('\u{feff}') {
            Some(rest) => rest.to_owned(),
            None => text,
        };
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let source = |error| ScenarioError::Source(Box::new(error));
        let scenario: Scenario = options
            .from_str(&text)
            .map_err(|error| source(SourceError::from_ron(name, &text, &error)))?;
        let problem = |problem| source(SourceError::from_problem(name, &text, &problem));
        scenario.check().map_err(problem)?;
        // Before anything is as large as the cloth, even one of its pictures.
        memory::check(&scenario, Use::of(&scenario))?;
        let images = Images::load(&scenario, &Beside::of(&origin)).map_err(problem)?;
        let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str());
        Ok(Experiment {
            name: stem.unwrap_or("scenario").into(),
            origin,
            text,
            scenario,
            images,
        })
    }

    /// SHA-256 of the text, in hexadecimal: two recordings with the same one ran the same scenario.
    pub fn hash(&self) -> String {
        let digest = Sha256::digest(self.text.as_bytes());
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Reads the text of a scenario or a figure.
pub(super) fn read(path: &Path) -> Result<String, String> {
    let size = fs::metadata(path).map_err(|why| why.to_string())?;
    if size.is_dir() {
        return Err("it is a folder".into());
    }
    if size.len() > LONGEST_TEXT {
        return Err(format!(
            "it has {} bytes, more than the {LONGEST_TEXT} that a scenario may have",
            size.len()
        ));
    }
    let bytes = fs::read(path).map_err(|why| why.to_string())?;
    String::from_utf8(bytes).map_err(|why| {
        let good = &why.as_bytes()[..why.utf8_error().valid_up_to()];
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        format!("line {line} is not UTF-8 text")
    })
}
