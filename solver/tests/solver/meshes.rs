//! Cloth and obstacles of triangles.

use std::sync::Arc;

use bevy_math::{Isometry3d, Quat, Vec3, Vec3A};
use drape_solver::{DeformedPoints, Material, MeshShape, Method, Obstacle, Shape, SourceMesh, TriangleMesh};

use crate::{
    bench_bed::{Bed, STABLE},
    fixtures::{
        material::{Springs, springs},
        mesh::icosphere,
    },
};

/// A box with this size, m, of twelve triangles that face out of it.
pub fn cuboid(size: Vec3) -> TriangleMesh {
    let corner = |i: usize| Vec3A::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    let points = (0..8).map(|i| corner(i) * Vec3A::from(size)).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new(points, &triangles, true)
}

/// A ball of triangles.
pub fn ball(radius: f32, subdivisions: u32) -> TriangleMesh {
    let SourceMesh { positions, triangles, .. } = icosphere(radius, subdivisions + 1);
    // Each side has vertices of its own.
    let first = |i: u32| {
        let place = positions[i as usize];
        positions.iter().position(|p| p.distance(place) < 1e-5).map_or(i, |first| first as u32)
    };
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|corners| corners.map(first)).collect();
    TriangleMesh::new(positions.into_iter().map(Vec3A::from).collect(), &triangles, true)
}

fn shape(mesh: TriangleMesh) -> Shape {
    Shape::Mesh(MeshShape { mesh: Arc::new(mesh), deformed: None })
}

fn still(mesh: TriangleMesh, place: Vec3) -> Obstacle {
    Obstacle::still(shape(mesh), Isometry3d::from_translation(place))
}

fn cotton(thickness: f32) -> Material {
    Material { friction: 0.5, thickness, ..springs(Springs::default()) }
}

/// A square metre above the origin, as a game would run it.
fn sheet(method: Method, n: u32, height: f32) -> Bed {
    let mut bed = Bed::lying(n, Material { damping: 1.0, ..cotton(0.004) }).like_a_game(method);
    bed.particles.position.iter_mut().for_each(|place| place.y += height);
    bed
}

/// All places that are looked at: particles and the middles of edges and triangles.
fn places(bed: &Bed) -> Vec<Vec3A> {
    let at = |i: u32| bed.particles.position[i as usize];
    let of_triangle = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(at);
        [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
    };
    bed.topology.triangles.iter().flat_map(of_triangle).collect()
}

#[test]
fn a_cloth_on_a_ball_of_triangles_stays_outside_and_comes_to_rest() {
    for method in STABLE {
        let mut bed = sheet(method, 24, 0.45);
        bed.obstacles = vec![still(ball(0.3, 8), Vec3::Y * 0.1)];
        for _ in 0..300 {
            bed.step(1.0 / 60.0);
            // The ball lies between its corners and the middles of its triangles.
            let nearest = bed.particles.position.iter().map(|p| p.distance(Vec3A::Y * 0.1)).fold(f32::MAX, f32::min);
            assert!(nearest > 0.3 * 0.98, "{method:?}: {nearest}");
        }
        assert!(bed.centre().with_y(0.0).length() < 0.05, "{method:?} slid off: {}", bed.centre());
        assert!(bed.fastest() < 0.05, "{method:?}: still {} m/s", bed.fastest());
    }
}

#[test]
fn a_box_of_twelve_triangles_keeps_its_corners_and_edges_to_itself() {
    for turn in [Quat::IDENTITY, Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Y)] {
        let mut bed = sheet(Method::Strands, 16, 0.45);
        let pose = Isometry3d::new(Vec3::ZERO, turn);
        bed.obstacles = vec![Obstacle::still(shape(cuboid(Vec3::splat(0.4))), pose)];
        let mut deepest: f32 = 0.0;
        for _ in 0..120 {
            bed.step(1.0 / 60.0);
            let depth = |p: Vec3A| 0.2 - pose.inverse().transform_point(p).abs().max_element();
            deepest = places(&bed).into_iter().map(depth).fold(deepest, f32::max);
        }
        assert!(deepest < 0.001, "{turn}: {deepest} m");
        assert!(bed.centre().y > -0.3, "{turn}: {} fell past it", bed.centre());
    }
}

