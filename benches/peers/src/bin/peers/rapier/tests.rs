use super::*;

#[test]
fn its_edges_are_the_springs() {
    let cloth = Cloth::hanging(7);
    let body = with_springs(&cloth);
    let diagonals = 2 * 6 * 6;
    assert_eq!(body.edges.len(), cloth.pairs(1).count() + diagonals);
    assert_eq!(body.bend_edges.len(), cloth.pairs(2).count());
    assert_eq!(body.edge_softness.len(), body.edges.len());
    let name = |[a, b]: [u32; 2]| [a.min(b) as usize, a.max(b) as usize];
    let edges: Vec<_> = body.edges.into_iter().map(name).collect();
    assert!(cloth.pairs(1).all(|pair| edges.contains(&pair)), "particles are numbered otherwise");
}

#[test]
fn free_cloth_falls_as_a_stone() {
    let mut rapier = Rapier::new(&Cloth::free(8), 8, true);
    for _ in 0..30 {
        rapier.step();
    }
    let fall = -0.5 * GRAVITY * 0.5 * (0.5 + FRAME / 8.0);
    let height = measure::mean_height(&rapier.positions());
    assert!((height - fall).abs() < 1e-3, "{height} m");
}

#[test]
fn two_particles_swing_as_the_spring_that_they_stand_for() {
    // Half a period after a soft spring was let go, drawn out by a tenth, it is as much shorter.
    let cloth = Cloth { start: Vec::new(), rest: vec![[0.0; 3]; 4], n: 2, pins: Vec::new() };
    let stiffness = 4.0;
    let period = TAU / (stiffness / (0.5 * cloth.particle_mass())).sqrt();
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 0.5 * period / 40.0;
    world.integration_parameters.num_solver_iterations = 32;
    let mut body = SoftBodyBuilder::new(vec![Vector::ZERO, Vector::X])
        .particle_mass(cloth.particle_mass())
        .edges(vec![[0, 1]])
        .material(SoftBodyMaterial { edge_softness: spring(stiffness, &cloth), ..SoftBodyMaterial::default() })
        .can_sleep(false);
    body.collider_template = None;
    let pair = world.insert_soft_body(body);
    world.soft_bodies.get_mut(pair).expect("it is there").set_particle_position(1, Vector::X * 1.1);
    (0..40).for_each(|_| world.step());
    let [a, b] = [0, 1].map(|i| world.soft_bodies[pair].particle_position(i));
    assert!((a.distance(b) - 0.9).abs() < 0.02, "{}", a.distance(b));
}
