//! Springs and tethers: what holds particles together.

use super::{ClothDebugView, Lines, Shown, palette};
use crate::solver::{SpringKind, Tether, constraint::unstructured::spring};

/// A tether counts as taut from this share of its longest on.
const TAUT_FROM: f32 = 0.999;

/// Draws the springs of the kinds that are on, where the cloth is drawn, in the colour of their strain in the latest
/// step: far from the world's origin, only the solver's own positions tell that exactly.
pub(super) fn draw_springs(lines: &mut Lines, shown: &Shown, view: &ClothDebugView) {
    let kinds = [
        (SpringKind::Structural, view.structural_springs),
        (SpringKind::Shear, view.shear_springs),
        (SpringKind::Bend, view.bend_springs),
    ];
    let position = &shown.state.particles.position;
    for (kind, _) in kinds.into_iter().filter(|&(_, is_on)| is_on) {
        for spring in shown.state.topology.springs_of(kind) {
            let color = palette::spring(kind, spring::strain(position, spring), view.full_strain);
            lines.line(shown.places[spring.a as usize], shown.places[spring.b as usize], color);
        }
    }
}

/// Draws the tethers that the solver uses.
pub(super) fn draw_tethers(lines: &mut Lines, shown: &Shown) {
    if !shown.in_force.has_tethers() {
        return;
    }
    let slack = shown.in_force.settings.tether_slack.unwrap_or_default();
    let position = &shown.state.particles.position;
    for Tether { particle, pin, length } in shown.attachments.tethers() {
        let (particle, pin) = (particle as usize, pin as usize);
        let is_taut = position[particle].distance(position[pin]) >= TAUT_FROM * length * (1.0 + slack);
        let color = if is_taut { palette::TAUT } else { palette::SLACK };
        lines.line(shown.places[particle], shown.places[pin], color);
    }
}
