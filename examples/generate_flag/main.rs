//! Writes `assets/flag.glb`, the flag that the playground hangs on a pole, and its fabric:
//!
//! ```sh
//! cargo run --example generate_flag
//! ```
//!
//! It has what makes real models awkward as cloth: a UV seam in the middle, where one point of the cloth is two
//! vertices of the mesh, and pins that come from the modelling tool, as the vertex attribute `_PIN`. That it is cloth, and
//! of which fabric, its property `cloth` says.

mod document;
#[path = "../common/glb.rs"]
mod glb;
mod mesh;
mod picture;

use std::{error::Error, fs, path::Path};

use bevy_drape::prelude::Fabric;

/// Width and height of the cloth in metres.
const SIZE: [f32; 2] = [1.5, 1.0];

/// The file of the fabric.
const FABRIC: &str = "flag.fabric.ron";

fn main() -> Result<(), Box<dyn Error>> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let path = directory.join("flag.glb");
    let file = document::file(&mesh::flag(), &picture::png()?)?;
    fs::create_dir_all(&directory)?;
    // Stiff enough for cells of 5 cm to show its folds.
    let fabric = Fabric { bending_rigidity: 60e-6, ..Fabric::POLYESTER_TABLECLOTH };
    fs::write(directory.join(FABRIC), fabric.to_ron())?;
    fs::write(&path, &file)?;
    println!("{} ({} kB)", path.display(), file.len() / 1000);
    Ok(())
}
