//! The same pictures by two drivers: `lensrunner-lab chart drivers`. Which driver draws is told to Vulkan's loader by `VK_DRIVER_FILES`, so
//! each picture is made by the game in a process of its own. Pictures of a driver of another machine are read from a folder.
//!
//! - [`differ`]: how two pictures differ.

pub mod differ;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use image::RgbImage;
use lensrunner::render::{DeviceError, Gpu};
use lensrunner::scene::{self, SceneError};
use thiserror::Error;

use crate::chart::{Output, Provenance, Sheet, SheetError};
use differ::{Difference, difference};

/// What to compare.
#[derive(Clone, Debug)]
pub struct DriversRequest {
    /// Where sheet and picture go.
    pub output: Output,
    /// The second driver: its manifest, a `.json` file; or a folder with its pictures, NAME.png for each scene. Sheet and picture are then
    /// named after the folder.
    pub driver: PathBuf,
    /// Names or files of scenes.
    pub scenes: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Why there is no comparison.
#[derive(Debug, Error)]
pub enum DriversError {
    /// The game could not be run, or failed.
    #[error("{scene} by {driver}: {reason}")]
    Shot {
        /// The scene.
        scene: String,
        /// The driver.
        driver: String,
        /// What went wrong.
        reason: String,
    },
    /// There is no such driver.
    #[error(
        "{0}: no such file or folder; it is to be the manifest of a Vulkan driver, for instance vk_swiftshader_icd.json of Chromium, or a \
         folder with pictures"
    )]
    NoDriver(PathBuf),
    /// The folder lacks a picture.
    #[error("{0}: no such file; draw it with `lensrunner shot --scene {1} --size {2}x{3}`")]
    NoPicture(PathBuf, String, u32, u32),
    /// A picture is of another size than was asked for.
    #[error("{0} is {1} × {2} pixels, but {3} × {4} are compared: draw it with `lensrunner shot --size {3}x{4}`")]
    Size(PathBuf, u32, u32, u32, u32),
    /// There is no such scene, or it is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is nothing to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The sheet.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The picture.
    #[error("cannot write {0}: {1}")]
    Write(PathBuf, image::ImageError),
}

impl DriversError {
    /// Whether what was asked for is wrong, rather than that something failed.
    pub fn is_input(&self) -> bool {
        use DriversError::{NoDriver, NoPicture, Scene, Size};
        matches!(self, NoDriver(_) | NoPicture(..) | Scene(_) | Size(..))
    }
}

/// Columns of the sheet.
pub const COLUMNS: [&str; 6] = ["scene", "pixels", "differ", "elsewhere", "greatest", "FLIP"];

/// Scenes set side by side in the picture: those that differ most.
const SHOWN: usize = 3;

/// Draws all scenes by both drivers, writes `drivers.csv` and `drivers.png`, and returns the files.
pub fn run(request: &DriversRequest) -> Result<Vec<PathBuf>, DriversError> {
    for name in &request.scenes {
        scene::load(name)?;
    }
    let manifest = request.driver.canonicalize().map_err(|_| DriversError::NoDriver(request.driver.clone()))?;
    let other = manifest.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let pictures = manifest.is_dir();
    let stem = if pictures { format!("drivers-{other}") } else { "drivers".to_owned() };
    let gpu = Gpu::headless()?;
    let mut sheet = Sheet::new(&COLUMNS);
    sheet.notes = Provenance::now(&gpu.adapter_name()).notes();
    sheet.notes.push(("second driver".into(), other.clone()));
    drop(gpu);
    let mut all: Vec<(Difference, [RgbImage; 2])> = Vec::new();
    for scene in &request.scenes {
        eprintln!("{scene}");
        let second = if pictures {
            drawn(&manifest, scene, request.size)?
        } else {
            shot(scene, request, Some(&manifest), &manifest.display().to_string())?
        };
        let pair = [shot(scene, request, None, "the first driver")?, second];
        let found = difference(&pair[0], &pair[1]);
        sheet.push([
            scene.clone(),
            found.pixels.to_string(),
            found.differ.to_string(),
            found.elsewhere.to_string(),
            found.greatest.to_string(),
            format!("{:.5}", found.flip),
        ]);
        all.push((found, pair));
    }
    let csv = request.output.csv(&stem);
    sheet.save(&csv)?;
    all.sort_by_key(|(found, _)| std::cmp::Reverse((found.elsewhere, found.differ)));
    all.truncate(SHOWN);
    let path = request.output.folder.join(format!("{stem}.png"));
    side_by_side(&all, request.size).save(&path).map_err(|error| DriversError::Write(path.clone(), error))?;
    Ok(vec![csv, path])
}

/// A picture of the scene in a folder.
fn drawn(folder: &Path, scene: &str, [width, height]: [u32; 2]) -> Result<RgbImage, DriversError> {
    let name = Path::new(scene).file_stem().unwrap_or_default();
    let path = folder.join(name).with_extension("png");
    if !path.is_file() {
        return Err(DriversError::NoPicture(path, scene.into(), width, height));
    }
    let failed = |error: image::ImageError| DriversError::Shot {
        scene: scene.into(),
        driver: path.display().to_string(),
        reason: error.to_string(),
    };
    let picture = image::open(&path).map_err(failed)?.into_rgb8();
    if picture.dimensions() != (width, height) {
        return Err(DriversError::Size(path, picture.width(), picture.height(), width, height));
    }
    Ok(picture)
}

/// A picture by the game, in a process of its own.
fn shot(scene: &str, request: &DriversRequest, manifest: Option<&Path>, driver: &str) -> Result<RgbImage, DriversError> {
    let failed = |reason: String| DriversError::Shot { scene: scene.into(), driver: driver.into(), reason };
    let here = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let game = here.with_file_name(format!("lensrunner{}", std::env::consts::EXE_SUFFIX));
    let file = std::env::temp_dir().join(format!("lensrunner-drivers-{}.png", std::process::id()));
    let mut command = Command::new(game);
    command.args(["shot", "--scene", scene, "--size", &format!("{}x{}", request.size[0], request.size[1]), "-o"]).arg(&file);
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
fn side_by_side(all: &[(Difference, [RgbImage; 2])], [width, height]: [u32; 2]) -> RgbImage {
    let mut picture = RgbImage::new(3 * width, height * all.len().max(1) as u32);
    for (row, (found, pair)) in all.iter().enumerate() {
        let top = i64::from(height) * row as i64;
        for (column, one) in pair.iter().chain([&found.map]).enumerate() {
            image::imageops::replace(&mut picture, one, i64::from(width) * column as i64, top);
        }
    }
    picture
}
