//! Numbers for Bevy's diagnostics: its log and overlays show them.

use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic},
    prelude::*,
};

use crate::{
    schedule::run_after_steps,
    state::{ClothReport, ClothState, ClothStatus},
};

/// Measures all cloths for Bevy's diagnostics, once each time that they step: none while time stands still, several in a
/// frame of several steps.
///
/// Needs [`ClothPlugin`](crate::prelude::ClothPlugin); without it it does nothing and says so.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClothDiagnosticsPlugin;

impl ClothDiagnosticsPlugin {
    /// Time that the step took, ms: the sum over all cloths. The clock shows less where they step side by side.
    pub const STEP_TIME: DiagnosticPath = DiagnosticPath::const_new("cloth/step_time");
    /// Number of cloths that are simulated.
    pub const CLOTHS: DiagnosticPath = DiagnosticPath::const_new("cloth/cloths");
    /// Number of their particles.
    pub const PARTICLES: DiagnosticPath = DiagnosticPath::const_new("cloth/particles");
    /// Substeps of the cloth that took most. [`ClothReport`] says why.
    pub const SUBSTEPS: DiagnosticPath = DiagnosticPath::const_new("cloth/substeps");
    /// Number of contacts in the step's last substep: of particles with obstacles, and of
    /// triangles and edges with each other and with what is sharp.
    pub const CONTACTS: DiagnosticPath = DiagnosticPath::const_new("cloth/contacts");
}

impl Plugin for ClothDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.register_diagnostic(Diagnostic::new(Self::STEP_TIME).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::CLOTHS))
            .register_diagnostic(Diagnostic::new(Self::PARTICLES))
            .register_diagnostic(Diagnostic::new(Self::SUBSTEPS))
            .register_diagnostic(Diagnostic::new(Self::CONTACTS));
    }

    fn finish(&self, app: &mut App) {
        run_after_steps(app, "ClothDiagnosticsPlugin", measure);
    }
}

fn measure(mut diagnostics: Diagnostics, cloths: Query<(&ClothState, &ClothReport, &ClothStatus)>, time: Res<Time>) {
    // No cloth steps then.
    if time.delta_secs() <= 0.0 {
        return;
    }
    let running = || cloths.iter().filter(|(.., status)| status.is_running());
    // What a sleeper's latest step did is over.
    let awake = || running().filter(|(.., status)| **status == ClothStatus::Ready);
    let latest = || awake().filter_map(|(_, report, _)| report.latest());
    diagnostics.add_measurement(&ClothDiagnosticsPlugin::STEP_TIME, || {
        running().map(|(_, report, _)| report.step_time().as_secs_f64() * 1e3).sum()
    });
    diagnostics.add_measurement(&ClothDiagnosticsPlugin::CLOTHS, || running().count() as f64);
    diagnostics.add_measurement(&ClothDiagnosticsPlugin::PARTICLES, || {
        running().map(|(state, ..)| state.particle_count() as f64).sum()
    });
    diagnostics.add_measurement(&ClothDiagnosticsPlugin::SUBSTEPS, || {
        let most = latest().map(|latest| latest.substeps).max();
        f64::from(most.unwrap_or(0))
    });
    diagnostics
        .add_measurement(&ClothDiagnosticsPlugin::CONTACTS, || latest().map(|latest| f64::from(latest.contacts)).sum());
}
