//! The hanging cloth in several sizes.

use std::io;

use crate::measure::Measure;

/// Particles along each side.
pub const ALL: [u32; 6] = [16, 32, 64, 128, 256, 512];

/// Settings that hold a cloth of up to so many particles along each side at about 1 % for little time. Those above are
/// stretched more by their own springs.
const FOUND: [(u32, &str); 6] = [
    (16, "--substeps 2 --levels none"),
    (32, "--substeps 2 --levels 8x4"),
    (64, "--substeps 2 --levels 16x4,8x4"),
    (128, "--substeps 2 --levels 16x8,8x8,4x4"),
    (256, "--substeps 3 --levels 32x8,16x8,8x8"),
    (u32::MAX, "--substeps 4 --levels 64x8,32x8,16x8,8x8"),
];

/// Prints what a cloth of each of these sizes costs and how far it is stretched, by the default dial and as was found,
/// on one thread and on two.
pub fn run(sizes: &[u32], measure: Measure) -> io::Result<()> {
    for &n in sizes {
        let found = FOUND.iter().find(|&&(up_to, _)| n <= up_to).map(|&(_, settings)| settings);
        for settings in ["--max-strain 0.01"].into_iter().chain(found) {
            for threads in [1, 2] {
                let mut line = measure(&format!("hang --n {n} {settings} --threads {threads}"))?;
                line["settings"] = settings.into();
                println!("{line}");
            }
        }
    }
    Ok(())
}
