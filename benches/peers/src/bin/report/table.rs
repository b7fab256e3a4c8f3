//! The table.

use bevy_drape_peers::line::Line;

const HEAD: &str = "\
| N | system | setting | ms per frame | largest strain | mean strain |
|---:|---|---|---:|---:|---:|
";

/// A table of `lines`, a row each.
pub fn markdown(lines: &[Line]) -> String {
    HEAD.to_owned() + &lines.iter().map(row).collect::<String>()
}

fn row(line: &Line) -> String {
    let name = format!("{} {}", line.system, line.version);
    let strain = |strain: Option<f32>| match strain {
        Some(strain) if line.finite => percent(strain),
        _ => "not finite".into(),
    };
    format!(
        "| {} | {} | {} | {:.3} | {} | {} |\n",
        line.n,
        name.trim_end(),
        line.setting,
        line.us_per_frame_median / 1000.0,
        strain(line.max_strain),
        strain(line.mean_strain),
    )
}

/// A percentage with two digits that say something, and no more decimals than that.
pub fn percent(strain: f32) -> String {
    match 100.0 * strain {
        percent if percent.abs() >= 1e6 => format!("{percent:.0e} %"),
        percent if percent.abs() >= 10.0 => format!("{percent:.0} %"),
        percent if percent.abs() >= 1.0 => format!("{percent:.1} %"),
        percent if percent.abs() >= 0.1 => format!("{percent:.2} %"),
        percent => format!("{percent:.3} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Line {
        Line {
            system: "a".into(),
            version: "1".into(),
            setting: "b".into(),
            n: 32,
            us_per_frame_median: 9.0,
            max_strain: Some(5.553),
            mean_strain: Some(0.0004),
            finite: true,
            mean_height_at_quarter_second: None,
        }
    }

    #[test]
    fn a_line_is_a_row() {
        assert_eq!(markdown(&[line()]).lines().last(), Some("| 32 | a 1 | b | 0.009 | 555 % | 0.040 % |"));
    }

    #[test]
    fn cloth_that_is_anywhere_fits_its_column() {
        assert_eq!(percent(6.1e7), "6e9 %");
    }

    #[test]
    fn what_blew_up_says_so() {
        let table = markdown(&[Line { finite: false, max_strain: None, ..line() }]);
        assert!(table.contains("| not finite | not finite |"));
    }
}
