//! Experiments without a window: one JSON line each on standard output, for comparing machines and versions.
//!
//! ```text
//! cargo run --release -p drape_lab -- hang --n 64 --substeps 8 --frames 300 --solver xpbd
//! cargo run --release -p drape_lab -- hang --n 64 --mesh delaunay --compare-oracle
//! cargo run --release -p drape_lab -- drape --n 64 --mesh assets/flag.glb
//! cargo run --release -p drape_lab -- --sweep
//! cargo run --release -p drape_lab -- --help
//! ```

use std::process::ExitCode;

fn main() -> ExitCode {
    drape_lab::command_line::main()
}
