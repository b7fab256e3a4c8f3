//! Settings field by field: an edit writes what was edited and nothing else.

use bevy::{
    ecs::component::Mutable,
    prelude::*,
    reflect::{PartialReflect, ReflectRef, structs::Struct},
};

/// Whether two fields have the same value. NaN is the same as NaN: nobody has edited that.
pub(super) fn same(a: &dyn PartialReflect, b: &dyn PartialReflect) -> bool {
    let is_nan = |value: &dyn PartialReflect| value.try_downcast_ref::<f32>().is_some_and(|value| value.is_nan());
    let both_same = |pair: (Option<_>, Option<_>)| match pair {
        (Some(a), Some(b)) => same(a, b),
        _ => false,
    };
    a.reflect_partial_eq(b) == Some(true)
        || is_nan(a) && is_nan(b)
        || match (a.reflect_ref(), b.reflect_ref()) {
            (ReflectRef::Enum(a), ReflectRef::Enum(b)) => {
                a.variant_name() == b.variant_name()
                    && (0..a.field_len()).all(|i| both_same((a.field_at(i), b.field_at(i))))
            }
            (ReflectRef::Struct(a), ReflectRef::Struct(b)) => {
                (0..a.field_len()).all(|i| both_same((a.field_at(i), b.field_at(i))))
            }
            _ => false,
        }
}

/// Indices of the fields that differ.
pub(super) fn differing<T: Struct>(a: &T, b: &T) -> impl Iterator<Item = usize> {
    (0..a.field_len()).filter(|&i| match (a.field_at(i), b.field_at(i)) {
        (Some(a), Some(b)) => !same(a, b),
        _ => false,
    })
}

/// Writes the fields in which `after` differs from `before` into an entity's component. True where that changed it.
pub(super) fn write<T>(world: &mut World, entity: Entity, before: &T, after: &T) -> bool
where
    T: Component<Mutability = Mutable> + Struct + Clone,
{
    write_good(world, entity, before, after, |_| true)
}

/// The same, unless that made one that `is_good` bad.
pub(super) fn write_good<T>(
    world: &mut World,
    entity: Entity,
    before: &T,
    after: &T,
    is_good: impl Fn(&T) -> bool,
) -> bool
where
    T: Component<Mutability = Mutable> + Struct + Clone,
{
    let Some(mut component) = world.get_mut::<T>(entity) else { return false };
    let mut edited = component.clone();
    let mut is_changed = false;
    for i in differing(before, after) {
        let (Some(new), Some(old)) = (after.field_at(i), component.field_at(i)) else { continue };
        if !same(new, old)
            && let Some(field) = edited.field_at_mut(i)
        {
            // Not applied: that would merge lists, and never shorten one.
            let new = new.reflect_clone().ok().zip(field.try_as_reflect_mut());
            is_changed |= new.is_some_and(|(new, field)| field.set(new).is_ok());
        }
    }
    let is_written = is_changed && (is_good(&edited) || !is_good(&component));
    if is_written {
        *component = edited;
    }
    is_written
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;

    #[test]
    fn only_what_was_edited_is_written() {
        let mut world = World::new();
        let other = Fabric { density: 0.5, friction: 0.9, ..default() };
        let entity = world.spawn(other.clone()).id();
        let before = Fabric::default();
        let after = Fabric { friction: 0.1, ..before.clone() };
        assert!(write(&mut world, entity, &before, &after));
        assert_eq!(world.get(entity), Some(&Fabric { friction: 0.1, ..other }));
    }

    #[test]
    fn what_is_there_already_is_no_change() {
        let mut world = World::new();
        let entity = world.spawn(Cloth { tether_slack: None, ..default() }).id();
        world.clear_trackers();
        let (before, after) = (Cloth::default(), Cloth { tether_slack: None, ..default() });
        assert!(!write(&mut world, entity, &before, &after));
        assert!(!world.entity(entity).get_ref::<Cloth>().is_some_and(|cloth| cloth.is_changed()));
    }

    #[test]
    fn an_edit_that_makes_a_bad_value_of_a_good_one_isnt_written() {
        let mut world = World::new();
        let is_light = |fabric: &Fabric| fabric.density < 1.0;
        let (before, after) = (Fabric::default(), Fabric { density: 2.0, ..default() });
        let light = world.spawn(Fabric { friction: 0.9, ..default() }).id();
        assert!(!write_good(&mut world, light, &before, &after, is_light));
        assert_eq!(world.get(light), Some(&Fabric { friction: 0.9, ..default() }));
        let heavy = world.spawn(Fabric { density: 3.0, ..default() }).id();
        assert!(write_good(&mut world, heavy, &before, &after, is_light), "what is bad may be edited");
    }

    #[test]
    fn a_nan_that_nobody_has_edited_is_left_alone() {
        let nan = Fabric { lift: f32::NAN, ..default() };
        assert_eq!(differing(&nan, &nan.clone()).count(), 0);
        assert_eq!(differing(&nan, &Fabric::default()).collect::<Vec<_>>(), [14]);
        let skin = |distance| ClothSkin {
            max_distance: ClothMap::Painted { scale: distance, missing: 1.0 },
            backstop: Some(f32::NAN),
            ..default()
        };
        assert_eq!(differing(&skin(f32::NAN), &skin(f32::NAN)).count(), 0);
        assert_eq!(differing(&skin(f32::NAN), &skin(1.0)).collect::<Vec<_>>(), [0]);
        let wind = |y| Wind { velocity: Vec3::new(f32::NAN, y, 0.0), ..default() };
        assert_eq!((differing(&wind(1.0), &wind(1.0)).count(), differing(&wind(1.0), &wind(2.0)).count()), (0, 1));
    }
}
