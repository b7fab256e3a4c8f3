//! What is known of each number of a component besides its value. It stands above the field, and what the number means in
//! the field's documentation: checks, panel and inspectors take theirs from there.

use bevy::{
    prelude::*,
    reflect::{PartialReflect, ReflectRef, Typed, enums::VariantInfo, structs::Struct},
};

use crate::error::ClothError;

/// The smallest number above zero.
const ABOVE_ZERO: f32 = f32::from_bits(1);

/// A number of a component: its unit, what it may be, and how it is shown and turned. A reflected attribute of its field, or of the
/// field of an enum's variant:
///
/// ```ignore
/// /// Areal density in kg/m².
/// #[reflect(@Parameter::positive("kg/m²", (0.02, 2.0)).logarithmic(0.02).entered((1e-3, 1e3)))]
/// pub density: f32,
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub(crate) struct Parameter {
    /// SI, empty for none.
    pub unit: &'static str,
    /// Smallest and largest value that a component may have.
    pub accepted: (f32, f32),
    /// The same of what a person may enter: what the solver can still work well with.
    pub entered: (f32, f32),
    /// The ends of a slider: the sensible range.
    pub slider: (f32, f32),
    pub scale: Scale,
    /// The unit that it is shown and entered in, and how many of those are one of its own: mm, and 1000, where it is in m.
    pub shown: (&'static str, f64),
    /// What it is called where its field's name wouldn't do.
    pub title: Option<&'static str>,
}

/// How values lie on a slider.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub(crate) enum Scale {
    Linear,
    /// With the smallest value besides zero.
    Logarithmic(f32),
    /// Linear, whole numbers only.
    Whole,
}

impl Parameter {
    /// From the first to the second of `accepted`.
    pub const fn within(unit: &'static str, accepted: (f32, f32), slider: (f32, f32)) -> Self {
        let scale = Scale::Linear;
        Self { unit, accepted, entered: accepted, slider, scale, shown: (unit, 1.0), title: None }
    }

    /// Any finite number.
    pub const fn finite(unit: &'static str, slider: (f32, f32)) -> Self {
        Self::within(unit, (f32::MIN, f32::MAX), slider)
    }

    /// Zero or greater.
    pub const fn not_negative(unit: &'static str, slider: (f32, f32)) -> Self {
        Self::within(unit, (0.0, f32::MAX), slider)
    }

    /// Greater than zero.
    pub const fn positive(unit: &'static str, slider: (f32, f32)) -> Self {
        Self::within(unit, (ABOVE_ZERO, f32::MAX), slider)
    }

    /// A person may enter less than is accepted.
    pub const fn entered(self, entered: (f32, f32)) -> Self {
        Self { entered, ..self }
    }

    /// A slider over orders of magnitude, with the smallest value besides zero.
    pub const fn logarithmic(self, smallest: f32) -> Self {
        Self { scale: Scale::Logarithmic(smallest), ..self }
    }

    /// Whole numbers only.
    pub const fn whole(self) -> Self {
        Self { scale: Scale::Whole, ..self }
    }

    /// Shown in a unit of which so many are one of its own.
    pub const fn shown_as(self, unit: &'static str, factor: f64) -> Self {
        Self { shown: (unit, factor), ..self }
    }

    /// Called otherwise than its field.
    pub const fn titled(self, title: &'static str) -> Self {
        Self { title: Some(title), ..self }
    }

    /// An error for a value with a number that isn't accepted.
    fn check(&self, value: &dyn PartialReflect, name: impl FnOnce() -> String) -> Result<(), ClothError> {
        match self.refused(value) {
            None => Ok(()),
            Some(number) => Err(ClothError::InvalidParameter { name: name(), value: number, rule: self.rule(value) }),
        }
    }

    /// The first number of a field's value that isn't accepted.
    fn refused(&self, value: &dyn PartialReflect) -> Option<f32> {
        let is_refused = |number: &f32| !(self.accepted.0..=self.accepted.1).contains(number);
        match value.try_downcast_ref::<Vec3>() {
            Some(vector) => vector.to_array().into_iter().find(is_refused),
            None => number(value).filter(is_refused),
        }
    }

    /// What the numbers of a field have to be, in words.
    fn rule(&self, value: &dyn PartialReflect) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let rule = match self.accepted {
            (f32::MIN, f32::MAX) => "finite".into(),
            (ABOVE_ZERO, f32::MAX) => format!("greater than 0{unit}"),
            (least, f32::MAX | f32::INFINITY) => format!("{least}{unit} or greater"),
            (least, most) => format!("{least} to {most}{unit}"),
        };
        let is_option = matches!(value.reflect_ref(), ReflectRef::Enum(_));
        if is_option { rule + ", or `None`" } else { rule }
    }
}

/// The number that a field is: none for `None`.
pub(crate) fn number(value: &dyn PartialReflect) -> Option<f32> {
    let count = || value.try_downcast_ref::<u32>().copied();
    let optional = || *value.try_downcast_ref::<Option<f32>>()?;
    let optional_count = || *value.try_downcast_ref::<Option<u32>>()?;
    let count = || count().or_else(optional_count).map(|count| count as f32);
    value.try_downcast_ref::<f32>().copied().or_else(optional).or_else(count)
}

