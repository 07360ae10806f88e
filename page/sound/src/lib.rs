//! The mixer for an AudioWorklet (`page/static/sound.js`): what goes in and out are numbers alone, so that it needs nothing of the page.
#![cfg(target_family = "wasm")]

use std::cell::RefCell;

use lensrunner::play::sound::mixer::Mixer;
use lensrunner::play::sound::sent;
use wasm_bindgen::prelude::wasm_bindgen;

/// Samples that a worklet makes at once.
const BLOCK: usize = 128;

struct Player {
    mixer: Mixer,
    numbers: [f64; sent::COUNT],
    block: [[f32; 2]; BLOCK],
}

thread_local! {
    static PLAYER: RefCell<Option<Player>> = const { RefCell::new(None) };
}

fn with<T: Default>(act: impl FnOnce(&mut Player) -> T) -> T {
    PLAYER.with_borrow_mut(|player| player.as_mut().map(act)).unwrap_or_default()
}

/// Begins at so many samples a second, silent.
#[wasm_bindgen]
pub fn begin(rate: u32) {
    let player = Player { mixer: Mixer::new(rate), numbers: [0.0; sent::COUNT], block: [[0.0; 2]; BLOCK] };
    PLAYER.set(Some(player));
}

/// One of the numbers of what is heard; it counts from [`hear`] on.
#[wasm_bindgen]
pub fn number(place: usize, value: f64) {
    with(|player| {
        if let Some(number) = player.numbers.get_mut(place) {
            *number = value;
        }
    });
}

/// The numbers count from now on.
#[wasm_bindgen]
pub fn hear() {
    with(|player| {
        let (heard, volumes) = sent::read(&player.numbers);
        player.mixer.set(&heard, &volumes);
    });
}

/// Makes the next samples, 128 times left and right as f32, and says where they are.
#[wasm_bindgen]
pub fn fill() -> usize {
    with(|player| {
        player.mixer.fill(&mut player.block);
        player.block.as_ptr() as usize
    })
}
