//! The solver stays free of the engine, and its rooms of circles.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

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

#[test]
fn no_rooms_of_the_solver_import_each_other_in_a_circle() {
    let solver = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/solver");
    let mut files = Vec::new();
    collect(&solver, &mut files);
    let room_of = |file: &Path| {
        let path = file.strip_prefix(&solver).expect("a file of the solver").with_extension("");
        path.iter().next().expect("a name").to_string_lossy().into_owned()
    };
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in &files {
        imports.entry(room_of(file)).or_default();
    }
    let rooms: BTreeSet<String> = imports.keys().cloned().collect();
    for file in files.iter().filter(|file| file.file_stem().is_some_and(|name| name != "tests")) {
        let text = fs::read_to_string(file).expect("a readable file");
        let code = text.split("#[cfg(test)]\nmod tests").next().expect("a first part");
        let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let room = room_of(file);
        let of_room = imports.get_mut(&room).expect("it is known");
        of_room.extend(named_after(&code, "crate::solver::").filter(|name| *name != room && rooms.contains(name)));
    }
    // What imports nothing but what is out already goes out, until nothing does.
    while let Some(free) = imports.iter().find(|(_, of)| of.iter().all(|room| !imports.contains_key(room))) {
        let free = free.0.clone();
        imports.remove(&free);
    }
    assert!(imports.is_empty(), "these import each other in circles: {imports:#?}");
}

/// The names that follow a path in some code, also within braces: of `path::{a::b, c::{d, e}}`, a and c.
fn named_after<'a>(code: &'a str, path: &'a str) -> impl Iterator<Item = String> + 'a {
    code.match_indices(path).flat_map(move |(at, _)| {
        let rest = &code[at + path.len()..];
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let Some(list) = rest.strip_prefix('{') else {
            return vec![rest.chars().take_while(|&c| is_name(c)).collect()];
        };
        let (mut depth, mut begins, mut names) = (0, true, Vec::new());
        for (at, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                _ if depth == 0 && begins && is_name(c) => {
                    names.push(list[at..].chars().take_while(|&c| is_name(c)).collect());
                    begins = false;
                }
                _ => {}
            }
        }
        names
    })
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
