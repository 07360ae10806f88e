//! Scenes and missions, flown for some steps.
#![no_main]

use lensrunner::scene::model::texture;
use lensrunner_fuzz::{doors, mutate};

libfuzzer_sys::fuzz_target!(
    init: {
        // Made once, which takes longer than any file may.
        texture::galaxy();
    },
    |bytes: &[u8]| doors::knock("scene", bytes)
);
libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| { mutate::text(data, size, most, seed) });
