//! The playground draws what it should: it runs without a window, writes a picture, and the cloths are in it.

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

use image::RgbImage;

use crate::colours::{Colour, share};

const SIZE: (u32, u32) = (640, 360);

/// Where a cloth must be seen, and what counts as its colour.
struct Expectation {
    name: &'static str,
    /// Left, top, right and bottom as fractions of the picture.
    region: [f32; 4],
    colour: Colour,
    /// Fraction of the region's pixels that must have the colour.
    share: f32,
}

#[rustfmt::skip]
const EXPECTATIONS: [Expectation; 4] = [
    Expectation { name: "curtain", region: [0.25, 0.30, 0.40, 0.60], colour: Colour { hue: [345.0, 15.0], saturation: [0.5, 1.0] }, share: 0.60 },
    Expectation { name: "cloth on the ball", region: [0.26, 0.66, 0.40, 0.80], colour: Colour { hue: [195.0, 225.0], saturation: [0.4, 1.0] }, share: 0.40 },
    Expectation { name: "tablecloth", region: [0.53, 0.66, 0.65, 0.80], colour: Colour { hue: [35.0, 50.0], saturation: [0.4, 1.0] }, share: 0.40 },
    Expectation { name: "flag", region: [0.65, 0.20, 0.83, 0.30], colour: Colour { hue: [180.0, 205.0], saturation: [0.4, 1.0] }, share: 0.35 },
];

#[test]
fn the_playground_shows_its_cloths() {
    let picture = capture_playground();
    assert_eq!(picture.dimensions(), SIZE);
    assert!(
        colour_variance(&picture) > 100.0,
        "the picture is blank: the variance of its colours is {}",
        colour_variance(&picture)
    );
    for expectation in &EXPECTATIONS {
        let share = share(&picture, expectation.region, expectation.colour);
        assert!(
            share >= expectation.share,
            "{}: {:.1} % of its region have its colour, expected at least {:.1} %; see {}",
            expectation.name,
            100.0 * share,
            100.0 * expectation.share,
            picture_path().display()
        );
    }
}

fn capture_playground() -> RgbImage {
    let picture = picture_path();
    // A picture from an earlier run must not pass for this one's.
    let _ = std::fs::remove_file(&picture);

    let program = playground_program();
    let output = Command::new(&program)
        .args(["--frames", "60", "--every", "60"])
        .args(["--size", &format!("{}x{}", SIZE.0, SIZE.1)])
        .arg("--capture")
        .arg(directory())
        .output()
        .unwrap_or_else(|error| {
            panic!("cannot run {}: {error}; `cargo build --example playground` builds it", program.display())
        });
    assert!(
        output.status.success(),
        "the playground failed ({}):\n{}",
        output.status,
        String::from_utf8_lossy(&output.stderr)
    );
    image::open(&picture).unwrap_or_else(|error| panic!("cannot read {}: {error}", picture.display())).to_rgb8()
}

fn directory() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("playground_picture")
}

fn picture_path() -> PathBuf {
    directory().join("frame_0060.png")
}

/// `cargo test` builds the examples into a folder next to that of the tests.
fn playground_program() -> PathBuf {
    let test = env::current_exe().expect("a test knows its own path");
    let profile = test.ancestors().nth(2).expect("tests are built into <profile>/deps");
    profile.join("examples").join(format!("playground{}", env::consts::EXE_SUFFIX))
}

/// The mean square of each channel's distance from its mean, in 8-bit steps squared.
fn colour_variance(picture: &RgbImage) -> f32 {
    let count = picture.pixels().len() as f32;
    let variance_of = |channel: usize| {
        let values = || picture.pixels().map(|pixel| f32::from(pixel.0[channel]));
        let mean = values().sum::<f32>() / count;
        values().map(|value| (value - mean).powi(2)).sum::<f32>() / count
    };
    (0..3).map(variance_of).sum::<f32>() / 3.0
}
