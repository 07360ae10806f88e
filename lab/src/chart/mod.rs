//! What all charts share: where they go, the sheet of numbers they are drawn from, timing side by side, and what stands under them.
//!
//! A chart measures into a [`Sheet`], writes it as CSV, and draws from the sheet alone, so `--redraw` needs no new timing.

pub mod error;
pub mod provenance;
pub mod sheet;
pub mod timing;

use std::path::{Path, PathBuf};

use clap::Args;

pub use error::ChartError;
pub use provenance::Provenance;
pub use sheet::{Sheet, SheetError};
pub use timing::{Timing, interleaved, interleaved_by, mean, quantile, range, thread_time, times_the_first};

/// Where charts go unless said otherwise.
pub const DEFAULT_FOLDER: &str = "out/charts";

/// Where a chart goes.
#[derive(Args, Clone, Debug)]
pub struct Output {
    /// The folder for CSV, SVG and PNG.
    #[arg(short = 'o', id = "output", value_name = "DIR", default_value = DEFAULT_FOLDER)]
    pub folder: PathBuf,
    /// Draws again from the CSV in that folder, without measuring.
    #[arg(long)]
    pub redraw: bool,
}

impl Output {
    /// The file `<folder>/<name>.csv`.
    pub fn csv(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.csv"))
    }

    /// The sheet called `name`: read from the folder if this is a redrawing, else measured now and written there.
    pub fn sheet<E: From<SheetError>>(&self, name: &str, measure: impl FnOnce() -> Result<Sheet, E>) -> Result<Sheet, E> {
        self.growing_sheet(name, |_| measure())
    }

    /// The same where measuring takes long: `measure` gets what writes the rows that there are so far.
    pub fn growing_sheet<E: From<SheetError>>(
        &self,
        name: &str,
        measure: impl FnOnce(&dyn Fn(&Sheet) -> Result<(), SheetError>) -> Result<Sheet, E>,
    ) -> Result<Sheet, E> {
        let path = self.csv(name);
        if self.redraw {
            return Ok(Sheet::load(&path)?);
        }
        let sheet = measure(&|so_far| so_far.save(&path))?;
        sheet.save(&path)?;
        Ok(sheet)
    }
}

/// Says on stderr which files were written.
pub fn announce(paths: &[impl AsRef<Path>]) {
    for path in paths {
        eprintln!("wrote {}", path.as_ref().display());
    }
}
