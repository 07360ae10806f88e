//! The same picture by Gyoto: a scenery file, its program, and the FITS file that it writes.

use std::process::Command;
use std::time::Instant;

use crate::thin_disk::ray::{Impact, Ring, Screen};

/// What to say where it is not installed.
pub const MISSING: &str = "not installed (Debian: gyoto-bin)";

/// Gyoto's picture.
pub struct GyotoPicture {
    /// Row by row from the top.
    pub impacts: Vec<Impact>,
    /// The bolometric flux that Gyoto itself gives for each pixel, in its unit; not a number where it misses the disk.
    pub fluxes: Vec<f64>,
    /// Rays per second.
    pub rate: f64,
    /// The version.
    pub version: String,
}

/// Runs Gyoto on one thread with this absolute and relative tolerance.
pub fn picture(screen: &Screen, ring: &Ring, tolerance: f64) -> Result<GyotoPicture, String> {
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
    let (impacts, fluxes) = impacts(&fits?, screen)?;
    Ok(GyotoPicture { impacts, fluxes, rate: (screen.pixels * screen.pixels) as f64 / seconds, version })
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
  <Quantities>Redshift User4 ImpactCoords</Quantities>
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

/// Radius, redshift and flux of each pixel from the FITS file.
///
/// Nothing is fitted: FITS counts rows from the bottom (standard 4.0, section 3.3.2), and both pictures have the side that comes nearer at
/// the left. Gyoto's default observer at a finite distance hovers there.
fn impacts(fits: &[u8], screen: &Screen) -> Result<(Vec<Impact>, Vec<f64>), String> {
    let n = screen.pixels;
    let count = n * n;
    // The first array has the redshift, then the flux. The other: eight coordinates of the disk's matter, then eight of the light: t, r, θ,
    // φ and their rates.
    let maps = plane(fits, "SIMPLE", 2 * count)?;
    let coordinates = plane(fits, "Gyoto Impact Coordinates", 16 * count)?;
    Ok((0..count)
        .map(|k| {
            let i = (n - 1 - k / n) * n + k % n;
            let (radius, g, flux) = (0.5 * coordinates[16 * i + 1], maps[i], maps[count + i]);
            if g > 0.0 && g < 1e10 && radius > 0.0 && radius < 1e10 {
                (Impact { radius, g }, flux)
            } else {
                (Impact { radius: f64::NAN, g: f64::NAN }, f64::NAN)
            }
        })
        .unzip())
}

/// The numbers of the array whose header has `name` (the first has SIMPLE, extensions a name of their own; FITS standard 4.0, sections 3
/// and 7.1).
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
