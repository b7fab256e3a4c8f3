//! How much faster one cloth is on several threads, and how much faster as many cloths are side by side.

use std::{io, time::Instant};

use serde_json::{Value, json};

use super::{
    hang::hang,
    measure::{self, median},
    mesh::MeshSource,
    options::{Options, PinnedPart},
};

/// Runs the hanging cloth in three ways by turns: on one thread, shared by several, and as many cloths as threads side by
/// side, each on its own. Wall clock.
pub fn compare(options: &Options) -> io::Result<Value> {
    let pool = measure::pool(options.threads)
        .ok_or_else(|| io::Error::other("--threads has to be 2 or more to be compared"))?;
    let cloth = || hang(options, &MeshSource::Grid, PinnedPart::Corners);
    let (mut alone, mut shared) = (cloth()?, cloth()?);
    let mut many = (0..options.threads).map(|_| cloth()).collect::<io::Result<Vec<_>>>()?;
    let mut microseconds = [const { Vec::new() }; 3];
    for _ in 0..options.frames {
        let mut time = |of: usize, work: &mut dyn FnMut()| {
            let begun = Instant::now();
            work();
            microseconds[of].push(begun.elapsed().as_secs_f64() * 1e6);
        };
        time(0, &mut || {
            alone.step(None);
        });
        time(1, &mut || {
            shared.step(Some(&pool));
        });
        time(2, &mut || {
            pool.scope(|scope| {
                many.iter_mut().for_each(|cloth| {
                    scope.spawn(async move {
                        cloth.step(None);
                    })
                })
            });
        });
    }
    let [alone_us, shared_us, many_us] = microseconds.map(median);
    let (speed_up, of_many) = (alone_us / shared_us, f64::from(options.threads) * alone_us / many_us);
    Ok(json!({
        "scene": "threads",
        "n": options.n,
        "threads": options.threads,
        "levels": measure::levels(&alone.cloths[0]),
        "us_one_thread": alone_us.round(),
        "us_shared": shared_us.round(),
        "us_side_by_side": many_us.round(),
        "speed_up": speed_up,
        "speed_up_side_by_side": of_many,
        "share": speed_up / of_many,
        "same_bits": alone.cloths[0].particles == shared.cloths[0].particles,
    }))
}
