//! Places in a document that tables are written to.

/// Replaces what is between `<!-- name -->` and `<!-- end name -->`.
pub fn fill(text: &str, name: &str, table: &str) -> Result<String, String> {
    let (begin, end) = (format!("<!-- {name} -->"), format!("<!-- end {name} -->"));
    let missing = |mark: &str| format!("the document has no {mark}");
    let (before, rest) = text.split_once(&begin).ok_or_else(|| missing(&begin))?;
    let (_, after) = rest.split_once(&end).ok_or_else(|| missing(&end))?;
    Ok(format!("{before}{begin}\n\n{}\n\n{end}{after}", table.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_filled_again_and_again() {
        let text = "a <!-- t -->old<!-- end t --> b";
        let filled = fill(text, "t", "\nnew\n").unwrap();
        assert_eq!(filled, "a <!-- t -->\n\nnew\n\n<!-- end t --> b");
        assert_eq!(fill(&filled, "t", "new").unwrap(), filled);
    }

    #[test]
    fn a_place_that_is_missing_is_named() {
        assert!(fill("a <!-- t -->", "t", "").unwrap_err().contains("<!-- end t -->"));
    }
}
