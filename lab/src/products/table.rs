//! The list of products, from `table.toml`.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::Product;

/// The file.
const TABLE: &str = include_str!("table.toml");

/// What it holds.
#[derive(Deserialize)]
struct Table {
    groups: BTreeMap<String, Vec<String>>,
    product: Vec<Product>,
    pictures: Vec<[String; 5]>,
    verdicts: Vec<[String; 2]>,
}

/// A picture of a scene by `command`, at a size in full and in small, with further arguments.
fn picture([name, folder, scene, command, more]: [&str; 5], [full, small]: [&str; 2], file: &str, groups: &[&str]) -> Product {
    let run = |size: &str| vec![format!("{command} --scene {scene} --size {size} {more} -o {{}}/{file}.png")];
    Product {
        name: name.to_owned(),
        runs: run(full),
        quick: run(small),
        folder: folder.to_owned(),
        files: vec![format!("{file}.png")],
        grows: false,
        sources: groups.iter().map(|group| (*group).to_owned()).chain([format!("assets/*/{scene}.toml")]).collect(),
    }
}

/// Every chart, table and picture of the documents, in the order in which they are made.
pub fn products() -> Result<Vec<Product>, toml::de::Error> {
    let Table { groups, product: mut all, pictures, verdicts } = toml::from_str(TABLE)?;
    all.extend(pictures.iter().map(|[name, folder, scene, size, more]| {
        picture([name, folder, scene, "lensrunner shot", more], [size, "320x180"], name, &["drawn"])
    }));
    all.extend(verdicts.iter().map(|[scene, more]| {
        let name = format!("verdict-{scene}");
        let sizes = ["400x225", "160x90 --samples 1"];
        picture([&name, "verdict", scene, "lensrunner-lab compare", more], sizes, scene, &["drawn", "judged"])
    }));
    for product in &mut all {
        let whole = |source: &String| groups.get(source).cloned().unwrap_or_else(|| vec![source.clone()]);
        product.sources = product.sources.iter().flat_map(whole).collect();
    }
    Ok(all)
}
