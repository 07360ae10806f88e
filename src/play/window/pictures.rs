//! Where the player's pictures go, and under which names. No picture is ever written over. In a page the browser puts them where it puts
//! what is loaded down.

#[cfg(not(target_family = "wasm"))]
use std::fs::{File, create_dir_all, remove_file, rename, write};
#[cfg(not(target_family = "wasm"))]
use std::io::{Error, ErrorKind};
#[cfg(not(target_family = "wasm"))]
use std::path::Path;
use std::path::PathBuf;
use web_time::{SystemTime, UNIX_EPOCH};

use crate::game_files::user_folder;

/// Names another folder than the user's own.
pub const FOLDER_VARIABLE: &str = "LENSRUNNER_PICTURES";

/// The folders that pictures may go to, the best first: the one that is named, else the user's for pictures, the game's for data, `out`.
pub fn folders() -> Vec<PathBuf> {
    if let Some(named) = std::env::var_os(FOLDER_VARIABLE).filter(|named| !named.is_empty()) {
        return vec![PathBuf::from(named)];
    }
    let own = directories::UserDirs::new().and_then(|folders| folders.picture_dir().map(|folder| folder.join("Lensrunner")));
    let data = user_folder().map(|folder| folder.join("pictures"));
    own.into_iter().chain(data).chain([PathBuf::from("out")]).collect()
}

/// `lensrunner-YYYY-MM-DD-HHMMSS`, in UTC.
pub fn stem(now: SystemTime) -> String {
    let seconds = now.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    let ([year, month, day], second) = (civil(seconds / 86_400), seconds % 86_400);
    format!("lensrunner-{year:04}-{month:02}-{day:02}-{:02}{:02}{:02}", second / 3600, second / 60 % 60, second % 60)
}

/// Year, month and day (both from 1) of a day counted from 1970-01-01, in the Gregorian calendar.
fn civil(days: u64) -> [u64; 3] {
    // Years that begin in March end with the leap day; 400 of them, from 0000-03-01 on, have 146,097 days. 719,468 days lie between that
    // day and 1970-01-01.
    let day = days + 719_468;
    let (era, of_era) = (day / 146_097, day % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    // Five months from March on, and from August on, have 153 days.
    let month = (5 * of_year + 2) / 153;
    let (date, month) = (of_year - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    [400 * era + year + u64::from(month <= 2), month, date]
}

/// Writes a file into the first of `folders` that takes it, under a name that nothing has yet; gives its path.
pub fn save_new(folders: &[PathBuf], stem: &str, extension: &str, bytes: &[u8]) -> std::io::Result<PathBuf> {
    #[cfg(target_family = "wasm")]
    return {
        _ = folders;
        let name = format!("{stem}.{extension}");
        crate::page::download(&name, bytes);
        Ok(name.into())
    };
    #[cfg(not(target_family = "wasm"))]
    save_file(folders, stem, extension, bytes)
}

#[cfg(not(target_family = "wasm"))]
fn save_file(folders: &[PathBuf], stem: &str, extension: &str, bytes: &[u8]) -> std::io::Result<PathBuf> {
    let mut fault = Error::new(ErrorKind::NotFound, "there is no folder for pictures");
    for folder in folders {
        match save_in(folder, stem, extension, bytes) {
            Ok(path) => return Ok(path),
            Err(error) => fault = Error::new(error.kind(), format!("{}: {error}", folder.display())),
        }
    }
    Err(fault)
}

#[cfg(not(target_family = "wasm"))]
fn save_in(folder: &Path, stem: &str, extension: &str, bytes: &[u8]) -> std::io::Result<PathBuf> {
    create_dir_all(folder)?;
    // The player may not know in which folder the game was started.
    let folder = std::path::absolute(folder)?;
    for count in 1..10_000 {
        let name = if count == 1 { stem.to_owned() } else { format!("{stem}-{count}") };
        let path = folder.join(format!("{name}.{extension}"));
        // Takes the name, whoever else writes pictures in this second.
        match File::create_new(&path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            taken => _ = taken?,
        }
        let beside = folder.join(format!("{name}.{extension}.new"));
        return match write(&beside, bytes).and_then(|()| rename(&beside, &path)) {
            Ok(()) => Ok(path),
            Err(error) => {
                _ = remove_file(&beside);
                _ = remove_file(&path);
                Err(error)
            }
        };
    }
    Err(Error::new(ErrorKind::AlreadyExists, "all names are taken"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn dates_are_those_of_the_calendar() {
        // By GNU date -u -d @SECONDS.
        for (seconds, date) in [
            (0, "1970-01-01-000000"),
            (951_782_399, "2000-02-28-235959"),
            (951_782_400, "2000-02-29-000000"),
            (951_868_800, "2000-03-01-000000"),
            (1_735_689_599, "2024-12-31-235959"),
            (1_767_225_600, "2026-01-01-000000"),
            (4_107_542_400, "2100-03-01-000000"),
        ] {
            assert_eq!(stem(UNIX_EPOCH + Duration::from_secs(seconds)), format!("lensrunner-{date}"));
        }
    }

    #[test]
    fn no_picture_is_written_over_and_another_folder_stands_in() {
        let folder = std::env::temp_dir().join(format!("lensrunner-pictures-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("a folder");
        // A file, in which no folder can be made.
        let file = folder.join("file");
        std::fs::write(&file, "x").expect("a file");
        let folders = [file.join("in"), folder.join("pictures")];
        let paths = [b"1", b"2", b"3"].map(|png| save_new(&folders, "a", "png", png).expect("a picture"));
        assert_eq!(paths.each_ref().map(|path| path.file_name().and_then(|name| name.to_str())), ["a.png", "a-2.png", "a-3.png"].map(Some));
        assert_eq!(paths.map(|path| std::fs::read(path).expect("it is there")), [b"1", b"2", b"3"]);
        assert_eq!(std::fs::read_dir(folder.join("pictures")).expect("a folder").count(), 3, "nothing is left beside");
        let said = save_new(&folders[..1], "a", "png", b"4").expect_err("no folder").to_string();
        assert!(said.contains("file"), "{said}");
        _ = std::fs::remove_dir_all(&folder);
    }
}
