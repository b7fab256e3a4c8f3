//! A scene from its beginning to its end.

use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::{
    cast, clock::Clock, diary::Diary, dice::Dice, event, hook, options::Options, outcome::Outcome, stage::Stage, watch,
};

/// Runs the scene of a seed.
pub fn run(seed: u64, options: &Options) -> Outcome {
    let dice = Dice::of_seed(seed);
    let mut outcome = Outcome { seed, is_in_range: dice.is_in_range(), ..Default::default() };
    let diary = Diary::new(seed, options.verbose);
    diary.note(if outcome.is_in_range { "settings in range" } else { "settings out of range" });
    let budget = Duration::from_secs_f64(options.budget);
    let panic = hook::catch(|| play(&mut Stage::new(dice, diary), budget, &mut outcome)).err();
    if options.verbose
        && let Some(message) = &panic
    {
        eprintln!("seed {seed}, frame {}: {message}", outcome.frames);
    }
    Outcome { panic, ..outcome }
}

fn play(stage: &mut Stage, budget: Duration, outcome: &mut Outcome) {
    let begun = Instant::now();
    let clock = Clock::roll(&mut stage.dice);
    let frames = stage.dice.count(30..=90);
    let eventfulness = stage.dice.one_of([0.0, 0.05, 0.2, 0.6]);
    stage.diary.note(format_args!("{frames} frames, {clock:?}"));
    cast::enter(stage);
    for frame in 1..=frames {
        outcome.frames = frame;
        stage.diary.turn_to(frame);
        let dt = clock.tick(stage);
        move_on(stage, dt);
        if stage.dice.chance(eventfulness) {
            event::happen(stage);
        }
        stage.app.update();
        watch::look(stage, outcome);
        if begun.elapsed() > budget {
            outcome.is_cut_short = true;
            stage.diary.note("cut short");
            break;
        }
    }
    outcome.fingerprint = watch::fingerprint(stage);
}

/// Moves all that moves.
fn move_on(stage: &mut Stage, dt: f32) {
    let Stage { movers, dice, app, .. } = stage;
    for mover in movers {
        if let Some(place) = mover.advance(dt, dice)
            && let Some(mut transform) = app.world_mut().get_mut::<Transform>(mover.entity)
        {
            *transform = place;
        }
    }
}
