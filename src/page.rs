//! What a page's JavaScript does for the game (`page/static/page.js`). It imports no floor, and every floor may import it.

use wasm_bindgen::prelude::wasm_bindgen;

/// A panic ends the game with the page's sentence.
pub fn say_panics() {
    std::panic::set_hook(Box::new(|panic| ended(&panic.to_string())));
}

#[wasm_bindgen(js_namespace = lensrunner)]
extern "C" {
    /// Sends what is heard to the thread that makes the sound: the numbers of [`crate::play::sound::sent`].
    pub fn sound(numbers: &[f64]);

    /// Goes on once the page has done what waited.
    pub async fn breath();

    /// The first frame is there: what was shown while the page loaded goes.
    pub fn begun();

    /// Whether the first thing that points here is a finger.
    pub fn by_finger() -> bool;

    /// What moves the game from now on: `keyboard`, `pad`, `touch`.
    pub fn hands(name: &str);

    /// A scene is drawn from now on.
    pub fn drawn();

    /// This screen is shown from now on: `title`, `playing`, `paused`, `result`, `photo`, `warning`; `won` after a flight that was;
    /// `watched` while one is shown that was flown before.
    pub fn screen(name: &str, won: bool, watched: bool);

    /// The game cannot go on, for this reason: the page says so, and what can be done.
    pub fn ended(why: &str);

    /// Puts the page's address with this end where the player can paste it from.
    pub fn share(link: &str);

    /// Gives the player all that the browser keeps as one file.
    pub fn save_all();

    /// Asks the player for such a file, and begins anew with it.
    pub fn bring_all();

    /// Gives the player a file to keep where the browser keeps what is loaded down.
    pub fn download(name: &str, bytes: &[u8]);
}
