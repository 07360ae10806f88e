//! Numbers of a chart as CSV, with what they were measured on in the lines before the header.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use super::Provenance;

/// Rows of text under named columns. A cell with a comma or a quotation mark is written in quotation marks (RFC 4180); line breaks become
/// blanks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// What the numbers were measured on: name and text, written as `# name: text`.
    pub notes: Vec<(String, String)>,
    /// The columns, with their units.
    pub columns: Vec<String>,
    /// The rows, each as long as `columns`.
    pub rows: Vec<Vec<String>>,
}

/// Why a sheet cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// The file cannot be read or written.
    #[error("{}: cannot be read or written: {}", .0.display(), .1)]
    Io(PathBuf, std::io::Error),
    /// The file has no header.
    #[error("{}: no line of column names", .0.display())]
    Header(PathBuf),
    /// A row has another number of cells than the header.
    #[error("{}: line {}: {} cells, the header has {}", .0.display(), .1, .2, .3)]
    Row(PathBuf, usize, usize, usize),
    /// The chart needs a column that is missing.
    #[error("{}: there is no column {:?}", .0, .1)]
    Column(String, String),
}

/// The cells of a line of CSV.
fn cells_of(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if quoted && characters.next_if_eq(&'"').is_some() => cells.last_mut().into_iter().for_each(|cell| cell.push('"')),
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells.last_mut().into_iter().for_each(|cell| cell.push(other)),
        }
    }
    cells
}

impl Sheet {
    /// An empty sheet.
    pub fn new(columns: &[&str]) -> Sheet {
        Sheet { notes: Vec::new(), columns: columns.iter().map(|c| (*c).to_owned()).collect(), rows: Vec::new() }
    }

    /// An empty sheet that says what it is measured on: this machine, now, and `adapter`, which may be empty.
    pub fn measured(columns: &[&str], adapter: &str) -> Sheet {
        Sheet { notes: Provenance::now(adapter).notes(), ..Sheet::new(columns) }
    }

    /// Adds a row.
    pub fn push<S: ToString>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(|cell| cell.to_string()).collect());
    }

    /// Adds a row; `|` parts its cells.
    pub fn line(&mut self, cells: impl Display) {
        self.push(cells.to_string().split('|'));
    }

    /// The rows with these texts in these columns.
    pub fn of<'a, const N: usize>(&'a self, wanted: [(&'a str, &'a str); N]) -> impl Iterator<Item = &'a Vec<String>> + Clone {
        self.rows.iter().filter(move |row| wanted.iter().all(|(name, text)| self.text(row, name) == *text))
    }

    /// The text of a note.
    pub fn note(&self, name: &str) -> Option<&str> {
        self.notes.iter().find(|(n, _)| n == name).map(|(_, text)| text.as_str())
    }

    /// The place of the column called `name`.
    pub fn column(&self, name: &str) -> Result<usize, SheetError> {
        self.columns.iter().position(|c| c == name).ok_or_else(|| SheetError::Column("the chart's CSV".into(), name.to_owned()))
    }

    /// The text in a row's column; empty where there is none.
    pub fn text<'a>(&'a self, row: &'a [String], name: &str) -> &'a str {
        self.columns.iter().position(|c| c == name).and_then(|i| row.get(i)).map_or("", String::as_str)
    }

    /// The number in a row's column; NaN where there is none.
    pub fn number(&self, row: &[String], name: &str) -> f64 {
        self.text(row, name).trim().parse().unwrap_or(f64::NAN)
    }

    /// The texts of a column, each once, in the order in which they come.
    pub fn distinct(&self, name: &str) -> Vec<&str> {
        let mut found: Vec<&str> = Vec::new();
        for text in self.rows.iter().map(|row| self.text(row, name)) {
            if !found.contains(&text) {
                found.push(text);
            }
        }
        found
    }

    /// The sheet as CSV.
    pub fn to_csv(&self) -> String {
        let clean = |cell: &String| {
            let cell = cell.replace(['\n', '\r'], " ");
            if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
        };
        let mut out = String::new();
        for (name, text) in &self.notes {
            out.push_str(&format!("# {name}: {}\n", text.replace(['\n', '\r'], " ")));
        }
        for line in std::iter::once(&self.columns).chain(&self.rows) {
            out.push_str(&line.iter().map(clean).collect::<Vec<_>>().join(","));
            out.push('\n');
        }
        out
    }

    /// The sheet in the CSV text of the file `path`.
    pub fn from_csv(path: &Path, text: &str) -> Result<Sheet, SheetError> {
        let mut sheet = Sheet::default();
        for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
            if let Some((name, note)) = line.strip_prefix("# ").and_then(|rest| rest.split_once(": ")) {
                sheet.notes.push((name.to_owned(), note.to_owned()));
                continue;
            }
            let cells = cells_of(line);
            if sheet.columns.is_empty() {
                sheet.columns = cells;
            } else if cells.len() == sheet.columns.len() {
                sheet.rows.push(cells);
            } else {
                return Err(SheetError::Row(path.to_path_buf(), index + 1, cells.len(), sheet.columns.len()));
            }
        }
        if sheet.columns.is_empty() { Err(SheetError::Header(path.to_path_buf())) } else { Ok(sheet) }
    }

    /// Writes the file; makes its folder.
    pub fn save(&self, path: &Path) -> Result<(), SheetError> {
        let wrong = |error| SheetError::Io(path.to_path_buf(), error);
        if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(wrong)?;
        }
        std::fs::write(path, self.to_csv()).map_err(wrong)
    }

    /// Writes the file, and the same for reading, in Markdown, beside it.
    pub fn save_with(&self, path: &Path, page: &str) -> Result<(), SheetError> {
        self.save(path)?;
        let beside = path.with_extension("md");
        std::fs::write(&beside, page).map_err(|error| SheetError::Io(beside, error))
    }

    /// Reads the file, or begins a sheet with these columns where there is none. An error names the file and what it lacks.
    pub fn open(path: &Path, columns: &[&str]) -> Result<Sheet, SheetError> {
        if !path.exists() {
            return Ok(Sheet::new(columns));
        }
        let sheet = Sheet::load(path)?;
        match columns.iter().enumerate().find(|(k, wanted)| sheet.columns.get(*k).is_none_or(|found| found != *wanted)) {
            Some((_, wanted)) => Err(SheetError::Column(path.display().to_string(), (*wanted).to_owned())),
            None => Ok(sheet),
        }
    }

    /// Reads the file.
    pub fn load(path: &Path) -> Result<Sheet, SheetError> {
        let text = std::fs::read_to_string(path).map_err(|error| SheetError::Io(path.to_path_buf(), error))?;
        Sheet::from_csv(path, &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_come_back_as_they_were() {
        let mut sheet = Sheet::new(&["place, r", "value"]);
        sheet.push(["2,744 balls", "say \"no\""]);
        sheet.push(["", "1;2"]);
        let text = sheet.to_csv();
        assert!(text.contains("\"2,744 balls\",\"say \"\"no\"\"\""), "{text}");
        assert_eq!(Sheet::from_csv(Path::new("sheet.csv"), &text).unwrap(), sheet);
    }
}
