//! Which triangles make up a patch: connected, and wound alike.
//!
//! Only of a patch do normals tell whether it can touch itself. Two layers of one mesh that face the same way do touch.

use bevy_platform::collections::HashMap;

use crate::geometry::bvh::edges_of;

/// Numbers the fans of triangles around each corner, for each triangle's corners: those of triangles that share an edge, and are
/// wound alike, are one fan. Beside an edge of more than two triangles they aren't.
pub fn fans(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut at_edge: HashMap<[u32; 2], Vec<(u32, u32)>> = HashMap::new();
    for (i, triangle) in (0..).zip(triangles) {
        for (k, [p, q]) in (0..).zip(edges_of(*triangle)) {
            at_edge.entry([p.min(q), p.max(q)]).or_default().push((i, k));
        }
    }
    let mut parents: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    for (i, triangle) in (0..).zip(triangles) {
        for (k, [p, q]) in (0..).zip(edges_of(*triangle)) {
            let [(one, from), (other, to)] = at_edge[&[p.min(q), p.max(q)]][..] else { continue };
            if one != i || from != k || triangles[other as usize][to as usize] != q {
                continue;
            }
            // The other triangle has the edge the other way around.
            join(&mut parents, 3 * one + from, 3 * other + (to + 1) % 3);
            join(&mut parents, 3 * one + (from + 1) % 3, 3 * other + to);
        }
    }
    (0..triangles.len() as u32).map(|i| [0, 1, 2].map(|k| root(&mut parents, 3 * i + k))).collect()
}

/// Whether triangles with such fans are connected. `parents` is working memory for as many numbers as there are.
pub fn are_connected(fans: &[[u32; 3]], parents: &mut [u32]) -> bool {
    for &fan in fans.as_flattened() {
        parents[fan as usize] = fan;
    }
    for &[a, b, c] in fans {
        join(parents, a, b);
        join(parents, b, c);
    }
    let Some(&[first, ..]) = fans.first() else { return true };
    let first = root(parents, first);
    fans.iter().all(|&[fan, ..]| root(parents, fan) == first)
}

fn join(parents: &mut [u32], one: u32, other: u32) {
    let [one, other] = [one, other].map(|i| root(parents, i));
    parents[one.max(other) as usize] = one.min(other);
}

fn root(parents: &mut [u32], mut i: u32) -> u32 {
    while parents[i as usize] != i {
        parents[i as usize] = parents[parents[i as usize] as usize];
        i = parents[i as usize];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether triangles are one patch.
    fn are_one(triangles: &[[u32; 3]]) -> bool {
        let fans = fans(triangles);
        are_connected(&fans, &mut vec![0; fans.as_flattened().len()])
    }

    #[test]
    fn triangles_beside_an_edge_that_are_wound_alike_are_one_patch() {
        assert!(are_one(&[]) && are_one(&[[0, 1, 2]]));
        assert!(are_one(&[[0, 1, 2], [2, 1, 3]]));
        assert!(!are_one(&[[0, 1, 2], [1, 2, 3]]), "one faces the other way");
        assert!(are_one(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]), "a fan that closes");
    }

    #[test]
    fn layers_that_share_a_corner_or_a_third_triangle_are_several() {
        assert!(!are_one(&[[0, 1, 2], [3, 4, 5]]), "nothing is shared");
        assert!(!are_one(&[[0, 1, 2], [2, 3, 4]]), "a corner is");
        assert!(!are_one(&[[0, 1, 2], [2, 1, 3], [2, 1, 4]]), "three are at an edge");
    }

    #[test]
    fn a_corner_has_as_many_fans_as_layers_meet_there() {
        let [one, other, apart] = fans(&[[0, 1, 2], [0, 2, 3], [0, 4, 5]])[..] else { panic!("three triangles") };
        assert_eq!(one[0], other[0]);
        assert_ne!(one[0], apart[0]);
        assert_eq!((one[2], one[1] == other[1]), (other[1], false));
    }
}
