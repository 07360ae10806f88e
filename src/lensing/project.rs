//! The `project` table: points in, viewing angle, travel time and redshift out, by a method chosen by name.
//!
//! The input is CSV with the header `r,phi,L` (r_s = 1, radians), the output CSV `r,phi,L,psi,delay,redshift` in the same order.

use super::methods::{self, ProjectionInput, Projector};
use crate::spacetime::light::{self, Branch, Order};
use crate::user_file::short;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::io::{Read, Write};

/// φ this close to 0 or π (radians) is moved to this distance: on the axis itself the ray's plane is not defined.
const AXIS_CLEARANCE: f64 = 1e-9;

/// The header of the input.
const INPUT_HEADER: &str = "r,phi,L";

/// The header of the output.
const OUTPUT_HEADER: &str = "r,phi,L,psi,delay,redshift";

/// Significant digits of the output.
const DIGITS: usize = 12;

/// The most bytes of a line.
const MOST_LINE: usize = 1 << 20;

/// The most bytes that are read at once.
const BLOCK: usize = 1 << 20;

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
    let method = methods::named(name).ok_or_else(|| ProjectError::UnknownMethod { name: name.to_owned() })?;
    Ok(method.made())
}

/// What is wrong with the input of [`project`].
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// No method has that name.
    #[error("unknown method {name:?}: choose one of {}", methods::NAMES.join(", "))]
    UnknownMethod {
        /// The name asked for.
        name: String,
    },
    /// What is handed in cannot be read.
    #[error("standard input: {0}")]
    Read(std::io::Error),
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
    /// A line is longer than any that is right.
    #[error("line {line}: more than {MOST_LINE} bytes, allowed are {MOST_LINE}")]
    Long {
        /// The line, counted from 1.
        line: usize,
    },
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
    /// The answers cannot be written.
    #[error("standard output: {0}")]
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

/// [`project`] from `input` to `output`, written as it is read: all whole lines that are there at once are a block, of which nothing is
/// written if one of them is wrong.
pub fn run(input: &mut dyn Read, output: &mut dyn Write, method: &dyn Projector, request: ProjectRequest) -> Result<(), ProjectError> {
    let mut reader = RowReader::default();
    let mut buffer = vec![0; BLOCK];
    let mut pending: Vec<u8> = Vec::new();
    loop {
        let count = match input.read(&mut buffer) {
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            other => other.map_err(ProjectError::Read)?,
        };
        // The last line may go on.
        let last = buffer[..count].iter().rposition(|byte| *byte == b'\n').map_or(0, |last| pending.len() + last + 1);
        pending.extend_from_slice(&buffer[..count]);
        let end = if count == 0 { pending.len() } else { last };
        if end > 0 {
            output.write_all(reader.answers(&pending[..end], method, request)?.as_bytes())?;
            output.flush()?;
            pending.drain(..end);
        }
        if pending.len() > MOST_LINE {
            return Err(ProjectError::Long { line: reader.line + 1 });
        }
        if count == 0 {
            return reader.finish();
        }
    }
}

/// Projects every row of the CSV text `input` and returns the CSV output.
///
/// The fields r, phi and L are repeated as they were written. psi is in the frame asked for (empty for `AngleFrame::Static` with L ≤ 1),
/// delay in r_s/c, redshift = ν_observed/ν_emitted between static observers whatever the frame (empty unless both are outside); all three
/// are empty where no ray joins the two. The input is checked as a whole before anything is returned.
pub fn project(input: &str, method: &dyn Projector, request: ProjectRequest) -> Result<String, ProjectError> {
    let mut reader = RowReader::default();
    let output = reader.answers(input.as_bytes(), method, request)?;
    reader.finish().map(|()| output)
}

/// What is known of the input so far.
#[derive(Default)]
struct RowReader {
    /// Lines read.
    line: usize,
    /// The first of blank lines: only the end of the input may be blank.
    blank: Option<usize>,
}

