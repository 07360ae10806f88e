//! TOML text to a typed value, with every complaint carrying file, line and dotted key.

pub mod error;
pub mod fault;

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use error::{Complaint, Complaints};
use fault::Fault;

/// Reads a list of exactly `N` values; the TOML reader by itself drops what is too many.
pub fn exactly<'de, D, T, const N: usize>(reader: D) -> Result<Spanned<[T; N]>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: serde::Deserialize<'de>,
{
    let list = Spanned::<Vec<T>>::deserialize(reader)?;
    let span = list.span();
    let values: Result<[T; N], Vec<T>> = list.into_inner().try_into();
    values
        .map(|values| Spanned::new(span, values))
        .map_err(|list| serde::de::Error::invalid_length(list.len(), &format!("an array of length {N}").as_str()))
}

/// As [`exactly`], for a key that may be absent.
pub fn exactly_or_none<'de, D, T, const N: usize>(reader: D) -> Result<Option<Spanned<[T; N]>>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: serde::Deserialize<'de>,
{
    exactly(reader).map(Some)
}

/// Parses `text`, which came from `file`, into a `T`. Unknown keys are errors if `T` denies them.
pub fn parse<T: DeserializeOwned>(file: &Path, text: &str) -> Result<T, Complaint> {
    toml::from_str(text).map_err(|error| syntax(file, text, &error))
}

/// Adds file, line and key to what the TOML reader has to say.
pub fn syntax(file: &Path, text: &str, error: &toml::de::Error) -> Complaint {
    let message = error.message().replace('\n', " ");
    match error.span() {
        Some(span) => complain(file, text, Fault { span, message }),
        None => Complaint { file: file.to_path_buf(), line: None, key: String::new(), problem: message },
    }
}

/// Adds file, line and key to a fault.
fn complain(file: &Path, text: &str, fault: Fault) -> Complaint {
    Complaint {
        file: file.to_path_buf(),
        line: Some(line_of(text, fault.span.start)),
        key: key_at(text, fault.span),
        problem: fault.message,
    }
}

/// As `complain`, of every fault, in the order of their lines.
pub fn complain_all(file: &Path, text: &str, mut faults: Vec<Fault>) -> Complaints {
    faults.sort_by_key(|fault| fault.span.start);
    Complaints(faults.into_iter().map(|fault| complain(file, text, fault)).collect())
}

/// The only complaint.
pub fn one(complaint: Complaint) -> Complaints {
    Complaints(vec![complaint])
}

/// The line of a byte offset, from 1.
fn line_of(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|&byte| byte == b'\n').count() + 1
}

/// The dotted key of the deepest entry whose key or value touches `span`; empty where there is none.
fn key_at(text: &str, span: Range<usize>) -> String {
    let Ok(table) = DeTable::parse(text) else {
        return String::new();
    };
    let mut path = String::new();
    descend_table(table.get_ref(), &span, &mut path);
    path
}

fn touches(outer: Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

fn descend_table(table: &DeTable<'_>, span: &Range<usize>, path: &mut String) -> bool {
    let length = path.len();
    for (key, value) in table {
        if length > 0 {
            path.push('.');
        }
        path.push_str(key.get_ref());
        // The span of a table by header covers the header alone, so its entries are searched in any case.
        if descend_value(value, span, path) || touches(key.span(), span) || touches(value.span(), span) {
            return true;
        }
        path.truncate(length);
    }
    false
}

fn descend_value(value: &Spanned<DeValue<'_>>, span: &Range<usize>, path: &mut String) -> bool {
    match value.get_ref() {
        DeValue::Table(table) => descend_table(table, span, path),
        DeValue::Array(array) => {
            let length = path.len();
            for (index, entry) in array.iter().enumerate() {
                path.push_str(&format!("[{index}]"));
                if descend_value(entry, span, path) || touches(entry.span(), span) {
                    return true;
                }
                path.truncate(length);
            }
            false
        }
        _ => false,
    }
}