/// Returns an error for the first of the fields that `is_checked` with a number that isn't accepted.
pub(crate) fn check_parameters<C: Struct + Typed>(
    component: &C,
    is_checked: impl Fn(&str) -> bool,
) -> Result<(), ClothError> {
    let fields = C::type_info().as_struct().into_iter().flat_map(|info| info.iter().enumerate());
    for (i, field) in fields.filter(|(_, field)| is_checked(field.name())) {
        let Some(value) = component.field_at(i) else { continue };
        let name = || format!("{}::{}", C::short_type_path(), field.name());
        match field.get_attribute::<Parameter>() {
            Some(parameter) => parameter.check(value, name)?,
            None => check_variant(value, name)?,
        }
    }
    Ok(())
}

/// The same for the fields of the variant that `value` is, if it is one.
fn check_variant(value: &dyn PartialReflect, name: impl Fn() -> String) -> Result<(), ClothError> {
    let ReflectRef::Enum(chosen) = value.reflect_ref() else { return Ok(()) };
    let info = value.get_represented_type_info().and_then(|info| info.as_enum().ok()?.variant(chosen.variant_name()));
    for (i, value) in (0..chosen.field_len()).filter_map(|i| Some((i, chosen.field_at(i)?))) {
        match info {
            Some(VariantInfo::Struct(info)) => {
                let Some(field) = info.field_at(i) else { continue };
                let name = || format!("{}, {}", name(), field.name());
                field.get_attribute::<Parameter>().map_or(Ok(()), |parameter| parameter.check(value, name))?;
            }
            Some(VariantInfo::Tuple(info)) => {
                let parameter = info.field_at(i).and_then(|field| field.get_attribute::<Parameter>());
                parameter.map_or(Ok(()), |parameter| parameter.check(value, &name))?;
            }
            Some(VariantInfo::Unit(_)) | None => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Reflect, Default)]
    struct Sample {
        #[reflect(@Parameter::positive("m", (0.1, 1.0)))]
        length: f32,
        #[reflect(@Parameter::not_negative("", (0.0, 1.0)))]
        slack: Option<f32>,
        #[reflect(@Parameter::within("", (1.0, 9.0), (1.0, 9.0)).whole())]
        count: Option<u32>,
        #[reflect(@Parameter::finite("m/s", (0.0, 1.0)))]
        velocity: Vec3,
        shape: Shape,
        free: f32,
    }

    #[derive(Reflect, Default)]
    enum Shape {
        #[default]
        Point,
        Ball(#[reflect(@Parameter::positive("m", (0.1, 1.0)))] f32),
        Ring {
            radius: f32,
            #[reflect(@Parameter::within("m", (0.0, f32::INFINITY), (0.0, 1.0)))]
            width: f32,
        },
    }

    const GOOD: Sample =
        Sample { length: 1.0, slack: None, count: None, velocity: Vec3::ZERO, shape: Shape::Point, free: f32::NAN };

    fn refusal(sample: &Sample) -> String {
        check_parameters(sample, |_| true).map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[test]
    fn what_is_accepted_passes() {
        for sample in [
            GOOD,
            Sample { length: f32::from_bits(1), slack: Some(0.0), count: Some(1), ..GOOD },
            Sample { length: f32::MAX, slack: Some(f32::MAX), count: Some(9), velocity: Vec3::MIN, ..GOOD },
            Sample { shape: Shape::Ball(0.1), ..GOOD },
            Sample { shape: Shape::Ring { radius: f32::NAN, width: f32::INFINITY }, ..GOOD },
        ] {
            assert_eq!(refusal(&sample), "");
        }
    }

    #[test]
    fn what_is_refused_is_named_with_its_rule() {
        for (sample, expected) in [
            (Sample { length: 0.0, ..GOOD }, "Sample::length is 0, and it has to be greater than 0 m;"),
            (Sample { length: f32::INFINITY, ..GOOD }, "Sample::length is inf, and"),
            (
                Sample { slack: Some(f32::NAN), ..GOOD },
                "Sample::slack is NaN, and it has to be 0 or greater, or `None`;",
            ),
            (Sample { count: Some(10), ..GOOD }, "Sample::count is 10, and it has to be 1 to 9, or `None`;"),
            (Sample { count: Some(u32::MAX), ..GOOD }, "Sample::count is 42949"),
            (
                Sample { velocity: Vec3::new(0.0, -f32::INFINITY, 1.0), ..GOOD },
                "Sample::velocity is -inf, and it has to be finite;",
            ),
            (Sample { shape: Shape::Ball(0.0), ..GOOD }, "Sample::shape is 0, and it has to be greater than 0 m;"),
            (
                Sample { shape: Shape::Ring { radius: 1.0, width: f32::NAN }, ..GOOD },
                "Sample::shape, width is NaN, and it has to be 0 m or greater;",
            ),
        ] {
            assert!(refusal(&sample).starts_with(expected), "{}", refusal(&sample));
        }
        let sample = Sample { length: -1.0, slack: Some(-2.0), ..GOOD };
        assert!(check_parameters(&sample, |field| field == "velocity").is_ok());
    }
}
