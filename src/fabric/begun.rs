//! Where a text has its fields, also where reading it fails.

use core::fmt;

use ron::Deserializer;
use serde::{
    Deserializer as _,
    de::{MapAccess, Visitor},
};

/// The fields of a text, as far as it can be read.
#[derive(Debug)]
pub(super) struct Begun<'a> {
    /// In the order of the text.
    pub fields: Vec<BegunField<'a>>,
    /// Whether that was all of the fabric.
    pub to_the_end: bool,
}

/// A field whose name could be read.
#[derive(Debug)]
pub(super) struct BegunField<'a> {
    pub name: &'a str,
    /// Line of its name, from 1.
    pub line: usize,
}

impl<'a> Begun<'a> {
    pub fn read(text: &'a str) -> Self {
        let mut names = Vec::new();
        let to_the_end = Deserializer::from_str(text)
            .is_ok_and(|mut ron| ron.deserialize_struct("Fabric", &[], Names(&mut names)).is_ok());
        // RON lends names out of the text: where they lie in it tells their line.
        let offset = |name: &str| name.as_ptr().addr().saturating_sub(text.as_ptr().addr());
        let fields =
            names.into_iter().map(|name| BegunField { name, line: line_at(text.as_bytes(), offset(name)) }).collect();
        Self { fields, to_the_end }
    }
}

/// Keeps the name of every field that has been begun, also where reading fails later on.
struct Names<'a, 'de>(&'a mut Vec<&'de str>);

impl<'de> Visitor<'de> for Names<'_, 'de> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a fabric")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<(), A::Error> {
        while let Some(name) = fields.next_key()? {
            self.0.push(name);
            fields.next_value::<f32>()?;
        }
        Ok(())
    }
}

/// The line, from 1, of a byte of a text.
pub(super) fn line_at(text: &[u8], offset: usize) -> usize {
    1 + text.iter().take(offset).filter(|&&byte| byte == b'\n').count()
}
