//! The files inside the program: all that the game reads while it runs (`tests/package.rs` compares them with the folders).
//!
//! They are in the command line's program, not in the library: a scene can be edited without compiling the library again. The table is
//! no part of them: a page loads it packed.

use lensrunner::game_files::Inside;

/// Each name with the bytes of the file.
macro_rules! inside {
    ($($name:literal,)*) => {
        &[$(($name, include_bytes!(concat!("../", $name)))),*]
    };
}

/// The files.
pub const FILES: &[Inside] = inside![
    "assets/missions/01-training.toml",
    "assets/missions/02-first-pursuit.toml",
    "assets/missions/03-through-the-disk.toml",
    "assets/missions/04-the-ghost.toml",
    "assets/missions/05-the-last-orbit.toml",
    "assets/missions/06-the-long-shot.toml",
    "assets/missions/07-arrive-young.toml",
    "assets/missions/08-hunted.toml",
    "assets/missions/09-two-of-them.toml",
    "assets/missions/10-no-way-back.toml",
    "assets/models/hunter.glb",
    "assets/models/quarry.glb",
    "assets/replays/01-training-expert.toml",
    "assets/replays/01-training-naive.toml",
    "assets/replays/02-first-pursuit-expert.toml",
    "assets/replays/02-first-pursuit-naive.toml",
    "assets/replays/03-through-the-disk-expert.toml",
    "assets/replays/03-through-the-disk-naive.toml",
    "assets/replays/04-the-ghost-expert.toml",
    "assets/replays/04-the-ghost-naive.toml",
    "assets/replays/05-the-last-orbit-expert.toml",
    "assets/replays/05-the-last-orbit-naive.toml",
    "assets/replays/06-the-long-shot-expert.toml",
    "assets/replays/06-the-long-shot-naive.toml",
    "assets/replays/07-arrive-young-expert.toml",
    "assets/replays/07-arrive-young-naive.toml",
    "assets/replays/08-hunted-expert.toml",
    "assets/replays/08-hunted-naive.toml",
    "assets/replays/09-two-of-them-expert.toml",
    "assets/replays/09-two-of-them-naive.toml",
    "assets/replays/10-no-way-back-expert.toml",
    "assets/replays/10-no-way-back-naive.toml",
    "assets/scenes/aurora-below.toml",
    "assets/scenes/aurora-lensed.toml",
    "assets/scenes/aurora-orbit.toml",
    "assets/scenes/aurora-side.toml",
    "assets/scenes/chase.toml",
    "assets/scenes/disk-0.toml",
    "assets/scenes/disk-30.toml",
    "assets/scenes/disk-60.toml",
    "assets/scenes/disk-80.toml",
    "assets/scenes/disk-far.toml",
    "assets/scenes/disk-inner.toml",
    "assets/scenes/disk-skim.toml",
    "assets/scenes/disk.toml",
    "assets/scenes/galaxy-20000.toml",
    "assets/scenes/galaxy-axis-edge.toml",
    "assets/scenes/galaxy-axis-vertex.toml",
    "assets/scenes/galaxy-axis.toml",
    "assets/scenes/galaxy.toml",
    "assets/scenes/parade.toml",
    "assets/scenes/plunge.toml",
    "assets/scenes/ring.toml",
    "assets/scenes/swarm.toml",
    "assets/sky/milky-way.png",
    "assets/sky/stars.bin",
];
