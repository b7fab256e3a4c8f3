//! Normal forces of contacts, from step to step.

/// Normal forces of contacts at the end of a step, with which friction of the next begins. Empty where nothing was touched, and
/// where no implicit steps solve the cloth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLoad {
    /// Of obstacles on each particle, N.
    pub particles: Vec<f32>,
    /// Of pairs of features, in the order of what they are of.
    pub features: Vec<FeatureLoad>,
}

/// Normal force of a pair of features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureLoad {
    /// What the four points of the pair are: particles, or points of obstacles.
    pub key: [u32; 4],
    /// N
    pub force: f32,
}
