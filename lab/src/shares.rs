//! Where the time of a frame goes.

use std::io;

use serde_json::{Map, Value, json};

use super::{
    hang::hang,
    measure,
    mesh::MeshSource,
    options::{Levels, Options, PinnedPart, Switch},
};

/// How often everything is run, by turns.
const ROUNDS: usize = 5;

/// What is left out, one after the other, each together with all before it. What remains moves freely.
const PARTS: [(&str, fn(&mut Options)); 5] = [
    ("levels", |options| options.levels = Levels::Set(Vec::new())),
    ("tethers", |options| options.tethers = Switch::Off),
    ("bending", |options| {
        options.stiffness[2] = 0.0;
        options.rigidity = Some(0.0);
    }),
    ("shear", |options| options.stiffness[1] = 0.0),
    ("threads", |options| options.stiffness[0] = 0.0),
];

/// Runs the hanging cloth with everything and with ever less. What a part takes is the difference of the fastest runs
/// with it and without.
pub fn of_frame(options: &Options) -> io::Result<Value> {
    // Without tethers a cloth would choose more substeps.
    let grid = &MeshSource::Grid;
    let policy = hang(options, grid, PinnedPart::Corners)?.cloths.swap_remove(0).rig.settings.substep_policy;
    let whole = Options { substeps: Some(policy.substeps), levels: Levels::Set(policy.levels), ..options.clone() };
    let mut settings = vec![whole];
    for (_, leave_out) in PARTS {
        let mut less = settings[settings.len() - 1].clone();
        leave_out(&mut less);
        settings.push(less);
    }
    let mut fastest = vec![f64::INFINITY; settings.len()];
    let mut line = Value::Null;
    for _ in 0..ROUNDS {
        for (options, fastest) in settings.iter().zip(&mut fastest).rev() {
            line = measure::run("shares", options, grid, hang(options, grid, PinnedPart::Corners)?, None)?;
            *fastest = line["us_per_frame_median"].as_f64().unwrap_or(f64::INFINITY).min(*fastest);
        }
    }
    let parts = PARTS.iter().zip(fastest.windows(2)).map(|((name, _), us)| (name.to_string(), (us[0] - us[1]).into()));
    let motion = ("motion".to_owned(), fastest[PARTS.len()].into());
    Ok(json!({
        "scene": "shares",
        "n": options.n,
        "substeps": line["substeps"],
        "levels": line["levels"],
        "us_per_frame": fastest[0],
        "us_of": parts.chain([motion]).collect::<Map<_, _>>(),
    }))
}
