//! Files that the game comes with: scenes, missions, replays, models, sky, tables. It imports no floor, and every floor may import it.
//!
//! A file is named as in the project's folder: `assets/scenes/chase.toml`. It is looked for in the user's folder, beside the program, in
//! the project's folder where the program is started in one, and last inside the program: the command line embeds them ([`embed`]); the
//! library alone has none.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

use crate::user_file::{self, FileFault};

/// Names another folder than the user's own.
pub const FOLDER_VARIABLE: &str = "LENSRUNNER_DATA";

/// A file inside the program: its name and its bytes.
pub type Inside = (&'static str, &'static [u8]);

static INSIDE: OnceLock<Vec<Inside>> = OnceLock::new();

/// Says which files are inside the program, before any is looked for.
pub fn embed(files: impl IntoIterator<Item = Inside>) {
    // Who calls twice has said it already.
    _ = INSIDE.set(files.into_iter().collect());
}

fn embedded() -> &'static [Inside] {
    INSIDE.get().map(Vec::as_slice).unwrap_or_default()
}

/// The user's folder that is named, else the user's own; None where there is none. Scores, replays and pictures are kept there too.
pub fn user_folder() -> Option<PathBuf> {
    let named = std::env::var_os(FOLDER_VARIABLE).filter(|named| !named.is_empty()).map(PathBuf::from);
    named.or_else(|| own_folder(|folders| folders.data_dir()))
}

/// One of the user's own folders; None where there is none. In a page it has a name and no place ([`user_file`]).
pub fn own_folder(which: fn(&directories::ProjectDirs) -> &Path) -> Option<PathBuf> {
    if cfg!(target_family = "wasm") {
        return Some("lensrunner".into());
    }
    directories::ProjectDirs::from("", "", "lensrunner").map(|folders| which(&folders).to_path_buf())
}

/// The project's folder: the one that the program is started in or one above it, or one that the program lies in.
fn project_folder() -> Option<PathBuf> {
    let is_project = |folder: &Path| folder.join("Cargo.toml").is_file() && folder.join("assets/scenes/chase.toml").is_file();
    let above = |path: std::io::Result<PathBuf>| path.ok().into_iter().flat_map(|path| folders_above(&path)).collect::<Vec<_>>();
    std::iter::once(PathBuf::from("."))
        .chain(above(std::env::current_dir()))
        .chain(above(std::env::current_exe()))
        .find(|folder| is_project(folder))
}

fn folders_above(path: &Path) -> Vec<PathBuf> {
    path.ancestors().skip(1).map(Path::to_path_buf).collect()
}

/// A file, found or not.
#[derive(Clone, Debug)]
pub struct GameFile {
    /// Where it is; its name where it is inside the program or nowhere.
    pub path: PathBuf,
    place: Place,
}

#[derive(Clone, Debug)]
enum Place {
    Disk,
    Inside(&'static [u8]),
    /// In none of these files.
    Nowhere(Vec<PathBuf>),
}

impl GameFile {
    /// The one at a path that a person names.
    pub fn at(path: &Path) -> GameFile {
        GameFile { path: path.to_path_buf(), place: Place::Disk }
    }

    /// Whether there is anything of that name; reading says if it is no file.
    pub fn is_there(&self) -> bool {
        match self.place {
            Place::Disk => user_file::exists(&self.path),
            Place::Inside(_) => true,
            Place::Nowhere(_) => false,
        }
    }

    /// The path, if it is not inside the program.
    pub fn on_disk(&self) -> Option<&Path> {
        Some(self.path.as_path()).filter(|path| matches!(self.place, Place::Disk) && user_file::exists(path))
    }

    /// All bytes, at most `most`.
    pub fn read(&self, most: u64) -> Result<Cow<'static, [u8]>, FileFault> {
        match &self.place {
            Place::Disk => user_file::read(&self.path, most).map(Cow::Owned),
            Place::Inside(bytes) => Ok(Cow::Borrowed(*bytes)),
            Place::Nowhere(tried) => Err(FileFault::Nowhere { tried: tried.clone() }),
        }
    }