impl RowReader {
    /// The output for the next whole lines.
    fn answers(&mut self, lines: &[u8], method: &dyn Projector, request: ProjectRequest) -> Result<String, ProjectError> {
        let is_first = self.line == 0 && !lines.is_empty();
        let rows = self.rows(lines)?;
        let lines: Vec<String> = rows.par_iter().map(|row| row.answer(method, request)).collect();
        let mut output = String::with_capacity(OUTPUT_HEADER.len() + 1 + lines.iter().map(|line| line.len() + 1).sum::<usize>());
        for line in is_first.then_some(OUTPUT_HEADER).into_iter().chain(lines.iter().map(String::as_str)) {
            output.push_str(line);
            output.push('\n');
        }
        Ok(output)
    }

    fn rows<'a>(&mut self, lines: &'a [u8]) -> Result<Vec<InputRow<'a>>, ProjectError> {
        let mut rows = Vec::new();
        let lines = lines.strip_suffix(b"\n").map_or((!lines.is_empty()).then_some(lines), Some);
        for bytes in lines.into_iter().flat_map(|lines| lines.split(|byte| *byte == b'\n')) {
            self.line += 1;
            let line = self.line;
            if bytes.len() > MOST_LINE {
                return Err(ProjectError::Long { line });
            }
            let text = str::from_utf8(bytes).map_err(|_| ProjectError::Text { line })?.trim_end();
            if line == 1 {
                let header = text.strip_prefix('\u{feff}').unwrap_or(text);
                if header.split(',').map(str::trim).ne(INPUT_HEADER.split(',')) {
                    return Err(ProjectError::Header { found: header.trim().chars().take(80).collect() });
                }
            } else if text.is_empty() {
                self.blank.get_or_insert(line);
            } else if let Some(line) = self.blank {
                return Err(ProjectError::Columns { line, found: 0 });
            } else {
                rows.push(parse_row(text, line)?);
            }
        }
        Ok(rows)
    }

    /// Whether the input may end here.
    fn finish(&self) -> Result<(), ProjectError> {
        if self.line == 0 { Err(ProjectError::Header { found: String::new() }) } else { Ok(()) }
    }
}

/// A row of the input: its fields as written and as numbers.
struct InputRow<'a> {
    texts: [&'a str; 3],
    input: ProjectionInput,
}

impl InputRow<'_> {
    fn answer(&self, method: &dyn Projector, request: ProjectRequest) -> String {
        let mut line = self.texts.join(",");
        // Integration with too few steps may end anywhere; light that would arrive before it left is none.
        let sight = method.project(self.input, request.order, request.branch).filter(|sight| sight.delay > 0.0);
        let psi = sight.and_then(|sight| match request.frame {
            AngleFrame::Rain => Some(sight.psi_rain),
            AngleFrame::Static => sight.psi_static,
        });
        let delay = sight.map(|sight| sight.delay);
        let redshift = sight.and_then(|_| light::static_redshift(1.0 / self.input.r, 1.0 / self.input.camera));
        for value in [psi, delay, redshift] {
            line.push(',');
            if let Some(value) = value {
                line.push_str(&significant(value));
            }
        }
        line
    }
}

fn parse_row(text: &str, line: usize) -> Result<InputRow<'_>, ProjectError> {
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    let &[r, phi, camera] = fields.as_slice() else {
        return Err(ProjectError::Columns { line, found: fields.len() });
    };
    let number = |field: &'static str, text: &str, range: &'static str, allowed: fn(f64) -> bool| {
        let value: f64 = text.parse().map_err(|_| ProjectError::Number { line, field, text: short(text) })?;
        if allowed(value) { Ok(value) } else { Err(ProjectError::Range { line, field, text: short(text), range }) }
    };
    // 1/x must be a number too, or there is nothing to compute with.
    let radius = |x: f64| x > 0.0 && x.is_finite() && x.recip().is_normal();
    let input = ProjectionInput {
        r: number("r", r, "a finite radius greater than 0", radius)?,
        phi: number("phi", phi, "0 to π radians", |x| (-AXIS_CLEARANCE..=PI + AXIS_CLEARANCE).contains(&x))?
            .clamp(AXIS_CLEARANCE, PI - AXIS_CLEARANCE),
        camera: number("L", camera, "a finite radius greater than 0", radius)?,
    };
    Ok(InputRow { texts: [r, phi, camera], input })
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
