//! Changes in the text of a `game.toml`: values are replaced, all else stays as it was written.

use std::path::Path;

use toml_edit::{DocumentMut, Item, Table, value};

use super::assignment::Assignment;
use super::parse;
use crate::scene::document::error::{Complaint, Complaints};

/// The text of `file` with these values; comments, order and spaces stay, and comments behind values stay in their column where there is
/// room. A key that is not there is added to its section with what it does. Text that cannot be read, and values that clash, are errors.
pub fn edited(file: &Path, text: &str, changes: &[Assignment]) -> Result<String, Complaints> {
    parse(file, text)?;
    let wrong = |problem: String| Complaints(vec![Complaint { file: file.to_path_buf(), line: None, key: String::new(), problem }]);
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| wrong(error.message().to_owned()))?;
    for Assignment { setting, value: new } in changes {
        let new: toml_edit::Value = new.written().parse().map_err(|error: toml_edit::TomlError| wrong(error.message().to_owned()))?;
        let section = document.entry(setting.section).or_insert_with(|| Item::Table(Table::new()));
        let Some(section) = section.as_table_like_mut() else { return Err(wrong(format!("{} is no section", setting.section))) };
        match section.get_mut(setting.key).and_then(Item::as_value_mut) {
            Some(old) => replace(old, new),
            None => {
                let mut added = value(new);
                if let Some(added) = added.as_value_mut() {
                    added.decor_mut().set_suffix(format!(" # {} ({})", setting.help, setting.allowed_text()));
                }
                section.insert(setting.key, added);
            }
        }
    }
    let text = document.to_string();
    parse(file, &text)?;
    Ok(text)
}

/// Puts `new` in the place of `old`; a comment behind it stays in its column where there is room.
fn replace(old: &mut toml_edit::Value, new: toml_edit::Value) {
    let length = |value: &toml_edit::Value| value.clone().decorated("", "").to_string().chars().count();
    let spare = length(old) as isize - length(&new) as isize;
    let mut decor = old.decor().clone();
    let suffix = decor.suffix().and_then(|suffix| suffix.as_str()).unwrap_or_default().to_owned();
    let comment = suffix.trim_start_matches(' ');
    if comment.starts_with('#') {
        let spaces = ((suffix.len() - comment.len()) as isize + spare).max(1) as usize;
        decor.set_suffix(format!("{}{comment}", " ".repeat(spaces)));
    }
    *old = new;
    *old.decor_mut() = decor;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::GameConfig;
    use crate::scene::config::template;

    fn change(all: &[&str]) -> Vec<Assignment> {
        all.iter().map(|text| text.parse().expect("an assignment")).collect()
    }

    fn edit(text: &str, all: &[&str]) -> Result<String, String> {
        edited(Path::new("game.toml"), text, &change(all)).map_err(|wrong| wrong.to_string())
    }

    /// Lines that are not changed are the same to the letter; those that are, in the form of the template.
    #[test]
    fn an_edited_template_is_the_template_of_the_edited() {
        let mut config = GameConfig::default();
        let before = template(&config);
        let all = ["render.orders=3", "render.bloom=0.125", "render.doppler=false", "disk.representation=polygons", "hole.mass_solar=4e6"];
        change(&all).iter().for_each(|one| one.apply(&mut config));
        let after = edit(&before, &all).expect("a text");
        assert_eq!(after, template(&config));
        assert_eq!(edit(&before, &[]).expect("a text"), before);
    }

    #[test]
    fn whatever_else_is_written_stays() {
        let text = "# Mine.\n[render] # of the renderer\n\n  orders=2# tight\n# Between.\nbloom   =  0.5\t# tab\n[sky]\nstar_size = 2.0\n";
        let after = edit(text, &["render.orders=3", "render.bloom=0.25", "sky.star_size=1.5"]).expect("a text");
        let expected = text.replace("orders=2# tight", "orders=3# tight").replace("=  0.5\t", "=  0.25\t").replace("2.0", "1.5");
        assert_eq!(after, expected.replace("orders=3# tight", "orders=3 # tight"));
        // A key and a section that are not there yet.
        let after = edit(text, &["sky.faintest_magnitude=7", "disk.seed=5"]).expect("a text");
        assert!(
            after.starts_with(text) && after.contains("faintest_magnitude = 7.0 # fainter stars") && after.contains("[disk]\nseed = 5")
        );
        let after = edit("render = { orders = 2 }\n", &["render.orders=1"]).expect("a text");
        assert_eq!(after, "render = { orders = 1 }\n");
    }

    #[test]
    fn a_damaged_text_and_a_clash_are_said() {
        for text in ["[render", "[render]\norders = 9\n", "[rander]\n"] {
            let said = edit(text, &["render.orders=3"]).expect_err(text);
            assert!(said.starts_with("game.toml:"), "{said}");
        }
        let said = edit("", &["render.exposure_min=20"]).expect_err("a clash");
        assert!(said.contains("must be less than"), "{said}");
    }
}
