//! The products of the laboratory: every chart, table and picture of the documents, how each is made, and whether it is up to date.
//!
//! - [`table`]: the list. A new chart needs a row there.
//! - [`made`]: what is known of a product as it lies in a folder: commit, machine, driver, command.
//! - [`mod@standing`]: whether the code that it shows has changed since.
//! - [`make`]: makes them anew.

mod git;
pub mod made;
pub mod make;
pub mod standing;
pub mod table;

pub use made::Made;
pub use standing::{Standing, standing};
pub use table::PRODUCTS;

/// The documents, from the project's root.
pub const DOCUMENTS: &str = "docs";

/// Which of the two programs makes a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// `lensrunner-lab`.
    Lab,
    /// `lensrunner`.
    Game,
}

impl Program {
    /// The file's name.
    pub fn name(self) -> &'static str {
        match self {
            Program::Lab => "lensrunner-lab",
            Program::Game => "lensrunner",
        }
    }
}

/// One call of a program.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Which program.
    pub program: Program,
    /// Its arguments, separated by blanks; `{}` stands for the folder that it writes to.
    pub arguments: &'static str,
    /// The file that keeps what it prints.
    pub printed: Option<&'static str>,
}

/// A chart, table or picture of the documents.
#[derive(Clone, Copy, Debug)]
pub struct Product {
    /// What it is called.
    pub name: &'static str,
    /// How it is made; nothing if only some machines can.
    pub runs: &'static [Run],
    /// The same in small, for `--quick`; nothing if it is left out there.
    pub quick: &'static [Run],
    /// Its folder in the documents; empty for the documents' own.
    pub folder: &'static str,
    /// Its files in that folder; a name that ends in `/` is a whole folder.
    pub files: &'static [&'static str],
    /// Whether the runs add to the files that are there.
    pub grows: bool,
    /// Files and folders, from the project's root, that its numbers or pixels depend on; as git's pathspecs. How a chart is drawn is not
    /// among them: `--redraw` does that again without measuring, and a test holds the drawings to the code.
    pub sources: &'static [&'static [&'static str]],
    /// About how long it takes on two cores, in full and in small, in seconds: for the first time, when nothing is known.
    pub seconds: [f64; 2],
}

impl Product {
    /// How it is made, in full or in small.
    pub fn runs(&self, quick: bool) -> &'static [Run] {
        if quick { self.quick } else { self.runs }
    }

    /// All its sources.
    pub fn all_sources(&self) -> impl Iterator<Item = &'static str> {
        self.sources.iter().flat_map(|group| group.iter().copied())
    }

    /// Its files, from the documents' folder.
    pub fn paths(&self) -> impl Iterator<Item = String> {
        let folder = self.folder;
        self.files.iter().map(move |file| if folder.is_empty() { (*file).to_owned() } else { format!("{folder}/{file}") })
    }

    /// The commands as a person types them, without where they write to.
    pub fn commands(&self, quick: bool) -> Vec<String> {
        let plain = |run: &Run| format!("{} {}", run.program.name(), made::plain(run.arguments));
        self.runs(quick).iter().map(plain).collect()
    }
}
