//! What came of a seed.

use serde_json::{Value, json};

/// What came of a seed.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    pub seed: u64,
    /// Whether its settings stay within their documented ranges.
    pub is_in_range: bool,
    /// Frames that have run.
    pub frames: u32,
    /// Whether it took longer than it may, and was cut short.
    pub is_cut_short: bool,
    /// Whether a cloth of it has run.
    pub has_run: bool,
    /// The first message of a panic.
    pub panic: Option<String>,
    /// Frames after which something wasn't finite, and what it was in the first of them.
    pub not_finite: u32,
    pub first_not_finite: Option<String>,
    /// Times that a cloth was put back to its last finite pose, and which first was.
    pub put_back: u32,
    pub first_put_back: Option<String>,
    /// The longest step, s, and the longest over the number of particles, µs.
    pub longest_step: f64,
    pub longest_per_particle: f64,
    /// Of the positions of all cloths at the end: the same for the same scene.
    pub fingerprint: u64,
}

impl Outcome {
    /// Whether something happened that never may.
    pub fn has_failed(&self) -> bool {
        self.panic.is_some() || self.not_finite > 0 || self.is_in_range && self.put_back > 0
    }

    /// All that is worth a line of its own.
    pub fn json(&self) -> Value {
        json!({
            "scene": "chaos seed",
            "seed": self.seed,
            "in_range": self.is_in_range,
            "frames": self.frames,
            "panic": self.panic,
            "not_finite": self.not_finite,
            "first_not_finite": self.first_not_finite,
            "put_back": self.put_back,
            "first_put_back": self.first_put_back,
        })
    }
}
