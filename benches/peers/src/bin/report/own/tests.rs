use serde_json::json;

use super::*;

#[test]
fn a_row_of_the_sweep_says_what_was_wanted() {
    let line = json!({"case": "c", "command": "hang", "against": null, "met": false, "results": [
        {"what": "max_strain", "least": 0.005, "median": 0.005, "limit": {"at_most": 0.012}, "met": true},
        {"what": "us_per_frame_median", "least": 99.0, "median": 120.0, "limit": {"at_most": 90.0}, "met": false},
        {"what": "times_cheaper", "least": 2.0, "median": 4.0, "limit": {"at_least": 3.0}, "met": true},
    ]});
    let row = "| c | `hang` | largest strain: 0.50 %, ≤ 1.2 %<br>time: 99 µs (120 µs), ≤ 90 µs<br>\
        times cheaper: 4.0, ≥ 3.0 | **no** |";
    assert_eq!(sweep(&[line]).lines().last(), Some(row));
}

#[test]
fn the_fastest_of_repeated_runs_counts() {
    let line = |threads: u32, us: f64| {
        json!({"n": 64, "settings": "--max-strain 0.01", "threads": threads, "particles": 4096, "substeps": 2,
            "levels": "none", "us_per_frame_median": us, "max_strain": 0.01, "p99_strain": 0.001})
    };
    let table = sizes(&[line(1, 120.0), line(1, 100.0), line(2, 80.0), line(2, 90.0)]);
    let row = "| 64 | 4096 | by `max_strain`, 1 % | 2, none | 0.100 | 0.080 | 1.0 % | 0.10 % |";
    assert_eq!(table.lines().last(), Some(row));
}

#[test]
fn parts_are_shares_of_the_whole() {
    let line = json!({"n": 64, "substeps": 2, "levels": "8x4", "us_per_frame": 100.0, "us_of": {"levels": 25.0}});
    assert!(shares(&[line]).contains("| levels | 25 µs, 25 % |"));
}

#[test]
fn flags_stand_in_a_row_for_each_number_of_them() {
    let line = |threads: u32, ms: f64| json!({"cloths": 10, "threads": threads, "ms_per_update": ms});
    let table = many(&[line(1, 1.0), line(2, 0.5)]);
    assert_eq!(table.lines().last(), Some("| 10 | 6400 | 1.00 | 0.50 | 100 | 50 |"));
}
