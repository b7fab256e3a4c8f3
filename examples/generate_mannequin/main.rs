//! Writes `assets/mannequin.glb`, the dressed mannequin that tests and other examples animate:
//!
//! ```sh
//! cargo run --example generate_mannequin
//! ```
//!
//! It is 1.8 m tall, stands on y = 0 and looks along z. Below the node `Mannequin` (extra `cloth_body`) it has 17
//! joints, named as in Blender (`upper_arm.L`, Y along the bone), and skinned meshes:
//!
//! - `Body`: one closed surface. Left and right joints share no vertex of it.
//! - `Cape`: 24 x 32 quads from the shoulders to the calves, 2 cm off the body. At the collar it has the skin's
//!   weights, lower down those of the trunk.
//! - `CapeFine`: 96 x 128 quads of the same shape, for which `Cape` is the proxy.
//! - `Skirt`: a tube of 32 x 24 quads from the waist to the knees, on pelvis and thighs, with a UV seam behind.
//! - `Tunic`: two materials, cloth and trim, that meet in vertices of the same bits.
//!
//! Garments have the vertex attribute `_CLOTH`, from 0 where the skin holds them to 1 where they are loose, and extras
//! such as `cloth` (the fabric) and `cloth_max_distance` (m). Those of lower arms and hands keep them out of the body.
//! `docs/blender.md` tells of all of these.
//!
//! Its clips are loops in place: `idle`, `walk` (at 1.4 m/s the soles stand still), `run` (5 m/s), `jump` and `sit`
//! (on a seat 0.42 m high), and `turn`, which isn't one: half a turn to the left in 0.25 s. The game moves the model;
//! clips move the pelvis only, which `jump` lifts, `sit` lowers and `turn` turns.

mod anatomy;
mod body;
mod cape;
mod clips;
mod document;
mod field;
mod gait;
#[path = "../common/glb.rs"]
mod glb;
mod materials;
mod mesh;
mod pose;
mod sheet;
mod skeleton;
mod skin;
mod skirt;
mod surface;
mod tunic;

use std::{
    error::Error,
    fs,
    path::{Path, PathBuf},
};

fn main() -> Result<(), Box<dyn Error>> {
    let path = path();
    let file = document::file()?;
    fs::write(&path, &file)?;
    println!("{} ({} kB)", path.display(), file.len() / 1000);
    Ok(())
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mannequin.glb")
}

#[test]
fn the_file_is_up_to_date() -> Result<(), Box<dyn Error>> {
    assert!(fs::read(path())? == document::file()?, "run the example again");
    Ok(())
}
