//! The tables of bevy_drape alone, from the lines of its lab.

use std::collections::BTreeMap;

use serde_json::Value;

use super::table::percent;

/// What the machine is, and what was built by what.
pub fn machine(lines: &[Value]) -> String {
    let pairs = lines.iter().filter_map(Value::as_object).flatten();
    pairs.map(|(name, value)| format!("- {name}: {}\n", text(value))).collect()
}

/// What was wanted and what came out.
pub fn sweep(lines: &[Value]) -> String {
    let head = "| case | command, `lab` .. | measured, limit | met |\n|---|---|---|---|\n";
    let row = |line: &Value| {
        let results = line["results"].as_array().into_iter().flatten().map(result);
        let against = line["against"].as_str().map_or(String::new(), |other| format!(" against `{other}`"));
        format!(
            "| {} | `{}`{against} | {} | {} |\n",
            text(&line["case"]),
            text(&line["command"]),
            results.collect::<Vec<_>>().join("<br>"),
            line["met"].as_bool().map_or("", |met| if met { "yes" } else { "**no**" }),
        )
    };
    head.to_owned() + &lines.iter().map(row).collect::<String>()
}

/// One limit of a row.
fn result(result: &Value) -> String {
    let what = text(&result["what"]);
    let show = |value: &Value| quantity(&what, number(value));
    let (least, median) = (show(&result["least"]), show(&result["median"]));
    let bound = [("at_most", "≤"), ("at_least", "≥")].into_iter().find_map(|(key, sign)| {
        let bound = result["limit"].get(key)?;
        Some(format!(", {sign} {}", show(bound)))
    });
    let shown = if what.ends_with("median") { format!("{least} ({median})") } else { median };
    format!("{}: {shown}{}", name(&what), bound.unwrap_or_default())
}

/// Sizes of one cloth. Of runs that were repeated, the fastest counts.
pub fn sizes(lines: &[Value]) -> String {
    let mut rows: BTreeMap<(u64, String), [Option<&Value>; 2]> = BTreeMap::new();
    for line in lines {
        let threads = usize::from(number(&line["threads"]) > 1.0);
        let row = rows.entry((number(&line["n"]) as u64, text(&line["settings"]))).or_default();
        if row[threads].is_none_or(|other| time(line) < time(other)) {
            row[threads] = Some(line);
        }
    }
    let head = "\
| N | particles | settings | substeps, levels | ms, one thread | ms, two threads | largest strain | 99 % below |
|---:|---:|---|---|---:|---:|---:|---:|
";
    let row = |((n, settings), [one, two]): (&(u64, String), &[Option<&Value>; 2])| {
        let one = (*one)?;
        let ms = |line: &Value| format!("{:.3}", time(line) / 1000.0);
        Some(format!(
            "| {n} | {} | {} | {}, {} | {} | {} | {} | {} |\n",
            one["particles"],
            if settings.starts_with("--max-strain") { "by `max_strain`, 1 %" } else { "by hand" },
            one["substeps"],
            text(&one["levels"]),
            ms(one),
            two.map_or("-".into(), ms),
            quantity("max_strain", number(&one["max_strain"])),
            quantity("p99_strain", number(&one["p99_strain"])),
        ))
    };
    head.to_owned() + &rows.iter().filter_map(row).collect::<String>()
}

/// Many flags. Of runs that were repeated, the fastest counts.
pub fn many(lines: &[Value]) -> String {
    let mut rows: BTreeMap<u64, [f64; 2]> = BTreeMap::new();
    for line in lines {
        let ms = &mut rows.entry(number(&line["cloths"]) as u64).or_insert([f64::INFINITY; 2]);
        let ms = &mut ms[usize::from(number(&line["threads"]) > 1.0)];
        *ms = ms.min(number(&line["ms_per_update"]));
    }
    let head = "\
| flags | particles | ms a frame, one thread | two threads | µs a flag, one thread | two threads |
|---:|---:|---:|---:|---:|---:|
";
    let row = |(&cloths, [one, two]): (&u64, &[f64; 2])| {
        let each = |ms: &f64| 1000.0 * ms / cloths as f64;
        format!("| {cloths} | {} | {one:.2} | {two:.2} | {:.0} | {:.0} |\n", cloths * 640, each(one), each(two))
    };
    head.to_owned() + &rows.iter().map(row).collect::<String>()
}

