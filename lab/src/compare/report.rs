//! The verdict as text, and the two pictures side by side with their difference.

use std::fmt::Write;

use glam::DVec3;

use super::ContestantFrame;
use super::measure::metrics::{Limits, Verdict};
use lensrunner::judge::picture::TracedPicture;
use lensrunner::judge::picture::post_process::{PostProcessSettings, post_process};

/// The verdict as a table, with what goes beyond the limits below.
pub fn table(verdict: &Verdict, limits: &Limits, faults: &[String]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:<16} {:>5} {:>8} {:>7} {:>7} {:>7} {:>6} {:>9} {:>7} {:>6} {:>9} {:>9} {:>6}",
        "object", "order", "pixels", "mean", "99 %", "max", "apart", "mismatch", "%", "inside", "thin", "shown", "FLIP"
    );
    for group in &verdict.groups {
        let d = &group.displacement;
        let percent = 100.0 * group.mismatched as f64 / (group.pixels + group.rim).max(1) as f64;
        let _ = writeln!(
            text,
            "{:<16} {:>5} {:>8} {:>7.3} {:>7.3} {:>7.3} {:>6} {:>9} {:>7.3} {:>6} {:>9.2} {:>9.2} {:>6.4}",
            group.name,
            group.order,
            group.pixels,
            d.mean,
            d.most,
            d.max,
            d.apart,
            group.mismatched,
            percent,
            group.beyond_rim,
            group.thin[0],
            group.thin[1],
            group.flip
        );
    }
    for light in verdict.lights.iter().filter(|light| light.image.1 <= limits.orders) {
        let [shown, judge] = [light.shown, light.judge].map(|light| light.element_sum() / 3.0);
        let part = |light: DVec3| 100.0 * light.element_sum() / 3.0 / judge.max(1e-12);
        let (noise, one_ray) = (part(light.noise), part(light.one_ray));
        let (who, ratio, of_all) = (light.who(), shown / judge, judge / light.picture.element_sum() * 3.0);
        let _ = writeln!(
            text,
            "light of {who}: {shown:.4}, by the judge {judge:.4} ± {noise:.1} % (by one ray a pixel: ± {one_ray:.1} %): ratio {ratio:.3}; {:.1} % of the picture's",
            100.0 * of_all
        );
    }
    let colour = limits.flip.map_or("no limit with surfaces or below 16 rays a pixel".into(), |flip| format!("at most {flip:.4}"));
    let _ = writeln!(
        text,
        "wrong order {} px ({} of them beyond the rim), holes {} px, lit in the shadow {} px, mean FLIP {:.4} ({colour})",
        verdict.wrong_order, verdict.wrong_beyond_rim, verdict.holes, verdict.lit, verdict.flip
    );
    for fault in faults {
        let _ = writeln!(text, "beyond the limit: {fault}");
    }
    let _ = match said(verdict, limits, faults) {
        WITHIN => writeln!(text, "within the limits"),
        NOT_JUDGED => writeln!(text, "{NOT_JUDGED}"),
        _ => Ok(()),
    };
    text
}

/// Nothing is beyond the limits.
pub const WITHIN: &str = "within";
/// There was nothing to hold to them.
pub const NOT_JUDGED: &str = "not judged: nothing solid is seen; colour needs 16 rays a pixel";
/// Something is.
pub const BEYOND: &str = "beyond";

/// One of [`WITHIN`], [`NOT_JUDGED`] and [`BEYOND`].
pub fn said(verdict: &Verdict, limits: &Limits, faults: &[String]) -> &'static str {
    if !faults.is_empty() {
        BEYOND
    } else if verdict.is_judged(limits) {
        WITHIN
    } else {
        NOT_JUDGED
    }
}

/// In a row: the contestant's picture, the judge's, and from black over red and yellow to white the ꟻLIP of each pixel (white: 1) and its
/// displacement (white: 1.5 pixels). Both pictures are finished alike, by themselves. Gives size and sRGB bytes.
pub fn side_by_side(
    judge: &TracedPicture,
    frame: &ContestantFrame,
    difference: &[f32],
    displaced: &[f32],
    how: &PostProcessSettings,
) -> ([u32; 2], Vec<u8>) {
    let [width, height] = judge.size;
    let pictures = [post_process(&frame.light, frame.size, how), post_process(&judge.light, judge.size, how)];
    let map: Vec<u8> = difference.iter().flat_map(|d| heat(*d)).collect();
    let moved: Vec<u8> = displaced.iter().flat_map(|d| heat(d / 1.5)).collect();
    let row = 3 * width as usize;
    let mut bytes = Vec::with_capacity(4 * row * height as usize);
    for y in 0..height as usize {
        for part in [&pictures[0], &pictures[1], &map, &moved] {
            bytes.extend_from_slice(&part[y * row..(y + 1) * row]);
        }
    }
    ([4 * width, height], bytes)
}

fn heat(difference: f32) -> [u8; 3] {
    let channel = |from: f32| (((difference - from) * 3.0).clamp(0.0, 1.0) * 255.0).round() as u8;
    [channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)]
}
