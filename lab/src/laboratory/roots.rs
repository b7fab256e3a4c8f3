//! Where a function that grows is zero.

/// The place between `low` and `high` at which `f` changes its sign from minus to plus, found by halving so many times.
pub fn bisect(halvings: u32, mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
