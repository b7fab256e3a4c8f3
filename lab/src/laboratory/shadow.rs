//! The shadow of a cloth in light from straight above.

use bevy::math::{DVec2, Vec3A};

/// Side of a pixel, m.
const PIXEL: f64 = 0.000_5;

/// Area that the triangles hide from above, m²: the pixels whose middle is under any of them.
pub fn area(positions: &[Vec3A], triangles: &[[u32; 3]]) -> f64 {
    let flat: Vec<DVec2> = positions.iter().map(|p| DVec2::new(p.x.into(), p.z.into()) / PIXEL).collect();
    let low = flat.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)).floor();
    let high = flat.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p)).ceil();
    let columns = (high.x - low.x) as usize + 1;
    let mut hidden = vec![false; columns * ((high.y - low.y) as usize + 1)];
    for triangle in triangles {
        let corners = triangle.map(|i| flat[i as usize] - low);
        for row in rows(corners) {
            if let Some((from, to)) = cut(corners, row as f64 + 0.5) {
                // Pixels from `from` on whose middle is before `to`.
                let [from, to] = [from, to].map(|x| (x - 0.5).ceil().max(0.0) as usize);
                hidden[row * columns..][from..to].fill(true);
            }
        }
    }
    hidden.into_iter().filter(|hidden| *hidden).count() as f64 * PIXEL * PIXEL
}

/// The rows of pixels that a triangle may be in.
fn rows(corners: [DVec2; 3]) -> core::ops::Range<usize> {
    let heights = corners.map(|p| p.y);
    let [low, high] = [heights.into_iter().fold(f64::MAX, f64::min), heights.into_iter().fold(0.0, f64::max)];
    low.floor() as usize..high.ceil() as usize
}

/// From where to where a triangle is at a height, if it is there.
fn cut(corners: [DVec2; 3], height: f64) -> Option<(f64, f64)> {
    let sides = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3]));
    let crossed = sides.into_iter().filter(|(p, q)| (p.y <= height) != (q.y <= height));
    let crossings = crossed.map(|(p, q)| p.x + (q.x - p.x) * (height - p.y) / (q.y - p.y));
    crossings.fold(None, |range, x| match range {
        None => Some((x, x)),
        Some((low, high)) => Some((x.min(low), x.max(high))),
    })
}
