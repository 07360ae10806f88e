//! The text of a scene file, line by line, with numbers that a person can read.

use std::fmt::Write;

use glam::DVec3;

/// Digits of drawn numbers: as many as a person would still type.
const DIGITS: i32 = 5;

/// The number with five digits.
pub fn rounded(number: f64) -> f64 {
    rounded_to(number, DIGITS)
}

/// The number with so many digits.
pub fn rounded_to(number: f64, digits: i32) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return number;
    }
    // The decimal text is the nearest there is; arithmetic would leave a tail of nines.
    format!("{number:.*e}", (digits - 1).max(0) as usize).parse().unwrap_or(number)
}

/// A scene file in the making.
#[derive(Clone, Debug, Default)]
pub struct Text(String);

impl Text {
    /// Begins a section, with an empty line after the one before.
    pub fn section(&mut self, header: &str) {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        self.line(&format!("{gap}{header}"));
    }

    /// A line as it is.
    pub fn line(&mut self, line: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{line}");
    }

    /// A real number, rounded.
    pub fn number(&mut self, key: &str, number: f64) {
        self.line(&format!("{key} = {:?}", rounded(number)));
    }

    /// A whole number.
    pub fn whole(&mut self, key: &str, number: u32) {
        self.line(&format!("{key} = {number}"));
    }

    /// A word.
    pub fn word(&mut self, key: &str, word: &str) {
        self.line(&format!("{key} = {word:?}"));
    }

    /// Three numbers, each with five digits.
    pub fn vector(&mut self, key: &str, vector: DVec3) {
        let [x, y, z] = vector.to_array().map(rounded);
        self.line(&format!("{key} = [{x:?}, {y:?}, {z:?}]"));
    }

    /// The text, with an empty line at its end.
    pub fn finish(mut self) -> String {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0
    }
}
