//! The page: methods by places, green or red, a number each.

use super::PARTS;
use super::held::Held;
use crate::chart::{Provenance, Sheet};

const HEAD: &str = "# Where methods fail

A row is a place, a column a method. Green: the greatest error there is within the limit. Red: it is not. A dash: the method gives no answer
where there is one. What the game draws and flies with stands first and must be green everywhere; a test of the laboratory holds them so
(`ours_hold_everywhere`).

    lab/run stability -o docs/lab           # this page and its numbers
    lab/run stability --faults              # puts each fault of the last table into a copy of the sources: every test there must fail
";

/// What stands over a part's table.
const ABOUT: [&str; 4] = [
    "Directions: greatest error in degrees; limit 0.008°, half a pixel at 3840 pixels over 60°. Delays: greatest error as a multiple of what is
allowed, 0.002 r_s/c + 3·10⁻⁷ of the delay, 0.02 r_s/c at radii below 1.05 r_s; limit 1. Truth: the judge's integration. `table` is what the game draws with, `exact` the
closed form in f64, `rk4-256` shooting with 256 steps, `paper1-128` the largest tables of Yamashita 2012.",
    "Error of the place at the end, as a share of the distance from the hole. Limit: 2.7·10⁻⁴, half a pixel at 1920 pixels over 60°. Methods
of equal steps take the game's own, 1/32 r_s/c, adaptive ones a tolerance of 10⁻⁹. Truth: extrapolation in polar coordinates.",
    "Displacement of surface points on the picture, in pixels: that which 99 % of them stay below, at 320 × 180. All ways are asked for 0.5 px,
which is the limit. Truth: the judge's rays.",
    "Rays through corners and edges of closed bodies that pass without a hit, per cent. Limit: none.",
];

/// Methods of a part, in the order of the sheet, the game's first.
fn methods<'a>(sheet: &'a Sheet, rows: &[&'a Vec<String>]) -> Vec<&'a str> {
    let mut names: Vec<(&str, &str)> = Vec::new();
    for row in rows {
        let name = (sheet.text(row, "method"), sheet.text(row, "ours"));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.sort_by_key(|(_, ours)| *ours != "1");
    names.into_iter().map(|(name, _)| name).collect()
}

fn cell(sheet: &Sheet, row: Option<&&Vec<String>>) -> String {
    let Some(row) = row else { return String::new() };
    let light = if sheet.text(row, "holds") == "1" { "🟢" } else { "🔴" };
    format!("{light} {}", number(sheet.number(row, "value")))
}

/// Two digits.
fn number(value: f64) -> String {
    match value {
        v if v.is_nan() => "–".into(),
        0.0 => "0".into(),
        v if v >= 10.0 => format!("{v:.0}"),
        v if v >= 0.01 => format!("{v:.2}"),
        v => format!("{v:.0e}"),
    }
}

/// The page in Markdown.
pub fn page(sheet: &Sheet, held: &[Held]) -> String {
    let mut text = HEAD.to_owned();
    for (part, about) in PARTS.into_iter().zip(ABOUT) {
        let rows: Vec<&Vec<String>> = sheet.of([("part", part)]).collect();
        if rows.is_empty() {
            continue;
        }
        let methods = methods(sheet, &rows);
        let heads: String = methods.iter().map(|name| format!(" {name} |")).collect();
        text.push_str(&format!("\n## {}\n\n{about}\n\n| place |{heads}\n|---|{}\n", capital(part), "---|".repeat(methods.len())));
        let mut places: Vec<&str> = rows.iter().map(|row| sheet.text(row, "place")).collect();
        places.dedup();
        for place in places {
            let find = |method: &&str| rows.iter().find(|row| sheet.text(row, "place") == place && sheet.text(row, "method") == *method);
            let cells: String = methods.iter().map(|method| format!(" {} |", cell(sheet, find(method)))).collect();
            text.push_str(&format!("| {place} |{cells}\n"));
        }
    }
    text.push_str("\n## Held by tests\n\nPlaces without another method beside ours. `--faults` tells which tests find their fault.\n\n");
    text.push_str("| part | place | what holds | test | fault that it finds |\n|---|---|---|---|---|\n");
    for Held { part, place, must, test: [_, test], file, wrong, .. } in held {
        let wrong = wrong.split('\n').next().unwrap_or_default().trim().replace('|', "\\|");
        text.push_str(&format!("| {part} | {place} | {must} | `{test}` | `{file}`: `{wrong}` |\n"));
    }
    let footer = Provenance::footer(&sheet.notes);
    text.push_str(&format!("\n[Numbers](stability.csv). {}\n", footer.join(". ")));
    text
}

fn capital(text: &str) -> String {
    text[..1].to_uppercase() + &text[1..]
}
