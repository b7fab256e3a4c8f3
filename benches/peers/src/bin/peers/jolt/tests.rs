use super::*;

const PLAIN: Variant = VARIANTS[0].1;
const ATTACHED: Variant = VARIANTS[1].1;
const SHUFFLED: Variant = VARIANTS[2].1;

fn after_half_a_second(mut jolt: Jolt) -> Vec<[f32; 3]> {
    for _ in 0..30 {
        jolt.step();
    }
    jolt.positions()
}

#[test]
fn its_edges_are_the_springs() {
    let cloth = Cloth::hanging(7);
    let shared = shared(&cloth, &numbering(&cloth, false), ATTACHMENTS, SCALE);
    let diagonals = 2 * 6 * 6;
    assert_eq!(shared.edge_constraint_count(), cloth.pairs(1).count() + cloth.pairs(2).count() + diagonals);
    assert_eq!(shared.lra_constraint_count(), 7 * 7 - 2);
}

#[test]
fn free_cloth_falls_as_a_stone() {
    let positions = after_half_a_second(Jolt::new(&Cloth::free(8), 10, PLAIN, SCALE));
    let fall = -0.5 * GRAVITY * 0.5 * (0.5 + FRAME / 10.0);
    assert!((measure::mean_height(&positions) - fall).abs() < 1e-3);
}

#[test]
fn the_scale_changes_no_bit() {
    // Few enough particles to weigh more than 1 g as they are.
    let cloth = Cloth::hanging(12);
    let [as_it_is, scaled] = [1.0, SCALE].map(|scale| after_half_a_second(Jolt::new(&cloth, 10, ATTACHED, scale)));
    assert_eq!(as_it_is, scaled);
}

#[test]
fn shuffled_particles_come_back_in_order() {
    let cloth = Cloth::hanging(9);
    let jolt = Jolt::new(&cloth, 10, SHUFFLED, SCALE);
    assert_ne!(jolt.vertex_of, numbering(&cloth, false));
    assert_eq!(jolt.positions(), cloth.start);
}
