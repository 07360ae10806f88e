//! The `project` table: points in, viewing angle, travel time and redshift out, by a method chosen by name.
//!
//! The input is CSV with the header `r,phi,L` (r_s = 1, radians), the output CSV `r,phi,L,psi,delay,redshift` in the same order.

use super::methods::{self, Projector, Query};
use crate::spacetime::light::{self, Branch, Order};
use crate::user_file::short;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::io::{Read, Write};

/// φ this close to 0 or π (radians) is moved to this distance: on the axis itself the ray's plane is not defined.
pub const AXIS_CLEARANCE: f64 = 1e-9;

/// The header of the input.
pub const INPUT_HEADER: &str = "r,phi,L";

/// The header of the output.
pub const OUTPUT_HEADER: &str = "r,phi,L,psi,delay,redshift";

/// Significant digits of the output.
const DIGITS: usize = 12;

/// The most bytes of a table of points: some ten million.
const MOST_BYTES: u64 = 512 << 20;

/// The frame in which ψ is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleFrame {
    /// Hovering at the camera's place; exists only at L > 1.
    Static,
    /// Falling from rest at infinity.
    Rain,
}

/// The method called `name`.
pub fn method(name: &str) -> Result<Box<dyn Projector>, ProjectError> {
    methods::named(name).ok_or_else(|| ProjectError::UnknownMethod { name: name.to_owned() })
}

/// What is wrong with the input of [`project`].
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// No method has that name.
    #[error("unknown method {name:?}: choose one of {}", methods::names())]
    UnknownMethod {
        /// The name asked for.
        name: String,
    },
    /// The first line is not the header.
    #[error("line 1: expected the header {INPUT_HEADER:?}, found {found:?}")]
    Header {
        /// What stands there.
        found: String,
    },
    /// A line is not text.
    #[error("line {line}: not UTF-8 text")]
    Text {
        /// The line, counted from 1.
        line: usize,
    },
    /// More than is read.
    #[error("standard input has more than {MOST_BYTES} bytes, the most that is read")]
    TooLong,
    /// A row has too few or too many fields.
    #[error("line {line}: expected 3 fields ({INPUT_HEADER}), found {found}")]
    Columns {
        /// The line, counted from 1.
        line: usize,
        /// How many there are.
        found: usize,
    },
    /// A field is not a number.
    #[error("line {line}: {field} = {text:?} is not a number")]
    Number {
        /// The line, counted from 1.
        line: usize,
        /// The column's name.
        field: &'static str,
        /// What stands there.
        text: String,
    },
    /// A number is out of its range.
    #[error("line {line}: {field} = {text} is out of range: {range}")]
    Range {
        /// The line, counted from 1.
        line: usize,
        /// The column's name.
        field: &'static str,
        /// What stands there.
        text: String,
        /// What is allowed.
        range: &'static str,
    },
    /// Reading or writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// What is asked about every point.
#[derive(Clone, Copy, Debug)]
pub struct ProjectRequest {
    /// Which image.
    pub order: Order,
    /// The frame of ψ.
    pub frame: AngleFrame,
    /// The sign of the photon's energy.
    pub branch: Branch,
}

/// [`project`] from `input` to `output`; nothing is written if any line is wrong.
pub fn run(input: &mut dyn Read, output: &mut dyn Write, method: &dyn Projector, request: ProjectRequest) -> Result<(), ProjectError> {
    let mut bytes = Vec::new();
    input.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(ProjectError::TooLong);
    }
    let text = str::from_utf8(&bytes).map_err(|error| {
        let newlines = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
        ProjectError::Text { line: newlines + 1 }
    })?;
    output.write_all(project(text, method, request)?.as_bytes())?;
    Ok(output.flush()?)
}

