//! A fingerprint of the simulation's state, for replays.

use crate::spacetime::matter::ShipState;

/// FNV-1a, 64 bits (Fowler, Noll, Vo), over bytes and over the bits of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateHash(pub u64);

impl Default for StateHash {
    fn default() -> Self {
        StateHash(0xcbf2_9ce4_8422_2325)
    }
}

impl StateHash {
    /// Adds bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Adds the bits of a number; −0 and 0 differ.
    pub fn number(&mut self, x: f64) {
        self.bytes(&x.to_bits().to_le_bytes());
    }

    /// Adds a ship.
    pub fn ship(&mut self, name: &str, state: &ShipState) {
        self.bytes(name.as_bytes());
        let ShipState { position, momentum, attitude, proper_time } = state;
        for x in position.to_array().into_iter().chain(momentum.to_array()).chain(attitude.to_array()).chain([*proper_time]) {
            self.number(x);
        }
    }
}

impl std::fmt::Display for StateHash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
