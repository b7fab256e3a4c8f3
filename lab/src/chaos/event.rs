//! What happens in the midst of a scene.

use super::stage::Stage;

mod hands;
mod life;
mod settings;
mod surroundings;

type Event = fn(&mut Stage);

const EVENTS: [Event; 30] = [
    settings::cloth,
    settings::cloth,
    settings::fabric,
    settings::fabric,
    settings::springs,
    settings::pins,
    settings::more_pins,
    settings::fewer_pins,
    hands::grab,
    hands::grab,
    hands::lead,
    hands::lead,
    hands::release,
    hands::push,
    hands::strike,
    life::reset,
    life::teleport,
    life::displace,
    life::scale,
    life::disable,
    life::remesh,
    life::reshape,
    life::adopt,
    life::end_or_begin,
    surroundings::obstacle,
    surroundings::obstacle,
    surroundings::displace,
    surroundings::disable,
    surroundings::wind,
    surroundings::gravity,
];

/// Lets something happen.
pub fn happen(stage: &mut Stage) {
    stage.dice.one_of(EVENTS)(stage);
}
