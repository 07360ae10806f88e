//! Something wrong with a value in a scene file.

use std::ops::Range;

use toml::Spanned;

use crate::scene::config::{plain, range_text};

/// Something wrong with a value in a scene file: where, and a sentence with key, value and allowed range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Bytes of the file's text.
    pub span: Range<usize>,
    /// Key, value, allowed range.
    pub message: String,
}

/// A number inside `range`, or the fault that says so.
pub(crate) fn in_range(value: &Spanned<f64>, key: &str, range: std::ops::RangeInclusive<f64>, unit: &str) -> Result<f64, Fault> {
    let x = *value.get_ref();
    if range.contains(&x) && x.is_finite() {
        return Ok(x);
    }
    let from = if *range.end() >= f64::MAX { "" } else { "from " };
    fault(value, format!("{key} = {} must be {from}{}", plain(x), range_text(*range.start(), *range.end(), unit)))
}

/// The fault of a value.
pub(crate) fn fault<T, S>(value: &Spanned<S>, message: String) -> Result<T, Fault> {
    Err(Fault { span: value.span(), message })
}
