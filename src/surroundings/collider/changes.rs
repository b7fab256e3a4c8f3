//! Which obstacles aren't what they were a step before: they wake cloth that sleeps near them.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};

use super::Obstacles;
use crate::{
    frame::{Pass, PerPass, Steps},
    solver::{CollisionFilter, Obstacle, StepReach},
    surroundings::body::ClothBodyPart,
};

/// Obstacles that have moved, changed, come or gone since the step before, of the present pass.
#[derive(Resource, Debug, Default)]
pub(crate) struct ObstacleChanges {
    /// All obstacles in the step before of each pass, in the order of their entities.
    known: PerPass<Vec<(Entity, u32, Obstacle)>>,
    /// Those that have changed with their entity and layers: as they are, and as they were.
    changed: Vec<(Entity, u32, Obstacle)>,
    /// Those of them that are parts of bodies, with these, in the order of the parts.
    parts: Vec<(Entity, Entity)>,
}

impl ObstacleChanges {
    /// Whether a cloth may `reach` one of them that `filter` selects, and that is no part of another body than its `own`, if it has
    /// one. Its places are relative to `origin`.
    pub fn are_near(
        &self,
        reach: &StepReach,
        origin: Vec3,
        filter: CollisionFilter,
        own: impl FnOnce() -> Option<Entity>,
    ) -> bool {
        if self.changed.is_empty() {
            return false;
        }
        let own = own();
        let is_met = |entity: Entity| {
            let part = self.parts.binary_search_by_key(&entity, |&(part, _)| part);
            own.is_none_or(|own| part.is_ok_and(|number| self.parts[number].1 == own) || part.is_err())
        };
        let relative = |pose: Isometry3d| Isometry3d::new(pose.translation - Vec3A::from(origin), pose.rotation);
        let met = self.changed.iter().filter(|(entity, layers, _)| filter.selects(*layers) && is_met(*entity));
        met.map(|(.., obstacle)| obstacle).any(|obstacle| {
            let ends = [relative(obstacle.start), relative(obstacle.end)];
            reach.includes(&obstacle.shape, ends.each_ref(), obstacle.rounding)
        })
    }

    /// The world has been shifted, and all of them with it.
    pub fn shift(&mut self, by: Vec3) {
        self.known.iter_mut().flatten().for_each(|(_, _, obstacle)| obstacle.shift(by.into()));
    }

    /// Compares with the obstacles of the coming step of a pass. Both come in the order of their entities, but for those of engines, which stand
    /// behind the others: where one comes or goes, some of these may be told too.
    fn follow(&mut self, pass: Pass, now: &[(Entity, u32, Obstacle)]) {
        self.changed.clear();
        let known = &mut self.known[pass];
        let (mut old, mut new) = (known.iter().peekable(), now.iter().peekable());
        loop {
            // Whether the next one was there in the step before, and is still.
            let (was, is) = match (old.peek(), new.peek()) {
                (None, None) => break,
                (Some(_), None) => (true, false),
                (None, Some(_)) => (false, true),
                (Some((one, ..)), Some((other, ..))) => (one <= other, one >= other),
            };
            let (before, now) = (old.next_if(|_| was), new.next_if(|_| is));
            let is_same = before.zip(now).is_some_and(|((_, old_layers, before), (_, layers, now))| {
                old_layers == layers && now.is_still() && now.ends_like(before)
            });
            if !is_same {
                let either = before.into_iter().chain(now);
                self.changed.extend(either.cloned());
            }
        }
        if !self.changed.is_empty() {
            known.clear();
            known.extend_from_slice(now);
        }
    }
}

/// Drops the obstacles that have changed once cloth has been stepped: they share points with skinned meshes, which are written anew
/// before the next step.
pub(crate) fn forget_changes(mut changes: ResMut<ObstacleChanges>) {
    changes.changed.clear();
    changes.parts.clear();
}

/// Finds which obstacles have changed since the step before, in a step in which time goes on.
pub(crate) fn find_changes(
    obstacles: Res<Obstacles>,
    mut changes: ResMut<ObstacleChanges>,
    parts: Query<&ClothBodyPart>,
    (time, steps): (Res<Time>, Res<Steps>),
) {
    if time.delta_secs() > 0.0 {
        changes.follow(steps.pass(), &obstacles.list);
        let ObstacleChanges { changed, parts: known, .. } = &mut *changes;
        known.extend(changed.iter().filter_map(|&(entity, ..)| Some((entity, parts.get(entity).ok()?.body))));
        known.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Solid;

    fn ball(number: u32, x: f32) -> (Entity, u32, Obstacle) {
        let entity = Entity::from_raw_u32(number).unwrap();
        (entity, 1, Obstacle::still(Solid::Sphere(Sphere::new(0.1)), Isometry3d::from_xyz(x, 0.0, 0.0)))
    }

    fn places(changes: &mut ObstacleChanges, now: &[(Entity, u32, Obstacle)]) -> Vec<f32> {
        let mut now = now.to_vec();
        now.sort_unstable_by_key(|&(entity, ..)| entity);
        changes.follow(Pass::Fixed, &now);
        let mut places: Vec<f32> = changes.changed.iter().map(|(.., obstacle)| obstacle.end.translation.x).collect();
        places.sort_unstable_by(f32::total_cmp);
        places
    }

    #[test]
    fn what_moves_changes_comes_or_goes_is_told_once_as_it_was_and_is() {
        let mut changes = ObstacleChanges::default();
        let three = [ball(1, 1.0), ball(2, 2.0), ball(3, 3.0)];
        assert_eq!(places(&mut changes, &three), [1.0, 2.0, 3.0], "they come");
        assert_eq!(places(&mut changes, &three), [0.0; 0], "and stay");
        assert_eq!(places(&mut changes, &[ball(1, 1.0), ball(3, 3.0)]), [2.0], "one goes");
        assert_eq!(places(&mut changes, &[ball(1, 1.5), ball(3, 3.0)]), [1.0, 1.5], "one is put elsewhere");
        let mut moving = [ball(1, 1.5), ball(3, 4.0)];
        moving[1].2.start.translation.x = 3.0;
        assert_eq!(places(&mut changes, &moving), [3.0, 4.0], "one moves");
        assert_eq!(places(&mut changes, &[ball(1, 1.5), ball(3, 4.0)]), [0.0; 0], "and has come to rest");
        let mut other = [ball(1, 1.5), ball(3, 4.0)];
        other[0].1 = 2;
        other[1].2.friction = 0.0;
        assert_eq!(places(&mut changes, &other), [1.5, 1.5, 4.0, 4.0], "layers and friction count");
    }
}
