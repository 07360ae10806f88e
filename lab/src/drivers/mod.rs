//! The same pictures by two drivers: `lensrunner-lab chart drivers`. Which driver draws is told to Vulkan's loader by `VK_DRIVER_FILES`, so
//! each picture is made by the game in a process of its own. Pictures of a driver of another machine are read from a folder.
//!
//! - [`differ`]: how two pictures differ.

pub mod differ;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use image::RgbImage;
use lensrunner::render::Gpu;
use lensrunner::scene;

use crate::chart::{ChartError, DEFAULT_FOLDER, Sheet};
use differ::{Difference, difference};

/// The same scenes by two Vulkan drivers: how many pixels differ, and a picture of those that differ most.
#[derive(Args, Clone, Debug)]
pub struct DriversRequest {
    /// The folder for what is written.
    #[arg(short, value_name = "DIR", default_value = DEFAULT_FOLDER)]
    pub output: PathBuf,
    /// The manifest of the second driver, or a folder with its pictures of the scenes, NAME.png, drawn by `lensrunner shot` on another
    /// machine; the table is then named after the folder.
    #[arg(long, value_name = "FILE.json|DIR")]
    pub driver: PathBuf,
}

/// The scenes that are drawn.
const SCENES: [&str; 12] = [
    "ring", "parade", "galaxy-axis-vertex", "disk", "disk-inner", "disk-80", "chase", "plunge", "aurora-orbit", "aurora-below",
    "aurora-lensed", "02-first-pursuit",
];
/// Width and height in pixels.
const SIZE: [u32; 2] = [640, 360];

/// Columns of the sheet.
pub const COLUMNS: [&str; 6] = ["scene", "pixels", "differ", "elsewhere", "greatest", "FLIP"];

/// Scenes set side by side in the picture: those that differ most.
const SHOWN: usize = 3;

/// Draws all scenes by both drivers, writes `drivers.csv` and `drivers.png`, and returns the files.
pub fn run(request: &DriversRequest) -> Result<Vec<PathBuf>, ChartError> {
    for name in SCENES {
        scene::load(name)?;
    }
    let manifest = request.driver.canonicalize().map_err(|_| {
        ChartError::Input(format!(
            "{}: no such file or folder; it is to be the manifest of a Vulkan driver, for instance vk_swiftshader_icd.json of Chromium, or \
             a folder with pictures",
            request.driver.display()
        ))
    })?;
    let other = manifest.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let pictures = manifest.is_dir();
    let stem = if pictures { format!("drivers-{other}") } else { "drivers".to_owned() };
    let mut sheet = Sheet::measured(&COLUMNS, &Gpu::headless()?.adapter_name());
    sheet.notes.push(("second driver".into(), other));
    let mut all: Vec<(Difference, [RgbImage; 2])> = Vec::new();
    for scene in SCENES {
        eprintln!("{scene}");
        let second = if pictures { drawn(&manifest, scene)? } else { shot(scene, Some(&manifest))? };
        let pair = [shot(scene, None)?, second];
        let found = difference(&pair[0], &pair[1]);
        let Difference { pixels, differ, elsewhere, greatest, flip, .. } = &found;
        sheet.line(format_args!("{scene}|{pixels}|{differ}|{elsewhere}|{greatest}|{flip:.5}"));
        all.push((found, pair));
    }
    let csv = request.output.join(format!("{stem}.csv"));
    sheet.save(&csv)?;
    all.sort_by_key(|(found, _)| std::cmp::Reverse((found.elsewhere, found.differ)));
    all.truncate(SHOWN);
    let path = request.output.join(format!("{stem}.png"));
    side_by_side(&all).save(&path).map_err(|error| ChartError::Write(path.clone(), error.to_string()))?;
    Ok(vec![csv, path])
}

/// A picture of the scene in a folder.
fn drawn(folder: &Path, scene: &str) -> Result<RgbImage, ChartError> {
    let path = folder.join(scene).with_extension("png");
    let [width, height] = SIZE;
    let wrong = |what: String| {
        ChartError::Input(format!("{}: {what}; draw it with `lensrunner shot --scene {scene} --size {width}x{height}`", path.display()))
    };
    let picture = image::open(&path).map_err(|error| wrong(error.to_string()))?.into_rgb8();
    let (wide, high) = picture.dimensions();
    if [wide, high] != SIZE {
        return Err(wrong(format!("{wide} × {high} pixels")));
    }
    Ok(picture)
}

/// A picture by the game, in a process of its own.
fn shot(scene: &str, manifest: Option<&Path>) -> Result<RgbImage, ChartError> {
    let driver = manifest.map_or("the first driver".into(), |manifest| manifest.display().to_string());
    let failed = |reason: String| ChartError::Program(format!("{scene} by {driver}"), reason);
    let here = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let game = here.with_file_name(format!("lensrunner{}", std::env::consts::EXE_SUFFIX));
    let file = std::env::temp_dir().join(format!("lensrunner-drivers-{}.png", std::process::id()));
    let mut command = Command::new(game);
    command.args(["shot", "--scene", scene, "--size", &format!("{}x{}", SIZE[0], SIZE[1]), "-o"]).arg(&file);
    if let Some(manifest) = manifest {
        // The second name is that of older loaders.
        command.env("VK_DRIVER_FILES", manifest).env("VK_ICD_FILENAMES", manifest);
    }
    let ran = command.stdout(Stdio::null()).output().map_err(|error| failed(error.to_string()))?;
    if !ran.status.success() {
        return Err(failed(String::from_utf8_lossy(&ran.stderr).trim().to_owned()));
    }
    let picture = image::open(&file).map_err(|error| failed(error.to_string()))?.into_rgb8();
    _ = std::fs::remove_file(file);
    Ok(picture)
}

/// A row for each scene: the first driver, the second, and where they differ (white: nowhere within a pixel; grey: beyond rounding).
fn side_by_side(all: &[(Difference, [RgbImage; 2])]) -> RgbImage {
    let [width, height] = SIZE;
    let mut picture = RgbImage::new(3 * width, height * all.len().max(1) as u32);
    for (row, (found, pair)) in all.iter().enumerate() {
        let top = i64::from(height) * row as i64;
        for (column, one) in pair.iter().chain([&found.map]).enumerate() {
            image::imageops::replace(&mut picture, one, i64::from(width) * column as i64, top);
        }
    }
    picture
}
