//! Moments of a flight.
#![no_main]

use lensrunner_fuzz::{mutate, untrusted_input};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| untrusted_input::check("moment", bytes));
libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| { mutate::moment(data, size, most, seed) });
