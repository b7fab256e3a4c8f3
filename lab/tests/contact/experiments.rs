//! The lab's experiments, watched frame by frame.

use drape_lab::scene::{Look, Scene, Settings};

/// What an experiment was like.
#[derive(Debug)]
pub struct Watched {
    /// After the last frame.
    pub end: Look,
    /// The worst of all frames, each value by itself.
    pub worst: Look,
    /// Of pairs of triangles that pass through each other, over the triangles that there are.
    pub worst_share: f32,
}

/// The lab's own settings for sheets that meet themselves.
pub fn self_colliding(n: u32, frames: u32) -> Settings {
    Settings::standard(n, frames, true)
}

/// Those for sheets that don't.
pub fn alone(n: u32, frames: u32) -> Settings {
    Settings::standard(n, frames, false)
}

/// Runs a scene for as many frames as it has time for.
pub fn watch(mut scene: Scene) -> Watched {
    let frames = scene.surroundings.settings.frames;
    let mut watched = Watched { end: Look::default(), worst: Look::default(), worst_share: 0.0 };
    for frame in 0..frames {
        scene.lead();
        scene.step(None);
        let finite = scene.cloths.iter().all(|cloth| cloth.particles.is_finite());
        assert!(finite, "frame {frame}: something isn't finite");
        let look = Look::at(&scene);
        watched.worst = watched.worst.worse_of(&look);
        watched.end = look;
    }
    watched.worst_share = watched.worst.intersecting_pairs as f32 / scene.triangle_count() as f32;
    watched
}

/// The bits of all positions and velocities after `frames`.
pub fn bits_after(scene: &mut Scene, frames: u32) -> Vec<u32> {
    for _ in 0..frames {
        scene.lead();
        scene.step(None);
    }
    let all = scene.cloths.iter().flat_map(|cloth| cloth.particles.position.iter().chain(&cloth.particles.velocity));
    all.flat_map(|value| value.to_array()).map(f32::to_bits).collect()
}
