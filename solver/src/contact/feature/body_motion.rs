//! Points of obstacles on their ways, and bodies that are pushed by pairs.

use core::ops::Range;

use bevy_math::{Isometry3d, Vec3A};

use crate::{
    contact::{
        body::MovedBody,
        feature::{
            ClothInStep, FeatureContacts, SolvedPairs,
            obstacle::ObstaclePoint,
            pair::{BodyContact, Impulse},
        },
        particle::ccd,
    },
    shape::{DeformedPoints, MeshShape, Shape},
};

/// The way that a search has taken a body to be on.
#[derive(Clone, Copy, Debug)]
pub struct PredictedBodyMotion {
    /// Number of the cloth, and of the obstacle among those of that cloth.
    cloth: usize,
    obstacle: usize,
    /// When the search begins and ends.
    poses: [Isometry3d; 2],
    /// The farthest from its origin that anything of it is, m.
    far: f32,
}

impl FeatureContacts {
    /// Brings the points of obstacles to where they are in the part `span` of the step.
    pub(crate) fn lead_fixed(&mut self, cloths: &[impl ClothInStep], span: Range<f32>) {
        let count = self.start.len();
        let mut latest: Option<(u32, u32, [Isometry3d; 2])> = None;
        for k in 0..self.fixed.len() {
            let fixed = self.fixed[k];
            let cloth = &cloths[fixed.cloth as usize];
            let poses = match latest {
                Some((cloth, obstacle, poses)) if (cloth, obstacle) == (fixed.cloth, fixed.obstacle) => poses,
                _ => cloth.bodies().poses(cloth.ctx(), fixed.obstacle as usize, span.clone()),
            };
            latest = Some((fixed.cloth, fixed.obstacle, poses));
            let [from, to] = [span.start, span.end].map(|t| self.local(cloth, &fixed, t));
            self.points.previous[count + k] = poses[0].transform_point(from) + cloth.offset();
            self.points.position[count + k] = poses[1].transform_point(to) + cloth.offset();
        }
    }

    /// Keeps the ways of a cloth's bodies in what is left of a step of `dt` seconds.
    pub(crate) fn note_bodies(&mut self, number: usize, cloth: &impl ClothInStep, dt: f32) {
        let bodies = &cloth.bodies();
        for (obstacle, it) in cloth.ctx().obstacles.iter().enumerate() {
            if bodies.get(obstacle).is_none() {
                continue;
            }
            let Some((_, far)) = it.ball() else { continue };
            let poses = bodies.poses_ahead(cloth.ctx(), obstacle, self.searched.clone(), dt);
            self.body_ways.push(PredictedBodyMotion { cloth: number, obstacle, poses, far });
        }
    }

    /// Whether a body was off its way when a substep began.
    pub(crate) fn has_body_come_off(&self, cloths: &[impl ClothInStep], now: f32) -> bool {
        let share = (now - self.searched.start) / (self.searched.end - self.searched.start);
        self.body_ways.iter().any(|PredictedBodyMotion { cloth, obstacle, poses: [from, to], far }| {
            let Some(body) = cloths[*cloth].bodies().get(*obstacle) else { return false };
            let translation = from.translation.lerp(to.translation, share);
            let expected = Isometry3d { translation, rotation: from.rotation.lerp(to.rotation, share) };
            ccd::way_between(&expected, &body.start, *far) > self.obstacle_slack[*cloth]
        })
    }

    /// Where a point of an obstacle is in the obstacle's own frame, at the moment `t` of the step.
    fn local(&self, cloth: &impl ClothInStep, fixed: &ObstaclePoint, t: f32) -> Vec3A {
        let point = fixed.point as usize;
        match &cloth.ctx().obstacles[fixed.obstacle as usize].shape {
            Shape::Solid(_) => self.at_obstacle.outline(fixed).points[point],
            Shape::Mesh(MeshShape { mesh, deformed: None }) => mesh.points[point],
            Shape::Mesh(MeshShape { deformed: Some(DeformedPoints { ends: [from, to], .. }), .. }) => {
                from[point].lerp(to[point], t)
            }
        }
    }

    /// Solves all pairs, one after the other, and pushes the bodies among the obstacles.
    pub(super) fn solve_each_on_bodies(
        &mut self,
        cloths: &mut [impl ClothInStep],
        span: Range<f32>,
        most_parted: f32,
        is_first_pass: bool,
    ) -> SolvedPairs {
        let count = self.start.len();
        let mut solved = SolvedPairs::default();
        for i in 0..self.pairs.len() {
            let mut pair = self.pairs[i];
            let is_first = pair.points[0] as usize >= count;
            let on = self.body_of(cloths, &pair.points, is_first, span.end);
            let body = on.as_ref().map(TouchedBody::on);
            let touch = match is_first_pass {
                true => pair.solve(&mut self.points, most_parted, body.as_ref()),
                false => pair.solve_again(&mut self.points, most_parted, body.as_ref()),
            };
            self.pairs[i] = pair;
            if let Some(touch) = touch {
                solved.note(&pair, &touch, pair.points.iter().any(|&point| point as usize >= count));
                push(cloths, on, touch.impulse);
            }
        }
        solved
    }

    /// The body that some points are of, at the moment `t` of the step, after what has moved it: they are brought there.
    fn body_of(&mut self, cloths: &[impl ClothInStep], points: &[u32], is_first: bool, t: f32) -> Option<TouchedBody> {
        let count = self.start.len();
        let of_obstacle = points.iter().find(|&&point| point as usize >= count)?;
        let fixed = self.fixed[*of_obstacle as usize - count];
        let cloth = &cloths[fixed.cloth as usize];
        let body = *cloth.bodies().get(fixed.obstacle as usize)?;
        for point in points.iter().map(|&point| point as usize).filter(|&point| point >= count) {
            let local = self.local(cloth, &self.fixed[point - count], t);
            self.points.position[point] = body.end.transform_point(local) + cloth.offset();
        }
        Some(TouchedBody { fixed, body, centre: body.centre + cloth.offset(), is_first })
    }
}

/// A body that something touches.
struct TouchedBody {
    fixed: ObstaclePoint,
    body: MovedBody,
    /// From the origin of the points, m.
    centre: Vec3A,
    is_first: bool,
}

impl TouchedBody {
    fn on(&self) -> BodyContact<'_> {
        BodyContact { body: &self.body, centre: self.centre, is_first: self.is_first }
    }
}

/// Gives a body what something that touched it gives to it.
fn push(cloths: &mut [impl ClothInStep], on: Option<TouchedBody>, Impulse { linear, angular }: Impulse) {
    if let Some(TouchedBody { fixed, .. }) = on {
        cloths[fixed.cloth as usize].bodies_mut().push(fixed.obstacle as usize, linear, angular);
    }
}
