//! Plays the clips of a glTF file: where its joints are at any moment.
//!
//! Bevy's own player does this in a game; it needs `bevy_animation`, which nothing else here does.

use std::{collections::BTreeMap, io, path::Path};

use bevy::prelude::*;
use gltf::animation::util::ReadOutputs;

/// A clip: how nodes move in their parents, by their names.
#[derive(Clone, Debug, Default)]
pub struct Clip {
    tracks: BTreeMap<String, Track>,
    /// Duration, s.
    pub duration: f32,
}

/// How a node moves.
#[derive(Clone, Debug, Default)]
struct Track {
    translations: Vec<(f32, Vec3)>,
    rotations: Vec<(f32, Quat)>,
}

impl Clip {
    /// Reads all clips of a binary glTF file, by their names.
    ///
    /// # Errors
    ///
    /// Where the file can't be read, or has no data of its own.
    pub fn read_all(path: &Path) -> io::Result<BTreeMap<String, Self>> {
        let file = gltf::Gltf::open(path).map_err(io::Error::other)?;
        let blob = file.blob.as_deref().ok_or_else(|| io::Error::other("the file has no binary chunk"))?;
        Ok(file
            .animations()
            .map(|clip| (clip.name().unwrap_or_default().to_owned(), Self::read(&clip, blob)))
            .collect())
    }

    fn read(animation: &gltf::Animation, blob: &[u8]) -> Self {
        let mut clip = Self::default();
        for channel in animation.channels() {
            let reader = channel.reader(|_| Some(blob));
            let times: Vec<f32> = reader.read_inputs().into_iter().flatten().collect();
            clip.duration = times.iter().copied().fold(clip.duration, f32::max);
            let track = clip.tracks.entry(channel.target().node().name().unwrap_or_default().to_owned()).or_default();
            match reader.read_outputs() {
                Some(ReadOutputs::Translations(places)) => {
                    track.translations = times.into_iter().zip(places.map(Vec3::from)).collect();
                }
                Some(ReadOutputs::Rotations(turns)) => {
                    track.rotations = times.into_iter().zip(turns.into_f32().map(Quat::from_array)).collect();
                }
                _ => {}
            }
        }
        clip
    }

    /// Moves a node of this name to where it is `time` seconds after the clip began, which starts again at its end.
    pub fn pose(&self, name: &str, time: f32, transform: &mut Transform) {
        let Some(track) = self.tracks.get(name) else { return };
        let time = time.rem_euclid(self.duration.max(f32::MIN_POSITIVE));
        if let Some((from, to, share)) = between(&track.translations, time) {
            transform.translation = from.lerp(to, share);
        }
        if let Some((from, to, share)) = between(&track.rotations, time) {
            transform.rotation = from.slerp(to, share);
        }
    }
}

/// The keys before and after a moment, and how far it is from one to the other.
fn between<T: Copy>(keys: &[(f32, T)], time: f32) -> Option<(T, T, f32)> {
    let after = keys.partition_point(|&(at, _)| at <= time);
    let (&(start, from), &(end, to)) = (keys.get(after.saturating_sub(1))?, keys.get(after).or(keys.last())?);
    Some((from, to, if end > start { (time - start) / (end - start) } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_lies_between_its_keys() {
        let keys = [(0.0, 1), (1.0, 2), (3.0, 3)];
        assert_eq!(between(&keys, 0.5), Some((1, 2, 0.5)));
        assert_eq!(between(&keys, 2.5), Some((2, 3, 0.75)));
        assert_eq!(between(&keys, -1.0), Some((1, 1, 0.0)));
        assert_eq!(between(&keys, 5.0), Some((3, 3, 0.0)));
        assert_eq!(between::<u8>(&[], 1.0), None);
    }
}
