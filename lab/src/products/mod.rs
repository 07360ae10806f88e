//! The products of the laboratory: every chart, table and picture of the documents, how each is made, and whether it is up to date.
//!
//! - [`table`]: the list, in `table.toml`. A new chart needs a row there.
//! - [`made`]: what is known of a product as it lies in a folder, and whether the code that it shows has changed since.
//! - [`make`]: makes them anew.

pub mod made;
pub mod make;
pub mod table;

pub use table::products;

use serde::Deserialize;

/// The documents, from the project's root.
pub const DOCUMENTS: &str = "docs";

/// A chart, table or picture of the documents.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Product {
    /// What it is called.
    pub name: String,
    /// How it is made, as commands of a shell: `{}` stands for the folder that they write to, ` > FILE` at the end for the file there that
    /// keeps what is printed. None if only some machines can.
    pub runs: Vec<String>,
    /// The same in small, for `--quick`; none if it is left out there.
    pub quick: Vec<String>,
    /// Its folder in the documents; empty for the documents' own.
    pub folder: String,
    /// Its files in that folder; a name that ends in `/` is a whole folder.
    pub files: Vec<String>,
    /// Whether the runs add to the files that are there.
    pub grows: bool,
    /// Files and folders, from the project's root, that its numbers or pixels depend on; as git's pathspecs. How a chart is drawn is not
    /// among them: `--redraw` does that again without measuring, and a test holds the drawings to the code.
    pub sources: Vec<String>,
}

impl Product {
    /// How it is made, in full or in small.
    pub fn runs(&self, quick: bool) -> &[String] {
        if quick { &self.quick } else { &self.runs }
    }

    /// Its files, from the documents' folder.
    pub fn paths(&self) -> impl Iterator<Item = String> {
        self.files.iter().map(|file| if self.folder.is_empty() { file.clone() } else { format!("{}/{file}", self.folder) })
    }

    /// The commands as a person types them, without where they write to.
    pub fn commands(&self, quick: bool) -> Vec<String> {
        self.runs(quick).iter().map(|run| plain(run)).collect()
    }
}

/// A command without where it writes to.
pub fn plain(command: &str) -> String {
    let mut words = Vec::new();
    let mut all = command.split_whitespace();
    while let Some(word) = all.next() {
        match word {
            "-o" | "--output" | "--collect" | "--record" | ">" => drop(all.next()),
            word => words.push(word),
        }
    }
    words.join(" ")
}
