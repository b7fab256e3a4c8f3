//! What an experiment finds.

use std::fmt;

use bevy_drape::solver::Method;
use serde_json::{Value, json};

/// All that an experiment finds.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// A line of the lab each.
    pub measurements: Vec<Measurement>,
    /// What is plotted.
    pub curves: Vec<Curve>,
}

/// What identifies a case.
#[derive(Clone, Debug, Default)]
pub struct Case {
    /// Name of the preset, or what else the cloth is made of.
    pub fabric: &'static str,
    /// Kind of mesh.
    pub mesh: &'static str,
    /// How fine the mesh is: edges along what is measured.
    pub n: u32,
    /// Substeps a step; none for those that the explicit solver finds.
    pub substeps: Option<u32>,
    /// Direction in the cloth.
    pub direction: &'static str,
    /// How it is integrated.
    pub method: Method,
}

impl Case {
    /// The method and its substeps.
    pub fn effort(&self) -> String {
        let name = format!("{:?}", self.method).to_lowercase();
        match self.substeps {
            Some(substeps) => format!("{name}, {substeps} substeps"),
            None => name,
        }
    }
}

/// A measured number beside what it should be.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The experiment.
    pub experiment: &'static str,
    /// What is measured, with its unit.
    pub quantity: String,
    /// In which case.
    pub case: Case,
    /// What it should be. None where nothing is known of it.
    pub expected: Option<f64>,
    /// What it is.
    pub measured: f64,
    /// What an error is a share of, in the unit of the quantity.
    pub scale: f64,
    /// The most that the error may be as a share of `scale`. None where it is only shown.
    pub tolerance: Option<f64>,
    /// The fastest particle when it was measured, m/s, where the cloth should be at rest.
    pub fastest: Option<f64>,
    /// Whether it came to rest, where it should.
    pub is_at_rest: bool,
}

/// Points of a plot.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// The plot.
    pub plot: &'static str,
    /// What the points have in common.
    pub series: String,
    /// Whether it is paper's rather than measured.
    pub is_expected: bool,
    /// Along both axes.
    pub points: Vec<[f64; 2]>,
    /// What stands along the first axis in place of 0, 1 and so on.
    pub names: Vec<&'static str>,
}

impl Measurement {
    /// A number that should be `expected` within a share of that.
    pub fn new(experiment: &'static str, quantity: &str, case: Case, measured: f64, expected: f64) -> Self {
        Self {
            experiment,
            quantity: quantity.into(),
            case,
            expected: Some(expected),
            measured,
            scale: expected.abs(),
            tolerance: None,
            fastest: None,
            is_at_rest: true,
        }
    }

    /// Something of which nothing is expected.
    pub fn shown(experiment: &'static str, quantity: &str, case: Case, measured: f64) -> Self {
        Self { expected: None, ..Self::new(experiment, quantity, case, measured, f64::NAN) }
    }

    /// The error counts as a share of this.
    pub fn of(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The error may be so large a share.
    pub fn within(self, tolerance: f64) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// It was measured after `rest`.
    pub fn after(self, rest: Rest) -> Self {
        Self { fastest: Some(rest.fastest), is_at_rest: rest.is_reached, ..self }
    }

    /// The error as a share of its scale.
    pub fn error(&self) -> Option<f64> {
        Some((self.measured - self.expected?) / self.scale)
    }

    /// Whether it is within its tolerance; none where it has none.
    pub fn is_ok(&self) -> Option<bool> {
        let tolerance = self.tolerance?;
        Some(self.is_at_rest && self.error().is_some_and(|error| error.abs() <= tolerance))
    }

    /// Its line.
    pub fn json(&self) -> Value {
        let Case { fabric, mesh, n, substeps, direction, method } = self.case;
        let named = |name: &'static str| (!name.is_empty()).then_some(name);
        json!({
            "experiment": self.experiment,
            "quantity": self.quantity,
            "fabric": named(fabric),
            "mesh": named(mesh),
            "n": (n > 0).then_some(n),
            "substeps": substeps,
            "direction": named(direction),
            "method": format!("{method:?}").to_lowercase(),
            "expected": self.expected,
            "measured": self.measured,
            "error_rel": self.error(),
            "tolerance": self.tolerance,
            "fastest_m_s": self.fastest,
            "ok": self.is_ok(),
        })
    }
}

impl fmt::Display for Measurement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { quantity, case, measured, .. } = self;
        write!(f, "{quantity}: {measured:.5}")?;
        self.expected.map_or(Ok(()), |expected| write!(f, " for {expected:.5}"))?;
        self.error().map_or(Ok(()), |error| write!(f, ", off by {:.2} %", 100.0 * error))?;
        self.tolerance.map_or(Ok(()), |tolerance| write!(f, " of {:.2} %", 100.0 * tolerance))?;
        self.fastest.map_or(Ok(()), |fastest| write!(f, ", still {fastest:.5} m/s"))?;
        write!(f, " ({}, {}, {} cells, {} {})", case.fabric, case.mesh, case.n, case.direction, case.effort())
    }
}

/// How a cloth came to rest.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// The fastest particle at the end, m/s.
    pub fastest: f64,
    /// Whether it was slow enough.
    pub is_reached: bool,
}
