//! What fields are called and what they do, from where they are declared.

/// The first paragraph of a documentation without its marks.
pub(super) fn prose(docs: &str) -> String {
    let lines = docs.trim().lines().map(str::trim).take_while(|line| !line.is_empty());
    let text = lines.collect::<Vec<_>>().join(" ").replace('`', "");
    let mut prose = String::new();
    let mut rest = text.as_str();
    // Of links, what they are called.
    while let Some((before, (name, after))) = rest.split_once('[').and_then(|(a, b)| Some((a, b.split_once(']')?))) {
        prose += before;
        prose += name;
        let target = after.strip_prefix('(').and_then(|target| target.split_once(')'));
        rest = target.map_or(after, |(_, after)| after);
    }
    prose + rest
}

/// A field's name as it is read.
pub(super) fn sentence(field: &str) -> String {
    let name = field.replace('_', " ");
    let mut letters = name.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_a_documentation_are_left_out() {
        let docs = " As [`Cloth::a`] or\n [b](Self::c), `d` * [2.\n\n More.";
        assert_eq!(prose(docs), "As Cloth::a or b, d * [2.");
        assert_eq!(prose(""), "");
    }
}
