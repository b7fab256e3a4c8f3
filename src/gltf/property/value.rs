//! What a property may be: reads a value, or says what it has to be.

use serde_json::Value;

use super::{WhatCloth, WhatCollider};
use crate::{
    fabric::Fabric,
    gltf::report::nearest,
    pins::{ClothEdge, PinSelector},
};

fn number(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32).filter(|number| number.is_finite())
}

/// A length in m.
pub(super) fn length(value: &Value) -> Result<f32, String> {
    number(value).filter(|&length| length >= 0.0).ok_or("a number of m, 0 or more".into())
}

/// A radius in m.
pub(super) fn radius(value: &Value) -> Result<f32, String> {
    number(value).filter(|&radius| radius > 0.0).ok_or("a number of m, greater than 0".into())
}

/// A frequency in Hz.
pub(super) fn frequency(value: &Value) -> Result<f32, String> {
    number(value).filter(|&frequency| frequency >= 0.0).ok_or("a number of Hz, 0 or more".into())
}

/// A speed in m/s.
pub(super) fn speed(value: &Value) -> Result<f32, String> {
    number(value).ok_or("a speed in m/s, along the object's own upward axis".into())
}

/// Yes or no, which older exporters write as 1 and 0.
pub(super) fn switch(value: &Value) -> Result<bool, String> {
    match value.as_f64() {
        Some(1.0) => Ok(true),
        Some(0.0) => Ok(false),
        _ => value.as_bool().ok_or("true or false".into()),
    }
}

/// Layers, one a bit.
pub(super) fn bits(value: &Value) -> Result<u32, String> {
    let whole = value.as_f64().filter(|number| number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(number));
    whole.map(|number| number as u32).ok_or("a whole number from 0 to 4294967295, one layer a bit".into())
}

/// A name.
pub(super) fn name(value: &Value) -> Result<String, String> {
    value.as_str().map(Into::into).ok_or("the name of an object".into())
}

/// Whether it is cloth, and of what.
pub(super) fn what_cloth(value: &Value) -> Result<WhatCloth, String> {
    let presets = || Fabric::PRESETS.map(|preset| preset.name);
    let rule = || format!("true, false, one of {}, or a file that ends in .fabric.ron", presets().join(", "));
    let Some(text) = value.as_str() else {
        return switch(value).map(|is| if is { WhatCloth::Yes } else { WhatCloth::No }).map_err(|_| rule());
    };
    if text.ends_with(".fabric.ron") {
        return Ok(WhatCloth::File(text.into()));
    }
    let name = text.to_lowercase().replace([' ', '-'], "_");
    match Fabric::PRESETS.into_iter().find(|preset| preset.name == name) {
        Some(preset) => Ok(WhatCloth::Preset(Box::new(preset.fabric))),
        None => Err(nearest(&name, presets()).map_or_else(rule, |guess| format!("{}; did you mean {guess}?", rule()))),
    }
}

/// What an obstacle is like.
pub(super) fn what_collider(value: &Value) -> Result<WhatCollider, String> {
    match value.as_str() {
        Some("none") => Ok(WhatCollider::None),
        Some("capsule") => Ok(WhatCollider::Capsule),
        Some("box") => Ok(WhatCollider::Box),
        Some("sphere") => Ok(WhatCollider::Sphere),
        Some("hull") => Ok(WhatCollider::Hull),
        Some("mesh") => Ok(WhatCollider::Mesh),
        _ => Err("none, capsule, box, sphere, hull or mesh".into()),
    }
}

/// Which vertices are pinned.
pub(super) fn pin(value: &Value) -> Result<PinSelector, String> {
    let text = value.as_str().unwrap_or_default();
    let (edge, is_corners) = match text.strip_suffix("_corners") {
        Some(edge) => (edge, true),
        None => (text, false),
    };
    let edge = match edge {
        "corners" => return Ok(PinSelector::Corners),
        "top" => ClothEdge::Top,
        "bottom" => ClothEdge::Bottom,
        "left" => ClothEdge::Left,
        "right" => ClothEdge::Right,
        _ => return Err("corners, or top, bottom, left or right, each of which may end in _corners".into()),
    };
    Ok(if is_corners { PinSelector::EdgeCorners(edge) } else { PinSelector::Edge(edge) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_fabrics_may_be_written_as_people_do() {
        for name in ["wool_flannel", "Wool Flannel", "wool-flannel"] {
            let fabric = Box::new(Fabric::WOOL_FLANNEL);
            assert_eq!(what_cloth(&name.into()), Ok(WhatCloth::Preset(fabric)), "{name}");
        }
    }
}
