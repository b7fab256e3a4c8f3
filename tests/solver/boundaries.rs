//! The solver stays free of the engine.

use std::{fs, path::Path};

/// What a solver file must not name. The crate's own ECS side isn't allowed in either.
const FORBIDDEN: [&str; 14] = [
    "bevy::ecs",
    "bevy::app",
    "bevy::asset",
    "bevy::mesh",
    "bevy::render",
    "bevy::window",
    "bevy::transform",
    "bevy::time",
    "prelude::*",
    " Query<",
    "Res<",
    "Commands",
    "Component",
    "crate::{",
];

#[test]
fn no_file_of_the_solver_names_the_ecs_or_the_engine() {
    let mut files = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/solver.rs")];
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/solver"), &mut files);
    assert!(files.len() > 10, "the solver has moved: {files:?}");
    for file in files {
        let text = fs::read_to_string(&file).expect("a readable file");
        // The crates for SIMD and for tests have a prelude too.
        let others = ["use fearless_simd::", "use proptest::"];
        let of_engine = |line: &&str| !others.iter().any(|other| line.trim_start().starts_with(other));
        let text: String = text.lines().filter(of_engine).flat_map(|line| [line, "\n"]).collect();
        for word in FORBIDDEN {
            assert!(!text.contains(word), "{} names {word}", file.display());
        }
        let foreign = text.lines().find(|line| line.contains("use crate::") && !line.contains("crate::solver"));
        assert_eq!(foreign, None, "{}", file.display());
    }
}

fn collect(folder: &Path, files: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}
