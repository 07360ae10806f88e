//! Something wrong with a value in a scene file.

use std::ops::Range;

use toml::Spanned;

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

/// `0.1 to 20 r_s/c`.
pub(in crate::scene) fn range_text(min: f64, max: f64, unit: &str) -> String {
    let space = if unit.is_empty() { "" } else { " " };
    if max >= f64::MAX {
        return format!("{} or more{space}{unit}", plain(min));
    }
    format!("{} to {}{space}{unit}", plain(min), plain(max))
}

/// Long numbers with an exponent, others without.
pub(in crate::scene) fn plain(number: f64) -> String {
    if number != 0.0 && !(1e-4..1e10).contains(&number.abs()) { format!("{number:e}") } else { number.to_string() }
}
