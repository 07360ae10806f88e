//! The game in a page: what `src/main.rs` is on a desk.
#![cfg(target_family = "wasm")]

#[path = "../../src/inside.rs"]
mod inside;
mod picture;

use std::path::Path;

use lensrunner::breath::breath;
use lensrunner::lensing::table::packed;
use lensrunner::play::session::Session;
use lensrunner::play::window::{Options, prepared};
use lensrunner::render::gpu::shaders;
use lensrunner::scene::Difficulty;
use lensrunner::scene::config::Assignment;
use lensrunner::sim::replay::Replay;
use lensrunner::sim::replay::link::MARK;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

/// The table's name among the game's files.
const TABLE: &str = "tables/default.lut";

/// Keys that are the browser's own with others in `game.toml`: Ctrl with W would close the page, and F12 opens the browser's tools.
const KEYS: [&str; 2] = ["controls.thrust_down=KeyX PadLeftBumper", "controls.screenshot=F4"];

/// Begins the game on the element `#game`, with what [`pack`] and [`written_shaders`] gave. Fails with a sentence if these, or its own files,
/// are not as they were built. `address`: the end of the page's, which may be a flight to show.
#[wasm_bindgen]
pub async fn play(table: Vec<u8>, shaders: String, address: String) -> Result<(), JsError> {
    bring(&table, &shaders)?;
    breath().await;
    let mut options = Options::default();
    if address.contains(MARK) {
        let flight = Replay::from_link(&address).and_then(|replay| replay.scene(Path::new("the link"), None).map(|_| replay));
        // The title is there all the same.
        options.replay = flight.ok();
        options.refused_link = options.replay.is_none();
    }
    let scene = options.replay.as_ref().map(|replay| replay.scene.as_str());
    let mut session = Session::load(None, scene, None)?;
    session.difficulty = Difficulty::Easy;
    for keys in KEYS.iter().filter(|_| session.config_file.is_none()) {
        keys.parse::<Assignment>().map_err(|error| JsError::new(&error))?.apply(&mut session.config);
    }
    if let Some(replay) = &options.replay {
        (session.difficulty, session.seed) = (replay.difficulty, replay.seed);
    }
    // It goes on after this: the page calls it for each frame.
    breath().await;
    prepared(session, &options).await.run();
    Ok(())
}

/// The game's own files, once.
fn bring(table: &[u8], shaders: &str) -> Result<(), JsError> {
    lensrunner::page::say_panics();
    let table = packed::unpack(table).ok_or_else(|| JsError::new("the table is damaged"))?;
    let table: &'static [u8] = table.leak();
    lensrunner::game_files::embed(inside::FILES.iter().copied().chain([(TABLE, table)]));
    shaders::bring(serde_json::from_str(shaders)?);
    Ok(())
}

/// The bytes of the table's file, packed. Asked when the page is made.
#[wasm_bindgen]
pub fn pack(table: &[u8]) -> Result<Vec<u8>, JsError> {
    packed::pack(table).ok_or_else(|| JsError::new("it is no table"))
}

/// The texts of all shaders, as JSON. Asked when the page is made.
#[wasm_bindgen]
pub fn written_shaders() -> Result<String, JsError> {
    lensrunner::page::say_panics();
    Ok(serde_json::to_string(&shaders::written())?)
}
