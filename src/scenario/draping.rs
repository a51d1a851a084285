//! What a scenario says about how its cloth hangs or lies: a drape of its own, or a bundled one by name.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::check::{Checker, Problem};
use super::error::nearest;
use crate::drape::scenes;
use crate::drape::spec::DrapeSpec;

/// How the cloth is draped: `"tablecloth"` or `(particles: …)`.
#[derive(Debug, Clone, PartialEq)]
pub enum Draping {
    /// A bundled drape, by its name.
    Bundled(String),
    /// One that the scenario describes itself.
    Own(Box<DrapeSpec>),
}

impl Draping {
    /// The drape that is meant.
    ///
    /// # Errors
    /// A [`Problem`] if there is none of that name.
    pub fn spec(&self, at: &Checker) -> Result<DrapeSpec, Problem> {
        match self {
            Draping::Own(spec) => Ok(DrapeSpec::clone(spec)),
            Draping::Bundled(name) => bundled(name).ok_or_else(|| at.problem(unknown(name))),
        }
    }

    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        match self {
            Draping::Own(spec) => spec.check(at),
            Draping::Bundled(_) => self.spec(at).map(|_| ()),
        }
    }
}

/// A bundled drape; a test reads them all.
fn bundled(name: &str) -> Option<DrapeSpec> {
    scenes::parse(scenes::text(name)?).ok()
}

/// What to say where no bundled drape has a name.
pub fn unknown(name: &str) -> String {
    let names = scenes::names();
    let meant = nearest(name, names.iter().copied());
    let meant = meant.map_or(String::new(), |near| format!(" — did you mean `{near}`?"));
    format!(
        "there is no drape `{name}`{meant}; there are {}",
        names.join(", ")
    )
}

impl Serialize for Draping {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Draping::Bundled(name) => serializer.serialize_str(name),
            Draping::Own(spec) => spec.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Draping {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NameOrDrape)
    }
}

struct NameOrDrape;

impl<'de> Visitor<'de> for NameOrDrape {
    type Value = Draping;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the name of a bundled drape, such as \"tablecloth\", or a drape: (start: …)")
    }

    fn visit_str<E>(self, name: &str) -> Result<Draping, E> {
        Ok(Draping::Bundled(name.into()))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Draping, A::Error> {
        let spec = DrapeSpec::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Draping::Own(Box::new(spec)))
    }
}
