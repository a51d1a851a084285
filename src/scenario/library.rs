//! The scenarios and figures that come with the program, so that they run from any folder.

use include_dir::{Dir, include_dir};

static SCENARIOS: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/scenarios");
static FIGURES: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/figures");

/// A scenario or figure that comes with the program.
#[derive(Debug, Clone, Copy)]
pub struct Bundled {
    /// Its name, such as `seikaiha`.
    pub name: &'static str,
    /// Its text in RON.
    pub text: &'static str,
}

/// All bundled scenarios, by name.
pub fn bundled() -> impl Iterator<Item = Bundled> {
    texts(&SCENARIOS)
}

/// All bundled figures, by name.
pub fn bundled_figures() -> impl Iterator<Item = Bundled> {
    texts(&FIGURES)
}

fn texts(folder: &'static Dir) -> impl Iterator<Item = Bundled> {
    folder.files().filter_map(|file| {
        let path = file.path();
        let name = path.file_stem()?.to_str()?;
        let is_ron = path.extension().is_some_and(|ext| ext == "ron");
        is_ron.then_some(Bundled {
            name,
            text: file.contents_utf8()?,
        })
    })
}

/// A file that a bundled scenario names, by its path beside them.
pub fn file(path: &str) -> Option<&'static [u8]> {
    SCENARIOS.get_file(path).map(include_dir::File::contents)
}

/// The names of all bundled scenarios, sorted.
pub fn names() -> Vec<&'static str> {
    sorted(bundled())
}

/// The names of all bundled figures, sorted.
pub fn figure_names() -> Vec<&'static str> {
    sorted(bundled_figures())
}

fn sorted(texts: impl Iterator<Item = Bundled>) -> Vec<&'static str> {
    let mut names: Vec<_> = texts.map(|text| text.name).collect();
    names.sort_unstable();
    names
}
