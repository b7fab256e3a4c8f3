//! Fabrics as text, and what is wrong with a text that isn't one.

use ron::{
    error::SpannedError,
    ser::{PrettyConfig, to_string_pretty},
};
use thiserror::Error;

use super::{
    Fabric,
    begun::{Begun, line_at},
};
use crate::error::ClothError;

/// Why a fabric's text is refused. The message names file, line, field, the rule and the mend.
///
/// Of a file, it is in the [`AssetLoaderError::error`](bevy::asset::AssetLoaderError::error) that the asset server
/// logs.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}line {line}: {problem}", place(.file))]
#[non_exhaustive]
pub struct FabricFileError {
    /// Path of the asset. `None` where the text comes from elsewhere.
    pub file: Option<String>,
    /// Line, from 1: that of the field's name, or where reading ended.
    pub line: usize,
    /// The field, if one is to blame: where the text can't be read, the one that was read last.
    pub field: Option<String>,
    /// The rule that is broken, and the mend.
    pub problem: String,
}

fn place(file: &Option<String>) -> String {
    file.as_ref().map(|file| format!("{file}, ")).unwrap_or_default()
}

impl Fabric {
    /// The text of a `*.fabric.ron` file: one field a line. It loads again to an equal value.
    ///
    /// A value out of its range is written as it is, and [`from_ron`](Self::from_ron) refuses it.
    pub fn to_ron(&self) -> String {
        // Numbers in a struct can't fail to be written. The same line ends everywhere.
        to_string_pretty(self, PrettyConfig::new().new_line("\n")).unwrap_or_default() + "\n"
    }

    /// Reads the text of a `*.fabric.ron` file and checks the ranges of all fields.
    ///
    /// # Errors
    ///
    /// [`FabricFileError`] for a text that isn't RON, or a field that is missing, unknown, there twice, no number or
    /// out of its range.
    pub fn from_ron(text: &str) -> Result<Self, FabricFileError> {
        let fabric: Self = ron::from_str(text).map_err(|error| FabricFileError::unread(text, error))?;
        match fabric.material() {
            Ok(_) => Ok(fabric),
            Err(error) => Err(FabricFileError::out_of_range(text, error)),
        }
    }
}

/// Reads the contents of a file.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<Fabric, FabricFileError> {
    match str::from_utf8(bytes) {
        Ok(text) => Fabric::from_ron(text),
        Err(error) => Err(FabricFileError {
            file: None,
            line: line_at(bytes, error.valid_up_to()),
            field: None,
            problem: "a character isn't UTF-8; save the file in that encoding".into(),
        }),
    }
}

impl FabricFileError {
    pub(super) fn in_file(self, file: &impl ToString) -> Self {
        Self { file: Some(file.to_string()), ..self }
    }

    /// What RON or the fields of [`Fabric`] don't allow.
    fn unread(text: &str, SpannedError { code, span }: SpannedError) -> Self {
        use ron::Error as E;
        let begun = Begun::read(text);
        let last = if begun.to_the_end { None } else { begun.fields.last() };
        let mut line = span.start.line;
        let (field, problem) = match (&code, last) {
            (E::NoSuchStructField { expected, found, .. }, _) => {
                (Some(&**found), format!("a fabric has no {found}; use one of {}", expected.join(", ")))
            }
            (E::MissingStructField { field, .. }, _) => {
                (Some(*field), format!("{field} is missing, and a fabric has every field; add it"))
            }
            (E::DuplicateStructField { field, .. }, _) => {
                (Some(*field), format!("{field} is there twice, and it has to be there once; remove one"))
            }
            (E::ExpectedFloat, Some(last)) => {
                let name = last.name;
                (Some(name), format!("{name} has to be a number; write one, as in `{name}: 0.5`"))
            }
            (_, Some(last)) => {
                let name = last.name;
                // RON looks for it from the next word on.
                if code == E::ExpectedComma {
                    line = last.line;
                }
                (Some(name), format!("the text from {name} on can't be read ({code}); mend it there"))
            }
            (code, None) => {
                // From the last thing that was read to what has come instead.
                line = span.end.line;
                let problem = match code {
                    E::TrailingCharacters => "there is text behind the fabric; remove it".into(),
                    _ => format!("this isn't a fabric ({code}); write all of its fields within `(` and `)`"),
                };
                (None, problem)
            }
        };
        Self { file: None, line, field: field.map(Into::into), problem }
    }

    /// What [`Fabric::material`] refuses.
    fn out_of_range(text: &str, error: ClothError) -> Self {
        let ClothError::InvalidParameter { name, value, rule } = error else {
            return Self { file: None, line: 1, field: None, problem: error.to_string() };
        };
        let name = name.trim_start_matches("Fabric::").to_owned();
        let line = Begun::read(text).fields.iter().find(|field| field.name == name).map_or(1, |field| field.line);
        let error = ClothError::InvalidParameter { name: name.clone(), value, rule };
        Self { file: None, line, field: Some(name), problem: error.to_string() }
    }
}
