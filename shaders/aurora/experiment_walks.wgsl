// The walks of the aurora's experiment, one thread per electron: the particle method in space, and the exact walk on the screen. What is dealt out and drawn at
// random is that of src/measure/aurora/walk.rs.

@group(0) @binding(0) var<uniform> frame: Experiment;
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
@group(0) @binding(2) var<storage, read> electrons: array<Electron>;
/// Heights, ways astray and air overhead of each level; reach and the level where all is spent of each row; what is spent above each level by row.
@group(0) @binding(3) var<storage, read> tables: array<f32>;
/// Apparent places on the lattice.
@group(0) @binding(4) var<storage, read> nodes: array<vec4<f32>>;
/// x, y: pixels, z: pixels per km (bits of floats), w: level and, from the 8th bit on, collisions.
@group(0) @binding(5) var<storage, read_write> points: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read_write> draws: array<atomic<u32>>;

const ROWS: u32 = 512u;
const FIRST_SWAY: u32 = 160u;
const FIRST_OVERHEAD: u32 = 320u;
const FIRST_REACH: u32 = 480u;
const FIRST_STOP: u32 = 992u;
const FIRST_SPENT: u32 = 1504u;
/// 1/1.75: scene::aurora::fall.
const ENERGY_POWER: f32 = 0.5714286;

/// Two numbers in [−1, 1) for the way astray at a level, times how far that is.
fn astray(key: u32, level: u32) -> vec2<f32> {
    let bits = hash(key + level + 1u);
    return (vec2<f32>(f32(bits >> 16u), f32(bits & 65535u)) / 32768.0 - 1.0) * tables[FIRST_SWAY + level];
}

/// Adds a point at an apparent place, if that is before the camera.
fn add(seen: vec3<f32>, level: u32, count: u32) {
    let depth = -seen.z;
    if !(depth > frame.various.x) {
        return;
    }
    let inverse = frame.screen.z / depth;
    let slot = atomicAdd(&draws[1], 1u);
    if slot < arrayLength(&points) {
        let place = vec3<f32>(frame.screen.x + inverse * seen.x, frame.screen.y - inverse * seen.y, inverse * frame.screen.w);
        points[slot] = vec4<u32>(bitcast<vec3<u32>>(place), level | (count << 8u));
    }
}

fn key_of(electron: Electron) -> u32 {
    return hash(electron.numbers.y + hash(frame.cells.w));
}

@compute @workgroup_size(64)
fn particles(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&electrons) {
        return;
    }
    let electron = electrons[id.x];
    let key = key_of(electron);
    let u = unit(key);
    let along = (electron.end.xyz - electron.top.xyz) / (TOP - electron.top.w);
    let reach = tables[FIRST_REACH + electron.numbers.x];
    var before = 0u;
    for (var level = 0u; level < LEVELS; level++) {
        let left = pow(max(1.0 - tables[FIRST_OVERHEAD + level] / reach, 0.0), ENERGY_POWER);
        let now = u32((1.0 - left) * electron.end.w + u);
        if now > before {
            let away = astray(key, level);
            let position = electron.top.xyz + along * (TOP - tables[level]) + frame.across[0].xyz * away.x + frame.across[1].xyz * away.y;
            add(apparent(position), level, now - before);
            before = now;
        }
        if left <= 0.0 {
            break;
        }
    }
}

/// Apparent place of the field line through `top` at the upper end of chord `k`.
fn chord_end(top: vec2<f32>, k: u32) -> vec3<f32> {
    let cells = frame.cells.xy;
    let p = (top - frame.lattice.xy) * frame.lattice.zw;
    let cell = min(vec2<u32>(max(p, vec2<f32>(0.0))), cells - 1u);
    let s = p - vec2<f32>(cell);
    let row = (k * (cells.y + 1u) + cell.y) * (cells.x + 1u) + cell.x;
    let low = mix(nodes[row].xyz, nodes[row + 1u].xyz, s.x);
    let high = mix(nodes[row + cells.x + 1u].xyz, nodes[row + cells.x + 2u].xyz, s.x);
    return mix(low, high, s.y);
}

@compute @workgroup_size(64)
fn exact(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&electrons) {
        return;
    }
    let electron = electrons[id.x];
    let key = key_of(electron);
    let u = unit(key);
    let chords = frame.cells.z;
    let height = (TOP - frame.various.z) / f32(chords);
    let stop = u32(tables[FIRST_STOP + electron.numbers.x]);
    let spent = FIRST_SPENT + electron.numbers.x * (LEVELS + 1u);
    // No chord as yet.
    var chord = 0xffffffffu;
    var start = vec3<f32>(0.0);
    var down = vec3<f32>(0.0);
    var before = u32(tables[spent] * electron.end.w + u);
    for (var level = 0u; level < stop; level++) {
        let now = u32(tables[spent + level + 1u] * electron.end.w + u);
        if now > before {
            let fallen = TOP - tables[level];
            let k = min(u32(fallen / height), chords - 1u);
            if k != chord {
                chord = k;
                start = chord_end(electron.top.xy, k);
                down = (chord_end(electron.top.xy, k + 1u) - start) / height;
            }
            let away = astray(key, level);
            let seen = start + down * (fallen - height * f32(k)) + frame.across_seen[0].xyz * away.x + frame.across_seen[1].xyz * away.y;
            add(seen, level, now - before);
            before = now;
        }
    }
}
