//! What two boxes have clamped comes free, whole, once they open.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// How far each box goes, m, and in how many steps.
const WAY: f32 = 0.3;
const STEPS: usize = 36;

/// The largest strain of a curtain of 1 m, 2 s after two boxes of that size have closed on it from both sides until nothing is
/// between them, held it for half a second and opened again.
fn strain_after(curtain: Mesh, size: Vec3) -> f32 {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, curtain, Pins::edge(ClothEdge::Top));
    let place = |side: f32, gap: f32| Transform::from_xyz(0.0, 0.0, side * (gap + size.z / 2.0));
    let boxes = [-1.0, 1.0].map(|side| {
        let collider = ClothCollider::from(Cuboid::from_size(size));
        (app.world_mut().spawn((collider, place(side, WAY))).id(), side)
    });
    run(&mut app, 60);
    let closing = (0..STEPS).rev();
    let opening = 1..=STEPS;
    for step in closing.chain([0; 30]).chain(opening) {
        for (entity, side) in boxes {
            *get_mut::<Transform>(&mut app, entity) = place(side, WAY * step as f32 / STEPS as f32);
        }
        run(&mut app, 1);
    }
    run(&mut app, 120);
    largest_strain(&app, cloth)
}

#[test]
fn boxes_that_close_on_a_curtain_let_it_go_when_they_open() {
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    for size in [Vec3::new(0.4, 0.3, 0.2), Vec3::new(1.2, 0.3, 0.2), Vec3::new(0.2, 0.2, 0.1)] {
        for (kind, curtain) in [("rows and columns", Mesh::from(grid)), ("an uneven mesh", uneven(grid, 0.2))] {
            let strain = strain_after(curtain, size);
            assert!(strain < 0.06, "{kind}, boxes of {size} m: a strain of {strain}");
        }
    }
}
