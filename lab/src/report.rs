//! Writes what the laboratory found into a document: a table for each experiment, plots beside it, and the lines.

use std::{collections::BTreeMap, fs, io, path::Path};

use super::laboratory::{EXPERIMENTS, Extent, Outcome};

mod plot;
mod table;

/// Makes all experiments and fills the places of `document` for them, which are between `<!-- NAME -->` and
/// `<!-- end NAME -->`. Lines and plots go to the folder of the same name beside it.
pub fn write(document: &Path) -> io::Result<()> {
    let folder = document.with_extension("");
    fs::create_dir_all(&folder)?;
    let mut text = fs::read_to_string(document)?;
    let mut lines = String::new();
    let mut curves = BTreeMap::new();
    for experiment in &EXPERIMENTS {
        eprintln!("{}", experiment.name);
        let outcome: Outcome = (experiment.run)(Extent::Full);
        text = fill(&text, experiment.name, &table::markdown(&outcome.measurements))?;
        outcome.measurements.iter().for_each(|measurement| lines += &format!("{}\n", measurement.json()));
        for curve in outcome.curves {
            curves.entry(curve.plot).or_insert_with(Vec::new).push(curve);
        }
    }
    for (name, curves) in curves {
        fs::write(folder.join(name).with_extension("svg"), plot::svg(name, &curves)?)?;
    }
    fs::write(folder.join("measurements.jsonl"), lines)?;
    fs::write(document, text)
}

fn fill(text: &str, name: &str, table: &str) -> io::Result<String> {
    let (begin, end) = (format!("<!-- {name} -->"), format!("<!-- end {name} -->"));
    let missing = || io::Error::other(format!("the document has no place {begin} .. {end}"));
    let (before, rest) = text.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    Ok(format!("{before}{begin}\n\n{}\n{end}{after}", table))
}
