//! `lensrunner trace`: the judge's picture of a case, into a file.

use std::path::Path;
use web_time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

use super::case::{Case, TraceError, TraceRequest};
use crate::judge::picture::post_process::post_process;
use crate::judge::picture::{Layer, Sampling, TracedPicture};
use crate::picture_file::{Channel, PictureFileError, check_writable, write_exr, write_png, write_png_with_text};
use crate::scene::{self, GameConfig};

/// Where the picture goes.
#[derive(Clone, Copy)]
pub struct Output<'a> {
    /// A .png or .exr.
    pub file: &'a Path,
    /// Adds what each pixel shows to an .exr.
    pub layers: bool,
    /// A text that a .png carries.
    pub text: Option<&'a str>,
    /// Is told, instead of a progress bar, the share of the picture that is finished, a hundred times at most.
    pub progress: Option<&'a (dyn Fn(f64) + Sync)>,
}

/// Traces the picture into a file, with a progress bar; gives the rays per second and thread.
pub fn trace_to_file(request: &TraceRequest, config: &GameConfig, output: &Output) -> Result<f64, TraceError> {
    check(request, output)?;
    let scene = scene::load(&request.scene)?;
    // A place that cannot be written to is said before the work too.
    check_writable(output.file)?;
    if request.at > 100.0 {
        eprintln!("playing to T = {}", request.at);
    }
    trace_case(&Case::new(scene, config.clone(), request.at, request.size), request, output)
}

/// Whether request and output go together; gives the samples along each side of a pixel. A wrong name is said before the work.
pub fn check(request: &TraceRequest, output: &Output) -> Result<u32, TraceError> {
    let side = request.check()?;
    match output.file.extension().and_then(|extension| extension.to_str()) {
        Some("png") if output.layers => Err(TraceError::Input("--layers needs an .exr: a PNG holds the finished picture alone".into())),
        Some("png" | "exr") => Ok(side),
        _ => Err(PictureFileError::Format(output.file.to_path_buf()).into()),
    }
}

/// The same of a case; scene, T and size are the case's.
pub fn trace_case(case: &Case, request: &TraceRequest, output: &Output) -> Result<f64, TraceError> {
    let side = check(request, output)?;
    check_writable(output.file)?;
    case.check()?;
    for warning in &case.assembly.warnings {
        eprintln!("warning: {warning}");
    }
    if let Some(what) = case.left_out() {
        eprintln!("note: {what}");
    }
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(request.threads)
        .build()
        .map_err(|error| TraceError::Threads { threads: request.threads, reason: error.to_string() })?;
    let [width, height] = case.camera.size;
    let all = u64::from(width) * u64::from(height);
    let bar = if output.progress.is_some() { ProgressBar::hidden() } else { ProgressBar::new(all) };
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} pixels, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    let reported = std::sync::Mutex::new((0, 0));
    let done = |pixels: u64| {
        bar.inc(pixels);
        // Whoever holds it tells the rest.
        let Some((report, mut reported)) = output.progress.zip(reported.lock().ok()) else { return };
        reported.0 += pixels;
        let hundredths = 100 * reported.0 / all.max(1);
        if hundredths > reported.1 {
            reported.1 = hundredths;
            report(hundredths as f64 / 100.0);
        }
    };
    let started = Instant::now();
    let sampling = Sampling { samples: side, tolerance: request.tolerance, packet: request.packet };
    let picture = threads.install(|| case.trace_within(&sampling, true, request.limit, &done));
    bar.finish_and_clear();
    let picture = picture?;
    if let Some(what) = picture.given_up_in_words() {
        eprintln!("note: {what}");
    }
    let rate = all as f64 * f64::from(request.samples) / (started.elapsed().as_secs_f64() * threads.current_num_threads() as f64);
    if output.file.extension().is_some_and(|extension| extension == "png") {
        let rgb = post_process(&picture.light, picture.size, &case.post_process());
        match output.text {
            Some(text) => write_png_with_text(output.file, &rgb, picture.size, text)?,
            None => write_png(output.file, &rgb, picture.size)?,
        }
    } else {
        write_exr(output.file, picture.size, &channels(&picture, output.layers))?;
    }
    Ok(rate)
}

/// The channels of a picture: light, and on request what the pixels show. Names are those of `shot --layers` where they mean the same.
pub fn channels(picture: &TracedPicture, layers: bool) -> Vec<Channel> {
    let channel = |name: &'static str, data: Vec<f32>| Channel { name, data };
    let light = |k: usize| picture.light.iter().map(|rgb| rgb[k]).collect();
    let mut channels = vec![channel("R", light(0)), channel("G", light(1)), channel("B", light(2))];
    if layers {
        let layer = |value: &dyn Fn(&Layer) -> f32| picture.layers.iter().map(value).collect();
        channels.extend([
            channel("object.id", layer(&|l| l.object as f32)),
            channel("triangle.id", layer(&|l| l.triangle as f32)),
            channel("barycentric.a", layer(&|l| l.barycentrics[0])),
            channel("barycentric.b", layer(&|l| l.barycentrics[1])),
            channel("barycentric.c", layer(&|l| l.barycentrics[2])),
            channel("texture.u", layer(&|l| l.uv[0])),
            channel("texture.v", layer(&|l| l.uv[1])),
            channel("image.order", layer(&|l| l.order as f32)),
            channel("swept.angle", layer(&|l| l.swept as f32)),
            channel("travel.time", layer(&|l| l.delay as f32)),
            channel("frequency.ratio", layer(&|l| l.g as f32)),
        ]);
    }
    channels
}
