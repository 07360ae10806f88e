//! What several tests need.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, LazyLock};

use lensrunner::lensing::{Scheme, Table};
use proptest::test_runner::{Config, RngSeed};

/// Properties are tried on the same `cases` on every machine and every day: CI never turns red by chance.
pub fn fixed(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(20_261_121), failure_persistence: None, ..Config::default() }
}

/// The project's folder. Asked at run time: tests that were built in another copy of the project read this one's files.
pub fn root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("."), PathBuf::from);
    if package.ends_with("lab") { package.join("..") } else { package }
}

/// A folder of its own for one test, removed at its end.
pub struct Folder(PathBuf);

impl Folder {
    /// Makes it.
    pub fn new() -> Folder {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let name = format!("lensrunner-test-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder left behind harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The committed table, loaded once for all tests of a binary.
static TABLE: LazyLock<Arc<Table>> =
    LazyLock::new(|| Arc::new(Table::load(&root().join("tables/default.lut"), Scheme::Residual).expect("the committed table")));

/// The committed table.
pub fn table() -> &'static Table {
    &TABLE
}

/// The same for a renderer, which keeps it.
pub fn shared_table() -> Arc<Table> {
    TABLE.clone()
}
