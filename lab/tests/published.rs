//! The figures that README.md and pages of docs/lab/ print are those of the CSVs in docs/. Where they are not, the
//! test prints what to write.

use std::collections::BTreeMap;
use std::fmt::Write;

use lensrunner_lab::chart::Sheet;

fn read(path: &str) -> String {
    std::fs::read_to_string(crate::support::root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The rows of a CSV, each by the names of its columns.
fn rows(path: &str) -> Vec<BTreeMap<String, String>> {
    let sheet = Sheet::from_csv(path.as_ref(), &read(path)).unwrap();
    sheet.rows.into_iter().map(|row| sheet.columns.iter().cloned().zip(row).collect()).collect()
}

fn number(row: &BTreeMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name} is {:?}", row[name]))
}

/// A method over its three orders.
struct Method {
    name: String,
    max: f64,
    most: f64,
    rms: f64,
    delay: f64,
    wrong: f64,
    row: BTreeMap<String, String>,
}

fn methods(path: &str) -> Vec<Method> {
    let rows = rows(path);
    let mut names: Vec<&String> = rows.iter().map(|row| &row["method"]).collect();
    names.dedup();
    let of = |name: &String| {
        let of_it: Vec<_> = rows.iter().filter(|row| row["method"] == *name).collect();
        assert_eq!(of_it.len(), 3, "{path}: {name} has three orders");
        // Orders that a method does not answer have no errors.
        let most = |column: &str| of_it.iter().map(|row| number(row, column)).fold(f64::NAN, f64::max);
        let sum = |value: &dyn Fn(&BTreeMap<String, String>) -> f64| of_it.iter().map(|row| value(row)).sum::<f64>();
        let answered = |row: &BTreeMap<String, String>| number(row, "answered");
        let square =
            |row: &BTreeMap<String, String>| if answered(row) > 0.0 { number(row, "rms_degrees").powi(2) * answered(row) } else { 0.0 };
        Method {
            name: name.clone(),
            max: most("max_degrees"),
            most: most("p999_degrees"),
            rms: (sum(&square) / sum(&answered)).sqrt(),
            delay: most("delay_over_allowed"),
            wrong: sum(&|row| number(row, "missing") + number(row, "false")) / sum(&|row| number(row, "rows")),
            row: of_it[0].clone(),
        }
    };
    names.into_iter().map(of).collect()
}

/// At most `digits` digits that count, without zeros at the end.
fn short(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let decimals = |value: f64| (digits - 1 - value.abs().log10().floor() as i32).max(0) as usize;
    // What rounding carries over a power of ten has a digit less behind the point.
    let rounded: f64 = format!("{value:.*}", decimals(value)).parse().expect("a number");
    let text = format!("{value:.*}", decimals(rounded));
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// An error: two digits, as a power of ten below 0.01; a dash for none.
fn error(value: f64) -> String {
    if value == 0.0 {
        "–".into()
    } else if value > 1e4 {
        "> 10,000".into()
    } else if value < 0.01 {
        format!("{value:.1e}")
    } else {
        short(value, 2)
    }
}

/// The same that keeps two digits behind the point where there is little before it.
fn share(value: f64) -> String {
    if (0.01..1.0).contains(&value) { format!("{value:.2}") } else { error(value) }
}

fn cells(method: &Method) -> String {
    let Method { name, max, most, rms, delay, wrong, .. } = method;
    format!("| `{name}` | {} | {} | {} | {} | {:.1} % |", error(*max), error(*most), error(*rms), share(*delay), 100.0 * wrong)
}

/// Fails with the lines as they should stand, if they do not stand together in the document.
fn stands(document: &str, lines: &str) {
    let text = read(document);
    assert!(text.contains(lines), "{document} and its CSV differ. It should say:\n\n{lines}\n");
}

/// Methods of the CSV that the document leaves out.
const LEFT_OUT: [&str; 9] =
    ["paper1-16", "paper1-32", "paper1-64", "paper1-uniform-16", "paper1-uniform-32", "paper1-uniform-64", "rk4-16", "rk4-64", "poutanen"];

#[test]
fn the_table_of_the_projection_is_that_of_its_csv() {
    let mut lines = String::new();
    for method in methods("docs/projection.csv").iter().filter(|method| !LEFT_OUT.contains(&method.name.as_str())) {
        let [time, frame, bytes] = ["nanoseconds", "frame_microseconds", "bytes"].map(|name| number(&method.row, name));
        writeln!(lines, "{} {time:.0} | {frame:.1} | {:.1} |", cells(method), bytes / 1_048_576.0).unwrap();
    }
    stands("docs/lab/projection.md", &lines);
}

/// Sentences with numbers, however their lines are broken.
#[test]
fn the_sentences_about_the_projection_are_those_of_the_csv() {
    let all = methods("docs/projection.csv");
    let of = |name: &str| all.iter().find(|method| method.name == name).unwrap_or_else(|| panic!("{name} is not in the CSV"));
    let time = |name: &str| number(&of(name).row, "nanoseconds");
    let mebibytes = number(&of("table").row, "bytes") / 1_048_576.0;
    let ratio = time("table-batch") / time("paper1-128-batch");
    let sentences = [
        ("README.md", format!("A table of {mebibytes:.0} MiB holds")),
        ("README.md", format!("to at most {:.4}° of the exact direction", of("table").max)),
        ("docs/lab/projection.md", format!("`table-batch` takes {ratio:.2} of the time of `paper1-128-batch`")),
    ];
    say(&sentences);
}

#[test]
fn the_tables_of_straight_rays_are_those_of_their_csv() {
    const SCENES: [&str; 6] = ["bunny", "castle", "tree10", "balls4A", "balls4B", "balls4C"];
    let rows = rows("docs/bvh.csv");
    let of = |scene: &str, kind: &str, method: &str, packet: &str| {
        let row =
            rows.iter().find(|row| row["scene"] == scene && row["rays"] == kind && row["method"] == method && row["packet"] == packet);
        row.unwrap_or_else(|| panic!("{method} {packet} is not in the CSV for {kind} rays of {scene}"))
    };
    let mut lines = String::new();
    let mut line = |name: &str, cell: &dyn Fn(&str) -> String| {
        writeln!(lines, "| {name} | {} |", SCENES.map(cell).join(" | ")).unwrap();
    };
    let speed = |row: &BTreeMap<String, String>| {
        let (speed, factor) = (number(row, "Mrays_per_s"), number(row, "times_obvhs"));
        if factor.is_nan() || row["method"] == "obvhs" { format!("{speed:.1}") } else { format!("{speed:.1} ({factor:.2})") }
    };
    for (name, kind, method, packet) in [
        ("obvhs, single", "primary", "obvhs", "1"),
        ("Embree, single", "primary", "Embree", "1"),
        ("tree of eight, single", "primary", "tree of eight", "1"),
        ("Embree, packets of 16", "primary", "Embree 16", "16"),
        ("hull packets, 16 × 16", "primary", "ours", "16"),
        ("hull packets, 64 × 64", "primary", "ours", "64"),
        ("shadow rays: Embree", "shadow", "Embree", "1"),
        ("shadow rays: hull packets", "shadow", "ours", "32"),
        ("scattered rays: tree of eight", "scattered", "tree of eight", "1"),
        ("scattered rays: hull packets", "scattered", "ours", "32"),
    ] {
        line(name, &|scene| speed(of(scene, kind, method, packet)));
    }
    // Of all ways to ask Embree for many rays at once the fastest, on each scene.
    let best = |scene: &str| {
        let of_it = rows.iter().filter(|row| row["scene"] == scene && row["rays"] == "primary" && row["method"].starts_with("Embree"));
        of_it.map(|row| number(row, "Mrays_per_s")).fold(0.0, f64::max)
    };
    let over =
        |size: &'static str| move |scene: &str| format!("{:.2}", number(of(scene, "primary", "ours", size), "Mrays_per_s") / best(scene));
    line("hull packets 16 × 16 over Embree's best", &over("16"));
    line("hull packets 64 × 64 over Embree's best", &over("64"));
    stands("docs/lab/bvh.md", &lines);
    let mut lines = String::new();
    for size in ["16", "32", "64"] {
        let change = |scene: &str| {
            format!("{:+.1} %", 100.0 * (number(of(scene, "primary", "ours", size), "time_over_8x8") - 1.0)).replace('-', "−")
        };
        writeln!(lines, "| {size} × {size} | {} |", SCENES.map(change).join(" | ")).unwrap();
    }
    stands("docs/lab/bvh.md", &lines);
}

/// Fails with the sentences that a document does not say, however its lines are broken.
fn say(sentences: &[(&str, String)]) {
    let plain = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let missing = sentences.iter().filter(|(document, sentence)| !plain(read(document)).contains(&plain(sentence.clone())));
    let missing: Vec<_> = missing.map(|(document, sentence)| format!("{document}: {sentence}")).collect();
    assert!(missing.is_empty(), "these should be said:\n{}\n", missing.join("\n"));
}

#[test]
fn the_limits_of_the_integrators_are_those_of_their_csv() {
    const FLIGHTS: [&str; 5] = ["circle", "eccentric", "zoom-whirl", "fall", "powered"];
    let limits = rows("docs/flight-limits.csv");
    let mut lines = String::new();
    for method in ["RK4", "splitting, order 2", "splitting, order 4", "DOPRI5", "DOP853", "the game"] {
        let cell = |flight: &str| {
            let row = limits.iter().find(|row| row["flight"] == flight && row["method"] == method).expect("a row");
            let text = |column: &str| match row[column].as_str() {
                "none" => "–".to_owned(),
                tolerance if tolerance.contains('e') => tolerance.replacen("1e-", "10^−", 1),
                step => short(step.parse().expect("a step"), 2),
            };
            format!("{} / {}", text("holds_effort"), text("fails_effort"))
        };
        writeln!(lines, "| {} | {} |", method, FLIGHTS.map(cell).join(" | ")).unwrap();
    }
    stands("docs/lab/flight.md", &lines);
}

#[test]
fn the_sentences_about_the_integrators_are_those_of_their_csv() {
    let rows = rows("docs/flight.csv");
    let of = |flight: &str, method: &str, column: &str| {
        let good = rows.iter().filter(|row| row["flight"] == flight && row["method"] == method && number(row, "phase") <= 1e-6);
        good.map(|row| number(row, column)).fold(f64::NAN, f64::min)
    };
    let range = |method: &str, column: &str| {
        let all = ["circle", "eccentric", "zoom-whirl", "fall", "powered"].map(|flight| of(flight, method, column));
        let ends = all.iter().filter(|v| v.is_finite()).fold([f64::INFINITY, 0.0], |[a, b]: [f64; 2], v| [a.min(*v), b.max(*v)]);
        ends.map(|end| short(end, 1))
    };
    let own = rows.iter().filter(|row| row["own"] == "1").map(|row| number(row, "phase")).fold(0.0, f64::max);
    let [least, most] = range("DOP853", "time_over_game");
    let [rk4, rk4s] = range("RK4", "time_over_game");
    say(&[
        ("docs/lab/flight.md", format!("off by at most {own:.0e} rad")),
        ("docs/lab/flight.md", format!("DOP853 with error control takes {least} to {most} of its time")),
        ("docs/lab/flight.md", format!("RK4 {rk4} to {rk4s} times")),
    ]);
}

#[test]
fn the_tables_of_bodies_are_those_of_their_csv() {
    let rows = rows("docs/lab/bodies-growth.csv");
    let cells = |kind: &str, [whose, part]: [&str; 2], column: &str| {
        let row = rows.iter().find(|row| row["kind"] == kind && row["whose"] == whose && row["part"] == part);
        row.map_or("– | –".to_owned(), |row| format!("{:.2} | {}", number(row, "exponent"), short(number(row, column), 2)))
    };
    let mut lines = String::new();
    for (name, part) in [
        ("processor together", ["processor", "together"]),
        ("instances", ["processor", "instances and aurora"]),
        ("lists of bodies", ["processor", "lists of bodies"]),
        ("submission", ["processor", "submission"]),
        ("passes together", ["pass", "together"]),
    ] {
        let (held, flying) = (cells("held", part, "microseconds_a_body"), cells("flying", part, "microseconds_a_body_and_order"));
        writeln!(lines, "| {name} | {held} | {flying} |").unwrap();
    }
    stands("docs/lab/bodies.md", &lines);
    let mut lines = String::new();
    for (name, part) in [("all", "all"), ("largest buffer", "largest")] {
        let [held, flying] = ["held", "flying"].map(|kind| cells(kind, ["memory", part], "bytes_a_body"));
        writeln!(lines, "| {name} | {held} | {flying} |").unwrap();
    }
    stands("docs/lab/bodies.md", &lines);
}

#[test]
fn the_table_of_the_tessellation_is_that_of_its_csv() {
    let rows = rows("docs/tessellation.csv");
    let mut lines = String::new();
    for row in rows.iter().filter(|row| ["0.5", "NaN"].contains(&row["bound_px"].as_str())) {
        let px = |column: &str| if row[column] == "NaN" { "–".to_owned() } else { short(number(row, column), 2) };
        writeln!(
            lines,
            "| `{}` | {} | {} | {} | {} | {} | {} |",
            row["scene"],
            row["way"],
            row["vertices"],
            short(number(row, "time_over_ours"), 2),
            px("p99_px"),
            px("max_px"),
            px("differ_percent")
        )
        .unwrap();
    }
    stands("docs/lab/tessellation.md", &lines);
}

#[test]
fn the_table_of_steps_is_as_it_was_printed() {
    stands("docs/missions.md", &read("docs/tables/steps.md"));
}

/// The mean times of quarries, in the order of the table: the game's pilot, straight away, random, and what the first is of the better.
#[test]
fn the_table_of_quarries_is_as_it_was_printed() {
    let mut lines = String::new();
    for scene in ["02-first-pursuit", "03-through-the-disk", "04-the-ghost"] {
        let text = read(&format!("docs/tables/quarry-{scene}.md"));
        let cells: Vec<Vec<&str>> = text.lines().skip(2).map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect();
        for (place, of_it) in cells.chunks(3).enumerate() {
            let times: Vec<f64> = of_it.iter().map(|row| row[2].split(' ').next().unwrap().parse().unwrap()).collect();
            let name = if place == 0 { format!("| `{scene}`") } else { "|".into() };
            let [pilot, straight, random] = [times[0], times[1], times[2]];
            writeln!(lines, "{name} | {} | {pilot:.1} | {straight:.1} | {random:.1} | {:.2} |", of_it[0][0], pilot / straight.max(random))
                .unwrap();
        }
    }
    stands("docs/missions.md", &lines);
}