    /// The text, of at most `most` bytes.
    pub fn read_text(&self, most: u64) -> Result<String, FileFault> {
        user_file::text_of(self.read(most)?.into_owned())
    }
}

/// The folders and files that are looked in, the first first.
struct Shelf<'a> {
    folders: Vec<PathBuf>,
    /// The project's folder, which is one of them.
    project: Option<PathBuf>,
    inside: &'a [Inside],
}

impl Shelf<'_> {
    fn of_this_program() -> Shelf<'static> {
        let beside = std::env::current_exe().ok().and_then(|program| program.parent().map(Path::to_path_buf));
        let project = project_folder();
        let folders = [user_folder(), beside, project.clone()].into_iter().flatten().collect();
        Shelf { folders, project, inside: embedded() }
    }

    fn bytes(&self, name: &str) -> Option<&'static [u8]> {
        self.inside.iter().find(|(known, _)| *known == name).map(|(_, bytes)| *bytes)
    }

    fn find(&self, name: &str) -> GameFile {
        let is_plain = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        let tried: Vec<PathBuf> = self.folders.iter().filter(|_| is_plain).map(|folder| folder.join(name)).collect();
        if let Some(path) = tried.iter().find(|path| user_file::exists(path)) {
            return GameFile::at(path);
        }
        let place = self.bytes(name).map_or(Place::Nowhere(tried), Place::Inside);
        GameFile { path: name.into(), place }
    }

    fn names(&self, folder: &str, ending: &str) -> Vec<String> {
        let with_ending = |path: &Path| {
            let named = path.extension().is_some_and(|found| found == ending).then(|| path.file_stem()).flatten();
            named.map(|stem| stem.to_string_lossy().into_owned())
        };
        let listed = self.folders.iter().filter_map(|place| std::fs::read_dir(place.join(folder)).ok()).flatten().flatten();
        let on_disk = listed.filter_map(|entry| with_ending(&entry.path()));
        let inside = self.inside.iter().map(|(name, _)| Path::new(name));
        let inside = inside.filter(|path| path.parent() == Some(Path::new(folder))).filter_map(with_ending);
        on_disk.chain(inside).collect::<BTreeSet<_>>().into_iter().collect()
    }

    fn is_own(&self, file: &GameFile) -> bool {
        let Some(path) = file.on_disk() else { return file.is_there() };
        let canonical = path.canonicalize().ok();
        let within = |root: &Path| Some(canonical.as_ref()?.strip_prefix(root.canonicalize().ok()?).ok()?.to_path_buf());
        if self.project.as_deref().and_then(within).is_some_and(|name| name.starts_with("assets")) {
            return true;
        }
        // Unpacked from the program, and not changed.
        let same = |name: PathBuf| {
            let bytes = self.bytes(&name.to_string_lossy().replace('\\', "/"))?;
            user_file::read(path, bytes.len() as u64).ok().filter(|found| found == bytes)
        };
        self.folders.iter().find_map(|folder| within(folder)).and_then(same).is_some()
    }
}

/// Looks for a file by its name, with `/` between its parts.
pub fn find(name: &str) -> GameFile {
    Shelf::of_this_program().find(name)
}

/// The file inside the program, whatever lies in the folders.
pub fn inside(name: &str) -> Option<GameFile> {
    let bytes = embedded().iter().find(|(known, _)| *known == name)?.1;
    Some(GameFile { path: name.into(), place: Place::Inside(bytes) })
}

/// The file of a scene, mission or replay: by path (anything that ends in `.toml` or holds a separator), or by name in the first of
/// `folders` that has it, else in the first.
pub fn named(folders: &[&str], name_or_path: &str) -> GameFile {
    if name_or_path.ends_with(".toml") || name_or_path.contains(['/', '\\']) {
        return GameFile::at(Path::new(name_or_path));
    }
    let shelf = Shelf::of_this_program();
    let mut files = folders.iter().map(|folder| shelf.find(&format!("{folder}/{name_or_path}.toml")));
    let first = files.next().unwrap_or_else(|| GameFile::at(Path::new(name_or_path)));
    if first.is_there() { first } else { files.find(GameFile::is_there).unwrap_or(first) }
}

