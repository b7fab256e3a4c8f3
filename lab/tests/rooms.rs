//! The rooms of each package, its modules at the top, import each other in no circle: whoever reads one needs to know only what
//! is below it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

#[test]
fn no_rooms_of_the_solver_import_each_other_in_a_circle() {
    assert_no_circle("../solver/src", &[], 15);
}

#[test]
fn no_rooms_of_the_plugin_import_each_other_in_a_circle() {
    // The solver is another package, by another name.
    assert_no_circle("../src", &["solver", "drape_solver", "prelude"], 15);
}

#[test]
fn no_rooms_of_the_lab_import_each_other_in_a_circle() {
    assert_no_circle("src", &[], 15);
}

/// Looks at the rooms of a package whose sources are in `folder`. Its paths begin with one of at least `least` rooms, with what
/// `lib.rs` exports from them, or with one of the `others`.
#[track_caller]
fn assert_no_circle(folder: &str, others: &[&str], least: usize) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let table_of_contents = read_code(&source.join("lib.rs"));
    // Where what `crate::Name` means is from.
    let exports = ["pub use crate::", "pub use "].map(|start| paths_after(&table_of_contents, start));
    let exports: BTreeMap<String, String> = exports.into_iter().flatten().filter(|(_, room)| room != "crate").collect();
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files_of(&source) {
        let path = file.strip_prefix(&source).expect("a file of the package").with_extension("");
        let room = path.iter().next().expect("a name").to_string_lossy().into_owned();
        if room == "lib" || room == "main" {
            continue;
        }
        let of_room = imports.entry(room.clone()).or_default();
        if !path.ends_with("tests") {
            let names = paths_after(&read_code(&file), "crate::").into_iter().map(|(_, first)| first);
            let rooms = names.map(|name| exports.get(&name).cloned().unwrap_or(name));
            of_room.extend(rooms.filter(|name| *name != room && !others.contains(&name.as_str())));
        }
    }
    assert!(imports.len() >= least, "the sources have moved: {imports:?}");
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