#[test]
fn a_cloth_inside_of_a_closed_mesh_comes_out_gently() {
    let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(Method::Strands, 12, 0.0) };
    // The whole cloth is inside.
    bed.obstacles = vec![still(cuboid(Vec3::new(1.4, 0.3, 1.4)), Vec3::Y * 0.04)];
    for _ in 0..60 {
        bed.step(1.0 / 60.0);
        assert!(bed.fastest() < 3.0, "{} m/s", bed.fastest());
    }
    let inside = bed.particles.position.iter().filter(|p| {
        let local = (**p - Vec3A::Y * 0.04).abs();
        local.x < 0.7 && local.y < 0.15 && local.z < 0.7
    });
    assert_eq!(inside.count(), 0);
}

#[test]
fn a_thin_sheet_of_triangles_holds_from_either_side() {
    let flat = || {
        let points = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[x, z]| Vec3A::new(x as f32, 0.0, z as f32)).to_vec();
        TriangleMesh::new(points, &[[0, 1, 2], [0, 2, 3]], false)
    };
    for side in [1.0, -1.0] {
        let mut bed = sheet(Method::Strands, 12, 0.2 * side);
        bed.gravity *= side;
        bed.obstacles = vec![still(flat(), Vec3::ZERO)];
        for _ in 0..60 {
            bed.step(1.0 / 60.0);
            let nearest = bed.particles.position.iter().map(|p| p.y * side).fold(f32::MAX, f32::min);
            assert!(nearest > 0.0035, "{nearest}");
        }
        assert!(bed.centre().y * side < 0.01);
    }
}

/// A bowl of 2 m width and 0.4 m depth, of cells of 10 cm: a shell, or hollowed out of what comes to a point below it.
fn bowl(is_closed: bool) -> TriangleMesh {
    const CELLS: u32 = 20;
    let node = |column: u32, row: u32| row * (CELLS + 1) + column;
    let at = |i: u32| i as f32 * 0.1 - 1.0;
    let rows = (0..=CELLS).flat_map(|row| (0..=CELLS).map(move |column| (column, row)));
    let mut points: Vec<Vec3A> = rows
        .map(|(column, row)| Vec3A::new(at(column), BOWL * (at(column).powi(2) + at(row).powi(2)), at(row)))
        .collect();
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (column, row)));
    let mut triangles: Vec<[u32; 3]> = cells
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            [[a, c, b], [a, d, c]]
        })
        .collect();
    if is_closed {
        let tip = points.len() as u32;
        points.push(Vec3A::NEG_Y);
        triangles.extend((0..CELLS).flat_map(|i| {
            let last = CELLS;
            let sides =
                [[(i, 0), (i + 1, 0)], [(i + 1, last), (i, last)], [(0, i + 1), (0, i)], [(last, i), (last, i + 1)]];
            sides.map(|[from, to]| [node(from.0, from.1), node(to.0, to.1), tip])
        }));
    }
    TriangleMesh::new(points, &triangles, is_closed)
}

/// Height of the bowl above its deepest place, over the square of the distance to its axis, 1/m.
const BOWL: f32 = 0.2;

/// Height of the triangles of the bowl at a place, m.
fn bowl_height(p: Vec3A) -> f32 {
    let [x, z] = [p.x, p.z].map(|x| (x + 1.0) * 10.0);
    let height = |i: f32, j: f32| BOWL * ((i.floor() * 0.1 - 1.0).powi(2) + (j.floor() * 0.1 - 1.0).powi(2));
    let (u, v) = (x.fract(), z.fract());
    let [here, both] = [height(x, z), height(x + 1.0, z + 1.0)];
    if u > v {
        let beside = height(x + 1.0, z);
        here + u * (beside - here) + v * (both - beside)
    } else {
        let beside = height(x, z + 1.0);
        here + v * (beside - here) + u * (both - beside)
    }
}

