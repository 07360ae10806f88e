//! Results on standard output.

use std::fmt::Display;
use std::io::{self, Write};

/// Prints `text` and a line's end. What nobody reads any more, as behind `| head`, is dropped: the work goes on, and its files are written.
pub fn say(text: impl Display) {
    let _ = writeln!(io::stdout().lock(), "{text}");
}
