//! Numbers that look random and are the same everywhere.

/// A number in -1..=1 without a pattern: the bits of the index, well mixed. After the mixer at the end of MurmurHash3 (Appleby
/// 2011).
pub(crate) fn noise(i: u32) -> f32 {
    let mixed = i.wrapping_add(1).wrapping_mul(0x9e37_79b9);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    (mixed ^ (mixed >> 13)) as i32 as f32 / i32::MAX as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_goes_both_ways_and_is_no_more_than_one() {
        let noises: Vec<f32> = (0..1000).map(noise).collect();
        assert!(noises.iter().all(|noise| (-1.0..=1.0).contains(noise)));
        let mean = noises.iter().sum::<f32>() / 1000.0;
        let square = noises.iter().map(|noise| noise * noise).sum::<f32>() / 1000.0;
        assert!(mean.abs() < 0.05 && (square - 1.0 / 3.0).abs() < 0.03, "{mean}, {square}");
    }
}
