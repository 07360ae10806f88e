//! What each step of each option of the picture's quality costs and saves, and whether the predictions made from that hold: `chart dial`.
//!
//! - [`moments`]: scenes, times and cameras at random, by class; frames of them.
//! - [`costs`]: the cost table that the game reads (`tables/quality.csv`).
//! - [`check`]: rungs chosen at random, predicted and measured.
//! - [`levels`]: the levels that players choose between, and everything at its finest.
//! - [`moving`]: frames one after the other, with a rung that changes and without.
//! - [`draw`]: the ladder of each class, and the check, as a picture.
//!
//! The error is mean FLIP from the finest picture of the same size, which the judge holds to half a pixel ([`crate::compare`]).

pub mod check;
pub mod costs;
pub mod draw;
pub mod levels;
pub mod moments;
pub mod moving;

use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;
use lensrunner::argument::whole;
use lensrunner::render::quality::costs::QualityCosts;
use lensrunner::scene::picture_size;

use crate::chart::{ChartError, Output, Sheet, SheetError};
use crate::say::say;

/// What each option of the picture's quality costs and saves: the cost table that the game reads (quality.csv); with --check whether the
/// predictions from the game's own list hold, and the chart.
#[derive(Args, Clone, Debug)]
pub struct DialRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Moments of each class of scenes; with --check moments in all.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = whole::<usize>(1, 100_000))]
    pub moments: usize,
    /// Seed of the moments; with --check another each time unless it is given.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = picture_size)]
    pub size: [u32; 2],
    /// Compares predictions with measurements, at moments and rungs at random.
    #[arg(long)]
    pub check: bool,
    /// Measures the levels high, medium, low and the fastest beside everything at its finest, at moments of the chase and three scenes.
    #[arg(long, conflicts_with = "check")]
    pub levels: bool,
    /// Compares each frame of four scenes with the one before, with the rungs that a governor goes through and without; --moments frames.
    #[arg(long, conflicts_with_all = ["check", "levels"])]
    pub moving: bool,
}

impl DialRequest {
    fn seed(&self) -> u64 {
        let fresh = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.subsec_nanos().into());
        self.seed.unwrap_or_else(|| if self.check { fresh() } else { 1 })
    }
}

/// Measures (or reads) what is asked for, says what came out, and draws; returns the files written.
pub fn run(request: &DialRequest) -> Result<Vec<PathBuf>, ChartError> {
    type Measure = fn(&DialRequest, Keep) -> Result<Sheet, ChartError>;
    let output = &request.output;
    let sheet = |name: &str, measure: Measure| output.growing_sheet(name, |keep| measure(request, keep));
    if request.levels {
        let sheet = sheet("dial-levels", levels::measure)?;
        say(levels::verdict(&sheet));
        return Ok(draw::draw_levels(&sheet, output)?.to_vec());
    }
    if request.moving {
        say(moving::verdict(&sheet("dial-moving", moving::measure)?));
        return Ok(vec![output.csv("dial-moving")]);
    }
    if request.check {
        let sheet = sheet("dial-check", check::measure)?;
        say(check::verdict(&sheet));
        return Ok(draw::draw(QualityCosts::shipped(), &sheet, output)?.to_vec());
    }
    let (sheet, file) = (sheet("dial", costs::measure)?, output.csv("quality"));
    std::fs::write(&file, costs::table(&sheet)?).map_err(|error| ChartError::Write(file.clone(), error.to_string()))?;
    Ok(vec![file])
}

/// What writes the rows that there are so far.
pub(crate) type Keep<'a> = &'a dyn Fn(&Sheet) -> Result<(), SheetError>;

/// No scene has a moment of this class.
pub(crate) fn empty(class: &str) -> ChartError {
    ChartError::Failed(format!("no scene of the class {class} has a moment with a camera outside of r = 1.2 r_s"))
}
