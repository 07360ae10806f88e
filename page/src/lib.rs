//! The game in a page: what `src/main.rs` is on a desk.
#![cfg(target_family = "wasm")]

#[path = "../../src/inside.rs"]
mod inside;

use lensrunner::play::session::Session;
use lensrunner::play::window::{Options, run};
use lensrunner::scene::Difficulty;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Begins the game on the element `#game`. Fails with a sentence if its own files are not as they were built.
#[wasm_bindgen]
pub fn play() -> Result<(), JsValue> {
    console_error_panic_hook::set_once();
    lensrunner::game_files::embed(inside::FILES);
    let mut session = Session::load(None, None, None).map_err(|error| JsValue::from_str(&error.to_string()))?;
    session.difficulty = Difficulty::Easy;
    // It goes on after this: the page calls it for each frame.
    run(session, &Options::default());
    Ok(())
}
