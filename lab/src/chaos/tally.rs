//! Runs seeds side by side and sums up what came of them.

use core::sync::atomic::{AtomicU64, Ordering};
use std::{sync::Mutex, thread, time::Instant};

use serde_json::{Value, json};

use super::{options::Options, outcome::Outcome, trial};

/// All seeds of a run.
#[derive(Debug)]
pub struct Tally {
    /// In the order of their seeds.
    outcomes: Vec<Outcome>,
    /// How long it took, s.
    seconds: f64,
}

/// Runs seeds, and tells of each that fails as soon as it does.
pub fn run(options: &Options, tell: impl Fn(&Outcome) + Sync) -> Tally {
    let begun = Instant::now();
    let next = AtomicU64::new(options.seeds.0.start);
    let outcomes = Mutex::new(Vec::new());
    // What scenes tell isn't to be mixed.
    let all = thread::available_parallelism().map_or(1, usize::from);
    let threads = if options.verbose { 1 } else { options.threads.unwrap_or(all) };
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if !options.seeds.0.contains(&seed) {
                        break;
                    }
                    let outcome = trial::run(seed, options);
                    if outcome.has_failed() {
                        tell(&outcome);
                    }
                    if let Ok(mut outcomes) = outcomes.lock() {
                        outcomes.push(outcome);
                    }
                }
            });
        }
    });
    let mut outcomes = outcomes.into_inner().unwrap_or_default();
    outcomes.sort_unstable_by_key(|outcome: &Outcome| outcome.seed);
    Tally { outcomes, seconds: begun.elapsed().as_secs_f64() }
}

impl Tally {
    /// Whether something happened in any that never may.
    pub fn has_failed(&self) -> bool {
        self.outcomes.iter().any(Outcome::has_failed)
    }

    /// Of each seed, what its cloths came to.
    pub fn fingerprints(&self) -> Vec<u64> {
        self.outcomes.iter().map(|outcome| outcome.fingerprint).collect()
    }

    /// Seeds of which something is true.
    fn seeds(&self, is_so: impl Fn(&Outcome) -> bool) -> Vec<u64> {
        self.outcomes.iter().filter(|outcome| is_so(outcome)).map(|outcome| outcome.seed).collect()
    }

    fn count(&self, is_so: impl Fn(&Outcome) -> bool) -> usize {
        self.seeds(is_so).len()
    }

    fn worst(&self, of: impl Fn(&Outcome) -> f64) -> (u64, f64) {
        let all = self.outcomes.iter().map(|outcome| (outcome.seed, of(outcome)));
        all.max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or_default()
    }

    /// The line of the run.
    pub fn json(&self) -> Value {
        let (slowest, us_per_particle) = self.worst(|outcome| outcome.longest_per_particle);
        let (longest, ms) = self.worst(|outcome| outcome.longest_step * 1e3);
        json!({
            "scene": "chaos",
            "seeds": self.outcomes.len(),
            "seeds_in_range": self.count(|outcome| outcome.is_in_range),
            "seeds_with_running_cloth": self.count(|outcome| outcome.has_run),
            "frames": self.outcomes.iter().map(|outcome| u64::from(outcome.frames)).sum::<u64>(),
            "panics": self.seeds(|outcome| outcome.panic.is_some()),
            "not_finite": self.seeds(|outcome| outcome.not_finite > 0),
            "put_back_in_range": self.seeds(|outcome| outcome.is_in_range && outcome.put_back > 0),
            "put_back_out_of_range": self.seeds(|outcome| !outcome.is_in_range && outcome.put_back > 0),
            "cut_short": self.seeds(|outcome| outcome.is_cut_short),
            "worst_us_per_particle": us_per_particle.round(),
            "worst_us_per_particle_seed": slowest,
            "worst_step_ms": (ms * 10.0).round() / 10.0,
            "worst_step_seed": longest,
            "seeds_with_a_step_over_50_ms": self.count(|outcome| outcome.longest_step > 0.05),
            "seconds": self.seconds.round(),
        })
    }
}