/// Projects every row of the CSV text `input` and returns the CSV output.
///
/// The fields r, phi and L are repeated as they were written. psi is in the frame asked for (empty for `AngleFrame::Static` with L ≤ 1),
/// delay in r_s/c, redshift = ν_observed/ν_emitted between static observers whatever the frame (empty unless both are outside); all three
/// are empty where no ray joins the two. The input is checked as a whole before anything is returned.
pub fn project(input: &str, method: &dyn Projector, request: ProjectRequest) -> Result<String, ProjectError> {
    let rows = parse(input)?;
    let lines: Vec<String> = rows.par_iter().map(|row| row.answer(method, request)).collect();
    let mut output = String::with_capacity(OUTPUT_HEADER.len() + 1 + lines.iter().map(|line| line.len() + 1).sum::<usize>());
    for line in std::iter::once(OUTPUT_HEADER).chain(lines.iter().map(String::as_str)) {
        output.push_str(line);
        output.push('\n');
    }
    Ok(output)
}

/// A row of the input: its fields as written and as numbers.
struct InputRow<'a> {
    texts: [&'a str; 3],
    query: Query,
}

impl InputRow<'_> {
    fn answer(&self, method: &dyn Projector, request: ProjectRequest) -> String {
        let mut line = self.texts.join(",");
        // Integration with too few steps may end anywhere; light that would arrive before it left is none.
        let sight = method.project(self.query, request.order, request.branch).filter(|sight| sight.delay > 0.0);
        let psi = sight.and_then(|sight| match request.frame {
            AngleFrame::Rain => Some(sight.psi_rain),
            AngleFrame::Static => sight.psi_static,
        });
        let delay = sight.map(|sight| sight.delay);
        let redshift = sight.and_then(|_| light::static_redshift(1.0 / self.query.r, 1.0 / self.query.camera));
        for value in [psi, delay, redshift] {
            line.push(',');
            if let Some(value) = value {
                line.push_str(&significant(value));
            }
        }
        line
    }
}

fn parse(input: &str) -> Result<Vec<InputRow<'_>>, ProjectError> {
    let input = input.strip_prefix('\u{feff}').unwrap_or(input);
    // Only the end of the file may be blank.
    let mut lines = input.trim_end().lines();
    let header = lines.next().unwrap_or("");
    if header.split(',').map(str::trim).ne(INPUT_HEADER.split(',')) {
        return Err(ProjectError::Header { found: header.trim().chars().take(80).collect() });
    }
    lines.enumerate().map(|(index, text)| parse_row(text, index + 2)).collect()
}

fn parse_row(text: &str, line: usize) -> Result<InputRow<'_>, ProjectError> {
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    let &[r, phi, camera] = fields.as_slice() else {
        return Err(ProjectError::Columns { line, found: if text.trim().is_empty() { 0 } else { fields.len() } });
    };
    let number = |field: &'static str, text: &str, range: &'static str, allowed: fn(f64) -> bool| {
        let value: f64 = text.parse().map_err(|_| ProjectError::Number { line, field, text: short(text) })?;
        if allowed(value) { Ok(value) } else { Err(ProjectError::Range { line, field, text: short(text), range }) }
    };
    // 1/x must be a number too, or there is nothing to compute with.
    let radius = |x: f64| x > 0.0 && x.is_finite() && x.recip().is_normal();
    let query = Query {
        r: number("r", r, "a finite radius greater than 0", radius)?,
        phi: number("phi", phi, "0 to π radians", |x| (-AXIS_CLEARANCE..=PI + AXIS_CLEARANCE).contains(&x))?
            .clamp(AXIS_CLEARANCE, PI - AXIS_CLEARANCE),
        camera: number("L", camera, "a finite radius greater than 0", radius)?,
    };
    Ok(InputRow { texts: [r, phi, camera], query })
}

/// A number with twelve significant digits, in plain notation where that is short; empty if it is not finite.
pub fn significant(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let exponent: i32 = scientific.split_once('e').and_then(|(_, text)| text.parse().ok()).unwrap_or(0);
    let last = DIGITS as i32 - 1;
    if value == 0.0 || (-5..=last).contains(&exponent) {
        let decimals = if value == 0.0 { last } else { last - exponent };
        format!("{value:.*}", decimals as usize)
    } else {
        scientific
    }
}
