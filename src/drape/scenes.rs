//! The drapes that come with the program.

use include_dir::{Dir, include_dir};
use ron::extensions::Extensions;

use super::spec::DrapeSpec;

static DRAPES: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/drapes");

/// The names of all bundled drapes, sorted.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = DRAPES
        .files()
        .filter_map(|file| file.path().file_stem()?.to_str())
        .collect();
    names.sort_unstable();
    names
}

/// The text of a bundled drape, in RON.
pub fn text(name: &str) -> Option<&'static str> {
    DRAPES.get_file(format!("{name}.ron"))?.contents_utf8()
}

/// Reads a drape from RON text.
///
/// # Errors
/// What RON could not make a drape of, with line and column.
pub fn parse(text: &str) -> Result<DrapeSpec, ron::error::SpannedError> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text)
}
