//! TOML text to a typed value, with every complaint carrying file, line and dotted key.

pub mod depth;
pub mod error;
pub mod fault;
pub mod refusal;

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use crate::user_file::{brief, short};
use error::{Complaint, Complaints};
use fault::Fault;
use refusal::in_words;

/// How many complaints about one file are said.
pub const MOST_SAID: usize = 20;

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
    Document::parse(file, text)?.read()
}

/// A TOML text, parsed once for all that is read from it and all that is said of it.
pub struct Document<'a> {
    file: &'a Path,
    text: &'a str,
    table: Spanned<DeTable<'a>>,
}

impl<'a> Document<'a> {
    /// The document in `text`, which came from `file`.
    pub fn parse(file: &'a Path, text: &'a str) -> Result<Self, Complaint> {
        shallow(file, text)?;
        // What is no TOML has no keys.
        let table = DeTable::parse(text).map_err(|error| refused(file, text, None, &error))?;
        Ok(Document { file, text, table })
    }

    /// Its entries.
    pub fn table(&self) -> &DeTable<'a> {
        self.table.get_ref()
    }

    /// The document as a `T`. Unknown keys are errors if `T` denies them.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, Complaint> {
        T::deserialize(Deserializer::from(self.table.clone())).map_err(|error| refused(self.file, self.text, Some(self.table()), &error))
    }

    /// Adds file, line and key to every fault, in the order of their lines; of many the first ones, and how many more there are.
    pub fn complain(&self, mut faults: Vec<Fault>) -> Complaints {
        faults.sort_by_key(|fault| fault.span.start);
        let more = faults.len().saturating_sub(MOST_SAID);
        let one = |fault| complaint(self.file, self.text, Some(self.table()), fault);
        let mut all: Vec<Complaint> = faults.into_iter().take(MOST_SAID).map(one).collect();
        if more > 0 {
            let problem = format!("and {more} more are wrong");
            all.push(Complaint { file: self.file.to_path_buf(), line: None, key: String::new(), problem });
        }
        Complaints(all)
    }
}

/// Refuses text that is nested too deeply.
fn shallow(file: &Path, text: &str) -> Result<(), Complaint> {
    match depth::too_deep(text) {
        None => Ok(()),
        Some(line) => Err(Complaint {
            file: file.to_path_buf(),
            line: Some(line),
            key: String::new(),
            problem: format!("arrays, tables and dotted keys within one another: allowed are {} levels", depth::MOST_LEVELS),
        }),
    }
}

/// Adds file, line and key to what the TOML reader has to say.
fn refused(file: &Path, text: &str, table: Option<&DeTable<'_>>, error: &toml::de::Error) -> Complaint {
    let message = brief(&in_words(&error.message().replace('\n', " ")));
    match error.span() {
        Some(span) => complaint(file, text, table, Fault { span, message }),
        None => Complaint { file: file.to_path_buf(), line: None, key: String::new(), problem: message },
    }
}

/// Adds file, line and key to a fault.
fn complaint(file: &Path, text: &str, table: Option<&DeTable<'_>>, fault: Fault) -> Complaint {
    Complaint {
        file: file.to_path_buf(),
        line: Some(line_of(text, fault.span.start)),
        key: short(&table.map(|table| key_at(table, fault.span)).unwrap_or_default()),
        problem: brief(&fault.message),
    }
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
fn key_at(document: &DeTable<'_>, span: Range<usize>) -> String {
    let mut path = String::new();
    descend_table(document, &span, &mut path);
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
