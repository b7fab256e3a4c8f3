//! The parts of bodies among the obstacles, body by body: most cloths pass over most bodies at once.

use core::ops::Range;

use bevy::{math::Vec3A, prelude::*};

use super::ClothBodyPart;
use crate::solver::Obstacle;

/// Which obstacles are parts of which bodies.
#[derive(Debug, Default)]
pub(crate) struct BodyGroups {
    /// Bodies, and the numbers of their parts, in that order.
    parts: Vec<(Entity, usize)>,
    groups: Vec<BodyGroup>,
    /// Numbers of obstacles that are part of none.
    others: Vec<usize>,
    /// How many obstacles there were. More have come from physics engines since, and are part of none.
    known: usize,
}

/// The parts of a body.
#[derive(Clone, Debug)]
pub(crate) struct BodyGroup {
    pub body: Entity,
    /// Corners of a box around them and their way, in the world, m.
    pub bounds: [Vec3A; 2],
    /// Which of all parts they are.
    parts: Range<usize>,
}

impl BodyGroups {
    /// Finds the parts of all bodies among some obstacles.
    pub fn group<'a>(&mut self, list: &[(Entity, u32, Obstacle)], part: impl Fn(Entity) -> Option<&'a ClothBodyPart>) {
        self.parts.clear();
        self.groups.clear();
        self.others.clear();
        self.known = list.len();
        for (number, &(entity, ..)) in list.iter().enumerate() {
            match part(entity) {
                Some(part) => self.parts.push((part.body, number)),
                None => self.others.push(number),
            }
        }
        self.parts.sort_unstable();
        let mut end = 0;
        for parts in self.parts.chunk_by(|(one, _), (other, _)| one == other) {
            let boxes = parts.iter().map(|&(_, number)| list[number].2.bounds());
            let around = |[low, high]: [Vec3A; 2], [from, to]: [Vec3A; 2]| [low.min(from), high.max(to)];
            let bounds = boxes.reduce(around).unwrap_or_default();
            let start = end;
            end += parts.len();
            self.groups.push(BodyGroup { body: parts[0].0, bounds, parts: start..end });
        }
    }

    /// Numbers of obstacles, of `count` that there are by now: those that are part of no body, then those of bodies that are
    /// `selected`.
    pub fn numbers(&self, count: usize, selected: impl Fn(&BodyGroup) -> bool) -> impl Iterator<Item = usize> {
        let others = self.others.iter().copied().chain(self.known..count);
        let groups = self.groups.iter().filter(move |group| selected(group));
        others.chain(groups.flat_map(|group| self.parts[group.parts.clone()].iter().map(|&(_, number)| number)))
    }

    /// The world has been shifted, and all of them with it.
    pub fn shift(&mut self, by: Vec3) {
        let corners = self.groups.iter_mut().flat_map(|group| &mut group.bounds);
        corners.for_each(|corner| *corner += Vec3A::from(by));
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Isometry3d;

    use super::*;
    use crate::solver::Solid;

    fn entity(number: u32) -> Entity {
        Entity::from_raw_u32(number).unwrap()
    }

    #[test]
    fn parts_come_body_by_body_after_what_is_no_part() {
        let ball = |number: u32| {
            let place = Isometry3d::from_xyz(number as f32, 0.0, 0.0);
            (entity(number), 1, Obstacle::still(Solid::Sphere(Sphere::new(0.5)), place))
        };
        let list: Vec<_> = (1..=5).map(ball).collect();
        let [one, other] = [20, 10].map(|number| ClothBodyPart { body: entity(number) });
        let part = |part: Entity| match part.index_u32() {
            1 | 4 => Some(&one),
            3 => Some(&other),
            _ => None,
        };
        let mut groups = BodyGroups::default();
        groups.group(&list, part);
        let all: Vec<usize> = groups.numbers(6, |_| true).collect();
        let first = if one.body < other.body { [0, 3, 2] } else { [2, 0, 3] };
        assert_eq!(all, [&[1, 4, 5][..], &first].concat());
        let some: Vec<usize> = groups.numbers(5, |group| group.body == one.body).collect();
        assert_eq!(some, [1, 4, 0, 3]);
        let bounds = |body| groups.groups.iter().find(|group| group.body == body).unwrap().bounds;
        assert_eq!(bounds(one.body), [Vec3A::new(0.5, -0.5, -0.5), Vec3A::new(4.5, 0.5, 0.5)]);
        groups.group(&[], part);
        assert_eq!(groups.numbers(0, |_| true).count(), 0);
    }
}
