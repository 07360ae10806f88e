#define_import_path lensrunner::gpu::random

// Random numbers by hashing (`pcg` of Jarzynski & Olano 2020): the twins of scene::aurora::random.

/// Twin of scene::aurora::random::hash.
fn hash(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn unit(bits: u32) -> f32 {
    return f32(bits >> 8u) * (1.0 / 16777216.0);
}
