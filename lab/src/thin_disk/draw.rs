//! The picture of the chart `trace`, from its sheet alone.

use crate::chart::{Provenance, Sheet, range};
use crate::plot::{Axis, Figure, Guide, Panel, Point, Scatter};

/// Error against speed, of redshift and of flux.
pub fn figure(sheet: &Sheet) -> Figure {
    let methods = ["shape of the ray", "judge", "Gyoto"];
    let points = |error: &str| -> Vec<Point> {
        sheet
            .rows
            .iter()
            .filter_map(|row| {
                let family = methods.iter().position(|method| *method == sheet.text(row, "method"))?;
                let (x, y) = (sheet.number(row, "rays_per_second"), sheet.number(row, error));
                let label = sheet.text(row, "tolerance").to_owned();
                (x > 0.0 && y.is_finite()).then(|| Point { x, y: y.max(1e-17), label, family, failed: false, chosen: false })
            })
            .collect()
    };
    let gyoto = sheet.rows.iter().find(|row| sheet.text(row, "method") == "Gyoto" && sheet.number(row, "tolerance") == 1e-6);
    let rate = gyoto.map(|row| sheet.number(row, "rays_per_second"));
    let panel = |title: &str, error: &str| {
        Panel::Scatter(Scatter {
            title: title.into(),
            x: Axis::log("rays per second and core"),
            y: Axis::log("median difference from the judge at 1e-16"),
            points: points(error),
            families: methods.map(String::from).to_vec(),
            guides_x: rate.map(|rate| Guide { at: 1000.0 * rate, label: "1,000 × Gyoto".into() }).into_iter().collect(),
            ..Scatter::default()
        })
    };
    let mut footer = Provenance::footer(&sheet.notes);
    footer.extend(sheet.note("Gyoto").map(|note| format!("Gyoto: {note}")));
    Figure {
        verdict: verdict(sheet),
        title: "A thin disk of Page and Thorne: error against speed".into(),
        subtitle: "Seen from 100 M at 70°, cut off at 50 M. Each point is a tolerance. Right and down is better.".into(),
        panels: vec![panel("Redshift", "shift_median"), panel("Bolometric flux, of the brightest", "flux_median")],
        columns: 2,
        size: [1400, 700],
        footer,
    }
}

/// How many times as fast as Gyoto the others are, or as the judge where there is no Gyoto.
fn verdict(sheet: &Sheet) -> String {
    let rates = |method: &str| {
        let rows = sheet.of([("method", method)]).filter(|row| sheet.number(row, "tolerance") > 1e-15);
        range(rows.map(|row| sheet.number(row, "rays_per_second")))
    };
    let (shape, judge, gyoto) = (rates("shape of the ray"), rates("judge"), rates("Gyoto"));
    if gyoto[1] > 0.0 {
        return format!(
            "Integrating the shape of a ray is {:.0} to {:.0} times as fast as Gyoto, the judge {:.0} to {:.0} times",
            shape[0] / gyoto[1],
            shape[1] / gyoto[0],
            judge[0] / gyoto[1],
            judge[1] / gyoto[0]
        );
    }
    format!("Integrating the shape of a ray is {:.0} to {:.0} times as fast as the judge", shape[0] / judge[1], shape[1] / judge[0])
}