/// Where the time of a frame goes, a column for each line.
pub fn shares(lines: &[Value]) -> String {
    let heads = lines.iter().map(|line| {
        let n = &line["n"];
        format!(" {n} x {n}, {} substeps, levels {} |", line["substeps"], text(&line["levels"]))
    });
    let mut table = format!("| part |{}\n|---|{}\n", heads.collect::<String>(), "---:|".repeat(lines.len()));
    for part in ["levels", "tethers", "bending", "shear", "threads", "motion"] {
        let cells = lines.iter().map(|line| {
            let us = number(&line["us_of"][part]);
            format!(" {us:.0} µs, {:.0} % |", 100.0 * us / number(&line["us_per_frame"]))
        });
        table += &format!("| {part} |{}\n", cells.collect::<String>());
    }
    let whole = lines.iter().map(|line| format!(" {:.0} µs |", number(&line["us_per_frame"])));
    table + &format!("| a frame |{}\n", whole.collect::<String>())
}

/// A frame of an app. Of runs that were repeated, the one with the least around the solver counts.
pub fn app(lines: &[Value]) -> String {
    let around = |line: &&Value| number(&line["us_around_solver"]);
    let least = lines.iter().min_by(|a, b| around(a).total_cmp(&around(b))).unwrap_or(&Value::Null);
    let rows = [
        ("an app without the plugin", "us_per_update_without_plugin"),
        ("with the plugin and no cloth", "us_per_update_empty"),
        ("with a cloth of 64 x 64", "us_per_update"),
        ("the cloth's solver alone", "us_solver"),
        ("the plugin around the solver", "us_around_solver"),
    ];
    let row = |(name, key): (&str, &str)| format!("| {name} | {:.0} |\n", number(&least[key]));
    format!("| an update of | µs |\n|---|---:|\n{}", rows.map(row).concat())
}

/// The lab built in several ways. Of runs that were repeated, the fastest counts.
pub fn builds(lines: &[Value]) -> String {
    let mut rows: Vec<(String, BTreeMap<u64, f64>)> = Vec::new();
    for line in lines {
        let build = text(&line["build"]);
        let at = rows.iter().position(|(other, _)| *other == build).unwrap_or_else(|| {
            rows.push((build, BTreeMap::new()));
            rows.len() - 1
        });
        let us = rows[at].1.entry(number(&line["n"]) as u64).or_insert(f64::INFINITY);
        *us = us.min(time(line));
    }
    let sizes: Vec<u64> = rows.first().map_or(Vec::new(), |(_, us)| us.keys().copied().collect());
    let heads = sizes.iter().map(|n| format!(" µs at {n} x {n} |")).collect::<String>();
    let row = |(build, us): &(String, BTreeMap<u64, f64>)| {
        let cells = us.values().map(|us| format!(" {us:.0} |")).collect::<String>();
        format!("| {build} |{cells}\n")
    };
    let bars = "---:|".repeat(sizes.len());
    format!("| build, simd_level |{heads}\n|---|{bars}\n{}", rows.iter().map(row).collect::<String>())
}

fn time(line: &Value) -> f64 {
    number(&line["us_per_frame_median"])
}

/// A number; not a number where there is none.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// What a value of the lab's lines is, in words.
fn name(what: &str) -> &str {
    match what {
        "max_strain" => "largest strain",
        "p99_strain" => "99 % below",
        "mean_strain" => "mean strain",
        "rms_05s_m" => "RMS at 0.5 s",
        "us_per_frame_median" => "time",
        "us_around_solver" => "around the solver",
        "times_cheaper" => "times cheaper",
        "max_penetration_m" => "deepest inside",
        "max_speed_end" => "speed at the end",
        _ => what,
    }
}

/// A value with its unit.
fn quantity(what: &str, value: f64) -> String {
    match what {
        _ if what.ends_with("strain") => percent(value as f32),
        _ if what.starts_with("us_") => format!("{value:.0} µs"),
        "rms_05s_m" => format!("{:.1} mm", 1e3 * value),
        "max_penetration_m" => format!("{:.2} µm", 1e6 * value),
        "max_speed_end" => format!("{value:.3} m/s"),
        "share" => format!("{:.0} %", 100.0 * value),
        _ => format!("{value:.1}"),
    }
}

#[cfg(test)]
mod tests;
