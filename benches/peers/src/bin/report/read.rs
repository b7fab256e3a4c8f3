//! Reads JSON lines of two kinds.

use bevy_drape_peers::line::Line;
use serde::Deserialize;
use serde_json::Value;

/// What the lab of bevy_drape says of a run, as far as it is needed here.
#[derive(Deserialize)]
struct LabLine {
    n: usize,
    substeps: u32,
    solver: String,
    /// The coarse levels, as its option writes them.
    #[serde(default)]
    levels: Option<String>,
    us_per_frame_median: f64,
    max_strain: Option<f32>,
    mean_strain: Option<f32>,
    #[serde(default = "yes")]
    finite: bool,
}

fn yes() -> bool {
    true
}

impl From<LabLine> for Line {
    fn from(lab: LabLine) -> Self {
        let levels = lab.levels.filter(|levels| levels != "none").map(|levels| format!(" and levels {levels}"));
        Self {
            system: "bevy_drape".into(),
            version: String::new(),
            setting: format!("{} substeps, {}{}", lab.substeps, lab.solver, levels.unwrap_or_default()),
            n: lab.n,
            us_per_frame_median: lab.us_per_frame_median,
            max_strain: lab.max_strain,
            mean_strain: lab.mean_strain,
            finite: lab.finite,
            mean_height_at_quarter_second: None,
        }
    }
}

/// All lines of `text`.
pub fn values(text: &str) -> Result<Vec<Value>, String> {
    let filled = text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty());
    filled
        .map(|(number, text)| serde_json::from_str(text).map_err(|error| format!("line {}: {error}", number + 1)))
        .collect()
}

/// The runs of `hang` in `text`: a line with a `system` is a peer's, one with a `scene` the lab's. The lab's other
/// scenes and meshes are passed over.
pub fn lines(text: &str) -> Result<Vec<Line>, String> {
    let filled = text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty());
    let read = filled.map(|(number, text)| line(text).map_err(|error| format!("line {}: {error}", number + 1)));
    read.filter_map(Result::transpose).collect()
}

/// Sorts by size and time, and of runs that were repeated keeps the fastest: whatever else the machine did only adds
/// to a time, and the strain of a repetition is the same.
pub fn sort(lines: &mut Vec<Line>) {
    lines.sort_by(|a, b| a.n.cmp(&b.n).then(a.us_per_frame_median.total_cmp(&b.us_per_frame_median)));
    let mut seen: Vec<Line> = Vec::new();
    lines.retain(|line| {
        let any_time = Line { us_per_frame_median: 0.0, ..line.clone() };
        let is_first = !seen.contains(&any_time);
        seen.push(any_time);
        is_first
    });
}

fn line(text: &str) -> serde_json::Result<Option<Line>> {
    let value: Value = serde_json::from_str(text)?;
    let is_or_none = |key: &str, wanted: &str| value.get(key).is_none_or(|found| found == wanted);
    if !is_or_none("scene", "hang") || !is_or_none("mesh", "grid") {
        Ok(None)
    } else if value.get("scene").is_some() {
        serde_json::from_value::<LabLine>(value).map(|lab| Some(lab.into()))
    } else {
        serde_json::from_value(value).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PEER: &str = r#"{"system":"Jolt","version":"5","setting":"5 iterations","n":64,"us_per_frame_median":1.0,
        "max_strain":null,"mean_strain":null,"finite":false}"#;
    const LAB: &str = r#"{"scene":"hang","n":64,"substeps":8,"solver":"strands","levels":"8x8,4x4",
        "us_per_frame_median":195.0,"max_strain":0.008,"mean_strain":0.001,"threads":1}"#;

    #[test]
    fn both_kinds_of_lines_are_read() {
        let others = r#"{"scene":"drape"}
            {"scene":"hang","mesh":"hex","n":64}"#;
        let text = format!("{}\n\n{}\n{others}\n", PEER.replace('\n', ""), LAB.replace('\n', ""));
        let lines = lines(&text).unwrap();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].max_strain, None);
        assert_eq!(
            (lines[1].system.as_str(), lines[1].setting.as_str()),
            ("bevy_drape", "8 substeps, strands and levels 8x8,4x4")
        );
        assert!(lines[1].finite);
    }

    #[test]
    fn rows_go_by_size_and_time_and_repetitions_go() {
        let peer = PEER.replace('\n', "").replace("false", "true");
        let with = |n: &str, time: &str, strain: &str| {
            peer.replacen("64", n, 1).replacen("1.0", time, 1).replacen("null", strain, 1) + "\n"
        };
        let text = with("64", "9.0", "0.1")
            + &with("64", "7.0", "0.1")
            + &with("64", "8.0", "0.2")
            + &with("32", "9.0", "0.1");
        let mut lines = lines(&text).unwrap();
        sort(&mut lines);
        let times: Vec<_> = lines.iter().map(|line| (line.n, line.us_per_frame_median)).collect();
        assert_eq!(times, [(32, 9.0), (64, 7.0), (64, 8.0)]);
    }

    #[test]
    fn a_broken_line_is_named() {
        assert!(lines("\n{}").unwrap_err().starts_with("line 2: "));
    }
}
