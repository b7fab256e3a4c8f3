//! What is wrong with a file: each fault is told once, with the file and what in it.

use core::fmt::Display;

use bevy::{platform::collections::HashSet, prelude::*};

/// The faults of a file that have been told.
#[derive(Clone, Debug, Default)]
pub(super) struct Report {
    /// Path of the asset.
    pub file: String,
    told: HashSet<String>,
}

impl Report {
    /// Warns of a `problem` of something in the file, once: a mesh is met again at each object that has it.
    pub fn warn(&mut self, subject: &str, problem: impl Display) {
        let line = format!("{}, {subject}: {problem}", self.file);
        if !self.told.contains(&line) {
            warn!("{line}");
            self.told.insert(line);
        }
    }
}

/// The one of some `names` that is nearest to a misspelt one, if it is near enough to be meant.
pub(super) fn nearest<'a>(misspelt: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let misspelt = misspelt.to_lowercase();
    let by_distance = |name: &'a str| (strsim::osa_distance(&misspelt, &name.to_lowercase()), name);
    let (distance, name) = names.into_iter().map(by_distance).min_by_key(|(distance, _)| *distance)?;
    (distance <= 1 + name.len() / 3).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_is_guessed_and_a_strange_one_is_not() {
        let names = ["cloth", "cloth_max_distance", "cloth_mask"];
        assert_eq!(nearest("cloth_max_distence", names), Some("cloth_max_distance"));
        assert_eq!(nearest("Cloth_Msak", names), Some("cloth_mask"));
        assert_eq!(nearest("weight", names), None);
    }
}
