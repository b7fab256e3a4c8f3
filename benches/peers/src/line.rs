//! What a run says: a line of JSON.

use serde::{Deserialize, Serialize};

/// A run of the scene `hang`.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Line {
    /// What solved the cloth.
    pub system: String,
    /// Which release of it.
    pub version: String,
    /// How it was set: the number that is swept, then, after a comma, what else differs.
    pub setting: String,
    /// Particles along each side.
    pub n: usize,
    /// Median CPU time of a frame, µs.
    pub us_per_frame_median: f64,
    /// Mean over the last second of each frame's largest strain of a structural spring; none if not finite.
    pub max_strain: Option<f32>,
    /// The same of each frame's mean strain, where a compressed spring counts as 0.
    pub mean_strain: Option<f32>,
    /// Whether all positions stayed finite.
    pub finite: bool,
    /// Mean height of the particles after a quarter of a second, m: tells whether systems advance the same time.
    #[serde(default)]
    pub mean_height_at_quarter_second: Option<f32>,
}
