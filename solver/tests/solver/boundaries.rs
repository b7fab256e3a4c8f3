//! The solver stays free of the engine.

use std::fs;

/// All that the solver may depend on: nothing that knows entities, assets, meshes or windows.
const ALLOWED: [&str; 7] =
    ["bevy_math", "bevy_platform", "bevy_reflect", "bevy_tasks", "fastnoise-lite", "fearless_simd", "thiserror"];

#[test]
fn the_solver_depends_on_no_engine() {
    let manifest = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")).expect("a readable file");
    let (mut heading, mut found) = ("", Vec::new());
    for line in manifest.lines() {
        if line.starts_with('[') {
            heading = line.trim_end();
            let is_known = ["[dependencies]", "[dev-dependencies]"].contains(&heading);
            assert!(is_known || !heading.contains("dependencies"), "dependencies of a kind not looked at: {heading}");
        } else if let Some(name) = line.split(['=', '.', ' ']).next().filter(|name| line.len() > name.len()) {
            let is_name = name.starts_with(|c: char| c.is_alphanumeric());
            match heading {
                "[dependencies]" if is_name => found.push(name),
                "[dev-dependencies]" => assert!(!name.starts_with("bevy"), "tests use {name}"),
                _ => {}
            }
        }
    }
    assert_eq!(found, ALLOWED);
}
