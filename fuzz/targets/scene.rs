//! Scenes and missions, flown for some steps.
#![no_main]

use lensrunner::scene::model::texture;
use lensrunner_fuzz::{mutate, untrusted_input};

libfuzzer_sys::fuzz_target!(
    init: {
        // Made once, which takes longer than any file may.
        texture::galaxy();
    },
    |bytes: &[u8]| untrusted_input::check("scene", bytes)
);
libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| { mutate::text(data, size, most, seed) });