#[test]
fn a_bowl_catches_cloth_whether_solid_or_a_shell() {
    for (method, is_closed) in STABLE.into_iter().flat_map(|method| [(method, true), (method, false)]) {
        let mut bed = sheet(method, 24, 0.6);
        bed.obstacles = vec![still(bowl(is_closed), Vec3::ZERO)];
        for _ in 0..300 {
            bed.step(1.0 / 60.0);
            let above = |p: &Vec3A| p.y - bowl_height(*p);
            let lowest = bed.particles.position.iter().map(above).fold(f32::MAX, f32::min);
            assert!(lowest > 0.0035, "{method:?}, closed: {is_closed}: {lowest} m");
        }
        let highest = bed.particles.position.iter().map(|p| p.y - bowl_height(*p)).fold(0.0, f32::max);
        assert!(highest < 0.05, "{method:?}, closed: {is_closed}: {highest} m above");
        assert!(bed.fastest() < 0.05, "{method:?}, closed: {is_closed}: still {} m/s", bed.fastest());
    }
}

#[test]
fn a_mesh_at_thirty_metres_a_second_is_not_passed() {
    for (mesh, reach) in [(cuboid(Vec3::new(0.3, 0.01, 0.3)), 0.005), (ball(0.1, 3), 0.095)] {
        let shape = shape(mesh);
        let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(Method::Strands, 16, 0.0) };
        let place = |frame: i32| Isometry3d::from_translation(Vec3::Y * (0.8 - frame as f32 * 0.5));
        for frame in 0..4 {
            bed.obstacles = vec![Obstacle::moving(shape.clone(), place(frame), place(frame + 1))];
            bed.step(1.0 / 60.0);
        }
        let bottom = place(4).translation.y - reach;
        let lowest = bed.particles.position.iter().map(|p| p.y).fold(0.0, f32::min);
        assert!(lowest < bottom + 0.005, "passed: nothing below {lowest} m, the mesh is at {bottom}");
    }
}

#[test]
fn a_mesh_that_changes_its_shape_carries_the_cloth() {
    let (mesh, mut bed) = (Arc::new(cuboid(Vec3::new(0.8, 0.2, 0.8))), sheet(Method::Strands, 12, 0.15));
    // It grows upwards by 0.3 m in a second.
    let grown = |share: f32| -> Arc<[Vec3A]> {
        mesh.points.iter().map(|p| if p.y > 0.0 { *p + Vec3A::Y * (0.3 * share) } else { *p }).collect()
    };
    for frame in 0..60 {
        let ends = [frame, frame + 1].map(|frame| grown(frame as f32 / 60.0));
        let shape = MeshShape { mesh: mesh.clone(), deformed: Some(DeformedPoints::new(ends)) };
        bed.obstacles = vec![Obstacle::still(Shape::Mesh(shape), Isometry3d::IDENTITY)];
        bed.step(1.0 / 60.0);
    }
    let on_top = bed.particles.position.iter().filter(|p| p.x.abs() < 0.3 && p.z.abs() < 0.3);
    for place in on_top {
        assert!((place.y - 0.404).abs() < 0.01, "{place}");
    }
}

#[test]
fn a_mesh_of_nothing_is_no_obstacle() {
    let mut bed = sheet(Method::Strands, 6, 0.1);
    bed.obstacles = vec![still(TriangleMesh::new(Vec::new(), &[], false), Vec3::ZERO)];
    bed.run(0.2);
    assert!(bed.particles.is_finite() && bed.centre().y < 0.0);
}
