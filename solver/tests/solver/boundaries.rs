//! The solver stays free of the engine, and its rooms of circles.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// All that the solver may depend on: nothing that knows entities, assets, meshes or windows.
const ALLOWED: [&str; 7] =
    ["bevy_math", "bevy_platform", "bevy_reflect", "bevy_tasks", "fastnoise-lite", "fearless_simd", "thiserror"];

#[test]
fn the_solver_depends_on_no_engine() {
    let manifest = fs::read_to_string(package().join("Cargo.toml")).expect("a readable file");
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

#[test]
fn no_rooms_of_the_solver_import_each_other_in_a_circle() {
    let source = package().join("src");
    let table_of_contents = read_code(&source.join("lib.rs"));
    // Where what `crate::Name` means is from.
    let exports: BTreeMap<String, String> = paths_after(&table_of_contents, "pub use crate::").into_iter().collect();
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files_of(&source) {
        let path = file.strip_prefix(&source).expect("a file of the solver").with_extension("");
        let room = path.iter().next().expect("a name").to_string_lossy().into_owned();
        if room == "lib" {
            continue;
        }
        let of_room = imports.entry(room.clone()).or_default();
        if !path.ends_with("tests") {
            let names = paths_after(&read_code(&file), "crate::").into_iter().map(|(_, first)| first);
            of_room.extend(names.map(|name| exports.get(&name).cloned().unwrap_or(name)).filter(|name| *name != room));
        }
    }
    assert!(imports.len() > 10 && exports.len() > 50, "the solver has moved: {imports:?}, {exports:?}");
    for (room, of) in &imports {
        assert!(of.iter().all(|name| imports.contains_key(name)), "{room} imports what is no room: {of:?}");
    }
    // What imports nothing but what is out already goes out, until nothing does.
    while let Some(free) = imports.iter().find(|(_, of)| of.iter().all(|room| !imports.contains_key(room))) {
        let free = free.0.clone();
        imports.remove(&free);
    }
    assert!(imports.is_empty(), "these import each other in circles: {imports:#?}");
}

/// The last and the first name of each path that goes on from `start` in some code: of `start::{a::b, c::{d, e}}`, those are
/// b and a, d and c, e and c.
fn paths_after(code: &str, start: &str) -> Vec<(String, String)> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut paths = Vec::new();
    for (at, _) in code.match_indices(start) {
        let tree = &code[at + start.len()..];
        let mut depth = 0;
        let end = tree.find(|c: char| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth < 0 || depth == 0 && !is_name(c) && !":}".contains(c)
        });
        paths.extend(expanded(&tree[..end.unwrap_or(tree.len())]));
    }
    paths
}

/// The last and the first name of each path of a tree of them.
fn expanded(tree: &str) -> Vec<(String, String)> {
    let mut depth = 0;
    let branches = tree.split(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth == 0 && c == ','
    });
    let mut paths = Vec::new();
    for branch in branches.map(str::trim).filter(|branch| !branch.is_empty()) {
        let of_branch = match branch.split_once('{') {
            Some((_, inner)) => expanded(inner.strip_suffix('}').unwrap_or(inner)),
            None => vec![(branch.rsplit("::").next().expect("a name").into(), branch.into())],
        };
        let first = branch.split([':', '{']).next().filter(|first| !first.is_empty());
        let with_first = |(last, other): (String, String)| (last, first.map_or(other, str::to_owned));
        paths.extend(of_branch.into_iter().map(with_first));
    }
    paths
}

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The code of a file without comments and its tests.
fn read_code(file: &Path) -> String {
    let text = fs::read_to_string(file).expect("a readable file");
    let code = text.split("#[cfg(test)]\nmod tests").next().expect("a first part");
    code.lines().filter(|line| !line.trim_start().starts_with("//")).flat_map(|line| [line, "\n"]).collect()
}

fn files_of(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { files_of(&path) } else { vec![path] }).collect()
}
