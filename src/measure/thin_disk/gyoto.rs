//! The same picture by Gyoto: a scenery file, its program, and the FITS file that it writes.

use std::process::Command;
use std::time::Instant;

use crate::reference::thin_disk::{Impact, Ring, Screen};

/// What to say where it is not installed.
pub const MISSING: &str = "not installed (Debian: gyoto-bin)";

/// Gyoto's picture.
pub struct Picture {
    /// Row by row from the top, as Gyoto has it; see [`oriented`].
    pub impacts: Vec<Impact>,
    /// Rays per second.
    pub rate: f64,
    /// The version.
    pub version: String,
}

/// Runs Gyoto on one thread with this absolute and relative tolerance.
pub fn picture(screen: &Screen, ring: &Ring, tolerance: f64) -> Result<Picture, String> {
    let version = Command::new("gyoto").arg("--version").output().map_err(|_| MISSING.to_owned())?;
    let version = String::from_utf8_lossy(&version.stdout).lines().next().unwrap_or("?").to_owned();
    let folder = std::env::temp_dir().join(format!("lensrunner-gyoto-{}", std::process::id()));
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(&folder).map_err(failed)?;
    std::fs::write(folder.join("disk.xml"), scenery(screen, ring, tolerance)).map_err(failed)?;
    let started = Instant::now();
    let run = Command::new("gyoto").args(["-T1", "-s", "disk.xml", "!disk.fits"]).current_dir(&folder).output().map_err(failed)?;
    let seconds = started.elapsed().as_secs_f64();
    let fits = std::fs::read(folder.join("disk.fits")).map_err(failed);
    // A folder left behind harms nobody.
    let _ = std::fs::remove_dir_all(&folder);
    if !run.status.success() {
        return Err(format!("gyoto failed: {}", String::from_utf8_lossy(&run.stderr).lines().last().unwrap_or("")));
    }
    let impacts = impacts(&fits?, screen)?;
    Ok(Picture { impacts, rate: (screen.pixels * screen.pixels) as f64 / seconds, version })
}

/// Its own example, with our numbers; lengths in M = r_s/2.
fn scenery(screen: &Screen, ring: &Ring, tolerance: f64) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>
<Scenery>
  <Metric kind=\"KerrBL\"><Spin>0.</Spin></Metric>
  <Screen>
    <Position>1000. {} {} 0.</Position>
    <Time unit=\"geometrical_time\">1000.</Time>
    <FieldOfView>{}</FieldOfView>
    <Resolution>{}</Resolution>
  </Screen>
  <Astrobj kind=\"PageThorneDisk\"><InnerRadius>{}</InnerRadius><OuterRadius>{}</OuterRadius></Astrobj>
  <AbsTol>{tolerance:e}</AbsTol>
  <RelTol>{tolerance:e}</RelTol>
  <MinimumTime>-1000.</MinimumTime>
  <Quantities>Redshift ImpactCoords</Quantities>
</Scenery>
",
        2.0 * screen.radius,
        screen.inclination,
        screen.field_of_view,
        screen.pixels,
        2.0 * ring.inner,
        2.0 * ring.outer,
    )
}

/// Radius and redshift of each pixel from the FITS file.
fn impacts(fits: &[u8], screen: &Screen) -> Result<Vec<Impact>, String> {
    let count = screen.pixels * screen.pixels;
    // The first array has the redshift alone. Eight coordinates of the disk's matter, then eight of the light: t, r, θ, φ and their rates.
    let shift = plane(fits, "SIMPLE", count)?;
    let coordinates = plane(fits, "Gyoto Impact Coordinates", 16 * count)?;
    Ok((0..count)
        .map(|i| {
            let (radius, g) = (0.5 * coordinates[16 * i + 1], shift[i]);
            if g > 0.0 && g < 1e10 && radius > 0.0 && radius < 1e10 {
                Impact { radius, g }
            } else {
                Impact { radius: f64::NAN, g: f64::NAN }
            }
        })
        .collect())
}

/// The numbers of the array whose header has `name` (the first has SIMPLE, extensions a name of their own; FITS standard 4.0, sections 3 and 7.1).
fn plane(fits: &[u8], name: &str, count: usize) -> Result<Vec<f64>, String> {
    let mut at = 0;
    while at + 2880 <= fits.len() {
        let mut axes: Vec<usize> = Vec::new();
        let (mut bits, mut named, mut end) = (0i64, false, None);
        for (index, card) in fits[at..].chunks_exact(80).enumerate() {
            let card = String::from_utf8_lossy(card);
            let value = || card.get(10..).unwrap_or("").split('/').next().unwrap_or("").trim().to_owned();
            named |= card.contains(name);
            if card.starts_with("BITPIX") {
                bits = value().parse().unwrap_or(0);
            } else if card.starts_with("NAXIS") && !card.starts_with("NAXIS ") {
                axes.push(value().parse().unwrap_or(0));
            } else if card.trim_end() == "END" {
                end = Some(index + 1);
                break;
            }
        }
        let start = at + (end.ok_or("the FITS file has a header without end")? * 80).next_multiple_of(2880);
        let numbers: usize = if axes.is_empty() { 0 } else { axes.iter().product() };
        let bytes = numbers * (bits.unsigned_abs() as usize / 8);
        if named && bits == -64 && numbers == count {
            let data = fits.get(start..start + bytes).ok_or("the FITS file is cut short")?;
            return Ok(data.chunks_exact(8).map(|b| f64::from_be_bytes(b.try_into().unwrap_or_default())).collect());
        }
        at = start + bytes.next_multiple_of(2880);
    }
    Err(format!("the FITS file has no plane \"{name}\" of {count} numbers"))
}

/// Turned and mirrored so that it meets `truth` best, its g scaled to a hovering camera's: Gyoto's picture may be that of the other hand, and its
/// observer counts frequencies at infinity.
pub fn oriented(truth: &[Impact], picture: &[Impact], pixels: usize) -> Vec<Impact> {
    let place = |i: usize, way: usize| {
        let (column, row) = (i % pixels, i / pixels);
        let column = if way & 1 == 1 { pixels - 1 - column } else { column };
        let row = if way & 2 == 2 { pixels - 1 - row } else { row };
        row * pixels + column
    };
    let turned = |way: usize| -> Vec<Impact> { (0..picture.len()).map(|i| picture[place(i, way)]).collect() };
    let unlike = |other: &[Impact]| -> f64 {
        truth.iter().zip(other).map(|(a, b)| (a.g - b.g).abs()).filter(|d| d.is_finite()).sum::<f64>()
            + truth.iter().zip(other).filter(|(a, b)| a.g.is_finite() != b.g.is_finite()).count() as f64
    };
    let mut best = (0..4).map(turned).min_by(|a, b| unlike(a).total_cmp(&unlike(b))).unwrap_or_default();
    let mut ratios: Vec<f64> = truth.iter().zip(&best).map(|(a, b)| a.g / b.g).filter(|x| x.is_finite()).collect();
    ratios.sort_by(f64::total_cmp);
    let scale = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0);
    best.iter_mut().for_each(|impact| impact.g *= scale);
    best
}
