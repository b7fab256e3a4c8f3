//! Everything that has a target, measured at once.

use std::io;

use serde_json::{Value, json};

use crate::measure::Measure;

/// How often everything with a limit on its time is run, by turns.
const ROUNDS: usize = 5;

/// Something with a target.
struct Case {
    name: &'static str,
    /// What is run, as on the command line of the lab.
    command: &'static str,
    /// What it is compared with: `times_cheaper` says by how much.
    against: Option<&'static str>,
    limits: &'static [Limit],
}

/// What a value of a line of the lab may be.
struct Limit(&'static str, Bound);

enum Bound {
    AtMost(f64),
    AtLeast(f64),
    /// What it is compared with has it.
    AtMostThat,
    /// Only shown.
    Any,
}

use Bound::{Any, AtLeast, AtMost, AtMostThat};

const MAX: &str = "max_strain";
const P99: &str = "p99_strain";
const TIME: &str = "us_per_frame_median";
const CHEAPER: &str = "times_cheaper";

const REFERENCE: &[Limit] = &[Limit(MAX, Any), Limit(TIME, Any)];
const SAME_MAX: &[Limit] = &[Limit(MAX, AtMostThat), Limit(CHEAPER, AtLeast(3.0))];
const SAME_P99: &[Limit] = &[Limit(P99, AtMostThat), Limit(CHEAPER, AtLeast(3.0))];

/// The reference comes first and last: if it takes longer than elsewhere, so does everything.
const CASES: [Case; 19] = [
    case("reference", "hang --solver xpbd", REFERENCE),
    case(
        "64 x 64 at 1.2 %",
        "hang --substeps 2 --levels 16x4,8x4",
        &[Limit(MAX, AtMost(0.012)), Limit(TIME, AtMost(100.0))],
    ),
    case(
        "64 x 64 at 0.6 %",
        "hang --substeps 2 --levels 16x8,8x8,4x8",
        &[Limit(MAX, AtMost(0.006)), Limit(TIME, AtMost(170.0))],
    ),
    case(
        "64 x 64, near the truth",
        "hang --substeps 8 --levels none --compare-oracle",
        &[Limit("rms_05s_m", AtMost(0.01)), Limit("mean_strain", AtMost(0.0003))],
    ),
    case(
        "128 x 128",
        "hang --n 128 --substeps 2 --levels 16x8,8x8,4x4",
        &[Limit(MAX, AtMost(0.012)), Limit(TIME, AtMost(800.0))],
    ),
    case(
        "256 x 256",
        "hang --n 256 --substeps 3 --levels 32x8,16x8,8x8",
        &[Limit(MAX, AtMost(0.016)), Limit(TIME, AtMost(4000.0))],
    ),
    case(
        "256 x 256, as it is on two threads",
        "hang --n 256 --substeps 4 --levels 32x8,16x8",
        &[Limit(MAX, AtMost(0.016)), Limit(TIME, AtMost(4000.0))],
    ),
    case(
        "256 x 256 on two threads, share of what two cloths gain",
        "threads --n 256 --substeps 4 --levels 32x8,16x8 --threads 2 --frames 150",
        &[Limit("share", AtLeast(0.85))],
    ),
    case(
        "64 x 64, own XPBD without tethers at the same largest strain",
        "hang --substeps 1 --levels 8x4,4x8",
        &[Limit(MAX, AtMostThat), Limit(CHEAPER, AtLeast(20.0))],
    )
    .against("hang --solver xpbd --tethers off --substeps 128"),
    case(
        "Delaunay mesh",
        "hang --mesh delaunay --substeps 2 --levels 8x4,4x4",
        &[Limit(MAX, Any), Limit(P99, AtMost(0.02)), Limit(TIME, AtMost(350.0))],
    ),
    case(
        "equilateral triangles",
        "hang --mesh hex --substeps 8",
        &[Limit(MAX, Any), Limit(P99, Any), Limit(TIME, Any)],
    ),
    case(
        "skirt, Gauss-Seidel at the same p99 strain",
        "hang --mesh skirt --pins top --substeps 4 --levels none",
        SAME_P99,
    )
    .against("hang --mesh skirt --pins top --solver xpbd --substeps 10"),
    case("the same, less stretched", "hang --mesh skirt --pins top --substeps 8 --levels none", SAME_P99)
        .against("hang --mesh skirt --pins top --solver xpbd --substeps 32"),
    case(
        "skirt, Gauss-Seidel at the same largest strain",
        "hang --mesh skirt --pins top --substeps 4 --levels none",
        SAME_MAX,
    )
    .against("hang --mesh skirt --pins top --solver xpbd --substeps 4"),
    case("the same, less stretched", "hang --mesh skirt --pins top --substeps 8 --levels none", SAME_MAX)
        .against("hang --mesh skirt --pins top --solver xpbd --substeps 10"),
    case("the same, still less", "hang --mesh skirt --pins top --substeps 12 --levels none", SAME_MAX)
        .against("hang --mesh skirt --pins top --solver xpbd --substeps 28"),
    case(
        "drape",
        "drape --substeps 8",
        &[Limit(MAX, AtMost(0.04)), Limit("max_penetration_m", AtMost(1e-6)), Limit("max_speed_end", AtMost(0.05))],
    ),
    case("plugin around the solver", "app", &[Limit("us_around_solver", AtMost(300.0))]),
    case("reference", "hang --solver xpbd", REFERENCE),
];

const fn case(name: &'static str, command: &'static str, limits: &'static [Limit]) -> Case {
    Case { name, command, against: None, limits }
}

impl Case {
    const fn against(self, other: &'static str) -> Self {
        Self { against: Some(other), ..self }
    }

    /// Runs it once.
    fn measure(&self, measure: Measure) -> io::Result<Run> {
        let mut own = measure(self.command)?;
        let other = self.against.map(measure).transpose()?;
        if let Some(other) = &other {
            own[CHEAPER] = (number(other, TIME) / number(&own, TIME)).into();
        }
        Ok(Run { own, other })
    }

    /// Whether any limit is of something that isn't the same in each run.
    fn varies(&self) -> bool {
        self.limits.iter().any(|Limit(what, _)| [TIME, CHEAPER, "share", "us_around_solver"].contains(what))
    }

    fn line(&self, runs: &[Run]) -> Value {
        let results: Vec<Value> = self.limits.iter().map(|limit| limit.result(runs)).collect();
        let met = results.iter().filter_map(|result| result["met"].as_bool());
        json!({
            "scene": "sweep",
            "case": self.name,
            "command": self.command,
            "against": self.against,
            "rounds": runs.len(),
            // None where nothing is limited.
            "met": met.reduce(|all, met| all && met),
            "judged_by": "the fastest round for times of a frame, the middle one for what is made of several times",
            "results": results,
        })
    }
}

/// A line of the lab, and that of what it is compared with.
struct Run {
    own: Value,
    other: Option<Value>,
}

impl Limit {
    fn result(&self, runs: &[Run]) -> Value {
        let Self(what, bound) = self;
        let mut values: Vec<f64> = runs.iter().map(|run| number(&run.own, what)).collect();
        values.sort_unstable_by(f64::total_cmp);
        let (least, median) = (values[0], values[values.len() / 2]);
        let that = || runs[0].other.as_ref().map_or(f64::NAN, |other| number(other, what));
        // Whatever else the machine does only adds to a time, but it can tip a ratio or a difference to either side.
        let judged = if *what == TIME { least } else { median };
        let (limit, met) = match *bound {
            AtMost(most) => (json!({ "at_most": most }), Some(judged <= most)),
            AtMostThat => (json!({ "at_most": that() }), Some(judged <= that())),
            AtLeast(least) => (json!({ "at_least": least }), Some(judged >= least)),
            Any => (Value::Null, None),
        };
        json!({ "what": what, "least": least, "median": median, "limit": limit, "met": met })
    }
}

/// A value of a line; not a number where there is none, which meets no limit.
fn number(line: &Value, what: &str) -> f64 {
    line[what].as_f64().unwrap_or(f64::NAN)
}

/// Runs all cases by turns and prints a line for each.
pub fn run(measure: Measure) -> io::Result<()> {
    let mut runs: Vec<Vec<Run>> = CASES.iter().map(|_| Vec::new()).collect();
    for round in 0..ROUNDS {
        for (case, runs) in CASES.iter().zip(&mut runs) {
            if round == 0 || case.varies() {
                runs.push(case.measure(measure)?);
            }
        }
    }
    CASES.iter().zip(&runs).for_each(|(case, runs)| println!("{}", case.line(runs)));
    Ok(())
}
