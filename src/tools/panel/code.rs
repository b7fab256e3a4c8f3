//! Settings as Rust code, to be pasted into a game.

use bevy::{
    prelude::*,
    reflect::{
        PartialReflect, ReflectRef, TypePath,
        enums::{Enum, VariantType},
        structs::Struct,
    },
};

use super::fields::differing;

/// Lines longer than this are broken.
const LONGEST: usize = 100;

/// The expression that makes a component: the fields that differ from the default, and the default.
pub(super) fn component<T: Struct + TypePath + Default>(value: &T) -> String {
    let default = T::default();
    let field = |i| Some(format!("{}: {}", value.name_at(i)?, literal(value.field_at(i)?)));
    let mut parts: Vec<String> = differing(value, &default).filter_map(field).collect();
    let name = T::short_type_path();
    if parts.is_empty() {
        return format!("{name}::default()");
    }
    if parts.len() < value.field_len() {
        parts.push("..default()".into());
    }
    let line = format!("{name} {{ {} }}", parts.join(", "));
    if line.len() <= LONGEST { line } else { format!("{name} {{\n    {}\n}}", parts.join(",\n    ")) }
}

/// A value as it is written in Rust. A number reads back to the same bits.
fn literal(value: &dyn PartialReflect) -> String {
    if let Some(&number) = value.try_downcast_ref::<f32>() {
        return float(number);
    }
    if let Some(v) = value.try_downcast_ref::<Vec3>() {
        return format!("Vec3::new({}, {}, {})", float(v.x), float(v.y), float(v.z));
    }
    match value.reflect_ref() {
        ReflectRef::Enum(value) => variant(value),
        ReflectRef::Struct(value) => format!("{} {{ {} }}", value.reflect_short_type_path(), named(value)),
        ReflectRef::List(value) => {
            format!("vec![{}]", value.iter().map(literal).collect::<Vec<_>>().join(", "))
        }
        // Whole numbers and switches.
        _ => format!("{value:?}"),
    }
}

fn float(number: f32) -> String {
    if number.is_nan() {
        "f32::NAN".into()
    } else if number.is_infinite() {
        if number > 0.0 { "f32::INFINITY".into() } else { "f32::NEG_INFINITY".into() }
    } else {
        format!("{number:?}")
    }
}

fn named(value: &dyn Struct) -> String {
    let field = |i| Some(format!("{}: {}", value.name_at(i)?, literal(value.field_at(i)?)));
    (0..value.field_len()).filter_map(field).collect::<Vec<_>>().join(", ")
}

fn variant(value: &dyn Enum) -> String {
    let name = value.variant_name();
    let path = value.reflect_short_type_path();
    // The variants of an option are in every prelude.
    let name = if path.starts_with("Option<") { name.to_owned() } else { format!("{path}::{name}") };
    let fields = (0..value.field_len()).filter_map(|i| value.field_at(i));
    match value.variant_type() {
        VariantType::Unit => name,
        VariantType::Tuple => format!("{name}({})", fields.map(literal).collect::<Vec<_>>().join(", ")),
        VariantType::Struct => {
            let names = (0..value.field_len()).filter_map(|i| value.name_at(i));
            let fields: Vec<String> =
                names.zip(fields).map(|(name, field)| format!("{name}: {}", literal(field))).collect();
            format!("{name} {{ {} }}", fields.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;

    /// An expression, and its text as it stands here.
    macro_rules! written {
        ($code:expr) => {
            ($code, stringify!($code))
        };
    }

    #[track_caller]
    fn assert_written<T: Struct + TypePath + Default>((value, text): (T, &str)) {
        let plain = |text: &str| text.split_whitespace().collect::<String>().replace(",}", "}");
        assert_eq!(plain(&component(&value)), plain(text));
    }

    #[test]
    fn components_are_written_as_they_are_in_rust() {
        assert_written(written!(Cloth { substeps: Some(12), ..default() }));
        assert_written(written!(Cloth {
            solver: ClothSolver::Explicit,
            gravity_scale: -0.5,
            tether_slack: None,
            collision_mask: 6,
            ..default()
        }));
        assert_written(written!(Cloth { tether_slack: Some(0.01), ..default() }));
        assert_written(written!(Fabric { density: 0.25, lift: 1e-10, ..default() }));
        assert_written(written!(Fabric::default()));
        assert_written(written!(Wind {
            velocity: Vec3::new(4.0, 0.0, -1.5),
            region: WindShape::Sphere(Sphere { radius: 2.0 }),
            seed: 7,
            ..default()
        }));
        assert_written(written!(Wind {
            region: WindShape::Cuboid(Cuboid { half_size: Vec3::new(1.0, 2.0, 3.0) }),
            ..default()
        }));
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        for number in [0.1_f32, 1.0 / 3.0, 5000.0, 1e30, f32::MIN_POSITIVE, -0.0, 16_777_217.0, 9.81] {
            assert_eq!(float(number).parse::<f32>().map(f32::to_bits), Ok(number.to_bits()));
            assert!(float(number).contains(['.', 'e']), "a whole number would be no float");
        }
        assert_eq!(float(f32::NAN), "f32::NAN");
        assert_eq!(float(f32::NEG_INFINITY), "f32::NEG_INFINITY");
    }

    #[test]
    fn what_has_no_default_left_doesnt_ask_for_it() {
        let mut fabric = Fabric::default();
        for i in 0..fabric.field_len() {
            if let Some(field) = fabric.field_at_mut(i) {
                field.apply(&0.75_f32);
            }
        }
        assert!(!component(&fabric).contains("default()"));
        assert!(component(&fabric).lines().all(|line| line.len() <= LONGEST), "a long text is broken");
    }
}