/// The names, without `.toml`, of all files in a folder such as `assets/scenes`, wherever they are; sorted.
pub fn names(folder: &str) -> Vec<String> {
    Shelf::of_this_program().names(folder, "toml")
}

/// Whether a file is the game's own as it is: inside the program or equal to what is there, or of the project's folder.
pub fn is_own(file: &GameFile) -> bool {
    Shelf::of_this_program().is_own(file)
}

/// Where a file lies or, if it is on no disk yet, is to be written: in the project's folder if there is one, else in the user's.
pub fn place_of(name: &str) -> PathBuf {
    let found = find(name);
    found.on_disk().map(Path::to_path_buf).unwrap_or_else(|| {
        let folder = project_folder().or_else(user_folder);
        folder.unwrap_or_default().join(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: &[Inside] = &[("assets/scenes/a.toml", b"inside"), ("assets/scenes/b.toml", b"inside"), ("tables/a.lut", b"table")];

    /// The user's folder, the one beside the program, and the project's.
    fn shelf(name: &str) -> (PathBuf, Shelf<'static>) {
        let root = std::env::temp_dir().join(format!("lensrunner-game-files-{name}-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&root);
        let folders: Vec<PathBuf> = ["user", "beside", "project"].map(|folder| root.join(folder)).into();
        folders.iter().for_each(|folder| std::fs::create_dir_all(folder.join("assets/scenes")).expect("a folder"));
        (root, Shelf { project: Some(folders[2].clone()), folders, inside: FILES })
    }

    fn text(file: &GameFile) -> String {
        file.read_text(100).unwrap_or_else(|fault| fault.to_string())
    }

    #[test]
    fn the_users_file_goes_before_the_programs() {
        let (root, shelf) = shelf("order");
        let write = |folder: &str, name: &str| std::fs::write(root.join(folder).join("assets/scenes").join(name), folder).expect("a file");
        assert_eq!(text(&shelf.find("assets/scenes/a.toml")), "inside");
        for folder in ["project", "beside", "user"] {
            write(folder, "a.toml");
            assert_eq!(text(&shelf.find("assets/scenes/a.toml")), folder);
        }
        write("user", "mine.toml");
        write("user", "mine.txt");
        assert_eq!(shelf.names("assets/scenes", "toml"), ["a", "b", "mine"]);
        let own = |name: &str| shelf.is_own(&shelf.find(name));
        assert_eq!(["a", "b", "mine"].map(|name| own(&format!("assets/scenes/{name}.toml"))), [false, true, false]);
        // A copy of what is inside is the game's; what stands in the project is.
        std::fs::write(root.join("user/assets/scenes/a.toml"), "inside").expect("a file");
        assert!(own("assets/scenes/a.toml") && shelf.is_own(&GameFile::at(&root.join("project/assets/scenes/a.toml"))));
        _ = std::fs::remove_dir_all(&root);
    }

    #[test]
    fn what_is_nowhere_says_where_it_was_looked_for() {
        let (root, shelf) = shelf("nowhere");
        let missing = shelf.find("assets/scenes/c.toml");
        let said = text(&missing);
        assert!(!missing.is_there() && missing.on_disk().is_none());
        for folder in ["user", "beside", "project"] {
            assert!(said.contains(&root.join(folder).join("assets/scenes/c.toml").display().to_string()), "{said}");
        }
        assert!(said.contains("inside the program"), "{said}");
        std::fs::write(root.join("secret.toml"), "s").expect("a file");
        for name in ["../secret.toml", "assets/../../secret.toml", "/etc/hostname"] {
            assert!(!shelf.find(name).is_there(), "{name}");
        }
        _ = std::fs::remove_dir_all(&root);
    }
}
