//! Random numbers that a shader can make too: integer hashes, so that every method draws the same aurora.

/// One round of PCG's output permutation on a counter (`pcg` of Jarzynski & Olano 2020). Twin: `hash` in shaders/gpu/random.wgsl.
pub fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A number in [0, 1) with 24 bits, from three counters: seed, particle and step. In shaders it is `unit` of a nested `hash`
/// (shaders/gpu/random.wgsl).
pub fn uniform(seed: u32, particle: u32, step: u32) -> f32 {
    (hash(step.wrapping_add(hash(particle.wrapping_add(hash(seed))))) >> 8) as f32 * (1.0 / 16_777_216.0)
}
