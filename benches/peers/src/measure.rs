//! Runs the scene in a peer and measures time and strain.

use cpu_time::ThreadTime;

use crate::{line::Line, scene::Cloth};

/// Frames of a run.
const FRAMES: usize = 300;

/// Frames at the end that the strain is averaged over.
const LAST: usize = 60;

/// Frames in a quarter of a second, when the cloth falls fastest: then its height tells most about time.
const QUARTER_SECOND: usize = 15;

/// A solver with the cloth in it.
pub trait Peer {
    /// Advances the cloth by one frame. Only this is timed.
    fn step(&mut self);

    /// Where the particles are, in the order of the scene's, m.
    fn positions(&self) -> Vec<[f32; 3]>;
}

/// What is run, in words.
pub struct Name<'a> {
    /// What solves the cloth.
    pub system: &'a str,
    /// Which release of it.
    pub version: &'a str,
    /// How it is set.
    pub setting: &'a str,
}

/// Runs `peer`, which holds `cloth`, for 300 frames.
///
/// Time is that of the calling thread: peers run on it alone.
pub fn run(name: &Name, cloth: &Cloth, peer: &mut impl Peer) -> Line {
    let mut microseconds = Vec::new();
    let mut strains = Vec::new();
    let mut finite = true;
    let mut height = None;
    for frame in 1..=FRAMES {
        let start = ThreadTime::now();
        peer.step();
        microseconds.push(start.elapsed().as_secs_f64() * 1e6);
        let positions = peer.positions();
        finite &= positions.iter().flatten().all(|x| x.is_finite());
        if frame == QUARTER_SECOND {
            height = Some(mean_height(&positions));
        }
        if frame > FRAMES - LAST {
            strains.push(strain(cloth, &positions));
        }
    }
    let mean =
        |value: fn(&Strain) -> f64| finite.then(|| (strains.iter().map(value).sum::<f64>() / LAST as f64) as f32);
    Line {
        system: name.system.into(),
        version: name.version.into(),
        setting: name.setting.into(),
        n: cloth.n,
        us_per_frame_median: median(microseconds).round(),
        max_strain: mean(|strain| strain.max),
        mean_strain: mean(|strain| strain.mean),
        finite,
        mean_height_at_quarter_second: height.filter(|height| height.is_finite()),
    }
}

/// The strain of a frame's structural springs.
struct Strain {
    max: f64,
    mean: f64,
}

fn strain(cloth: &Cloth, positions: &[[f32; 3]]) -> Strain {
    let rest = f64::from(cloth.spacing());
    let (mut max, mut sum, mut count) = (f64::MIN, 0.0, 0);
    for [a, b] in cloth.pairs(1) {
        let square = |i: usize| (f64::from(positions[b][i]) - f64::from(positions[a][i])).powi(2);
        let strain = (square(0) + square(1) + square(2)).sqrt() / rest - 1.0;
        max = strain.max(max);
        sum += strain.max(0.0);
        count += 1;
    }
    Strain { max, mean: sum / f64::from(count) }
}

/// Mean height of `positions`, m.
pub fn mean_height(positions: &[[f32; 3]]) -> f32 {
    (positions.iter().map(|p| f64::from(p[1])).sum::<f64>() / positions.len() as f64) as f32
}

/// The middle one of `values`.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cloth that is drawn out along X.
    struct Drawn(Vec<[f32; 3]>);

    impl Peer for Drawn {
        fn step(&mut self) {}

        fn positions(&self) -> Vec<[f32; 3]> {
            self.0.clone()
        }
    }

    const NAME: Name = Name { system: "drawn", version: "1", setting: "by half" };

    #[test]
    fn strain_is_that_of_the_springs() {
        let cloth = Cloth::hanging(6);
        let mut drawn = Drawn(cloth.rest.iter().map(|&[x, y, z]| [1.5 * x, y + 2.0, 0.9 * z]).collect());
        let line = run(&NAME, &cloth, &mut drawn);
        assert!((line.max_strain.unwrap() - 0.5).abs() < 1e-5);
        // Half of the springs are compressed and count as 0.
        assert!((line.mean_strain.unwrap() - 0.25).abs() < 1e-5);
        assert!((line.mean_height_at_quarter_second.unwrap() - 2.0).abs() < 1e-6);
    }

    #[test]
    fn cloth_that_blew_up_has_no_strain() {
        let cloth = Cloth::hanging(3);
        let mut broken = Drawn(vec![[f32::NAN; 3]; 9]);
        let line = run(&NAME, &cloth, &mut broken);
        assert!(!line.finite);
        assert_eq!(line.max_strain, None);
    }
}
