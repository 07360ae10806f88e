// The walks of the aurora's experiment, one thread per electron: the particle method in space, and the exact walk on the screen. What is
// dealt out and drawn at random is that of lab/src/aurora/walk.rs.

#import lensrunner::gpu::bindings::{frame, TABLE_ROW}
#import lensrunner::gpu::random::{hash, unit}
#import lensrunner_lab::aurora::experiment::{Electron, LEVELS, TOP}
#import lensrunner_lab::aurora::eye::apparent

@group(0) @binding(2) var<storage, read> electrons: array<Electron>;
/// x, y: height of each level and way astray there, km, z: air overhead, g cm⁻², w: the chord that the level lies in.
@group(0) @binding(3) var<uniform> air: array<vec4<f32>, LEVELS>;
/// For each row of the table of falls the shares of the energy spent above the level below each, four a texel, and one texel with x: the
/// row's reach, y: the level where all is spent.
@group(0) @binding(4) var falls: texture_2d<f32>;
/// Apparent places on the lattice.
@group(0) @binding(5) var nodes: texture_2d<f32>;
/// x, y: pixels, z: pixels per km (bits of floats), w: level and, from the 8th bit on, collisions.
@group(0) @binding(6) var<storage, read_write> points: array<vec4<u32>>;
/// How the points are drawn; second their number.
@group(0) @binding(7) var<storage, read_write> draws: array<atomic<u32>>;

/// Levels of a texel, and texels of a row of the table of falls.
const FOUR: u32 = 4u;
const ROW: u32 = LEVELS / FOUR + 1u;
/// 1/1.75: scene::aurora::fall.
const ENERGY_POWER: f32 = 0.5714286;

fn texel(table: texture_2d<f32>, k: u32) -> vec4<f32> {
    return textureLoad(table, vec2<u32>(k % TABLE_ROW, k / TABLE_ROW), 0);
}

/// Two numbers in [−1, 1) for the way astray at a level. Through i32, for which processors have an instruction.
fn astray(key: u32, level: u32) -> vec2<f32> {
    let bits = hash(key + level + 1u);
    return vec2<f32>(vec2<i32>(vec2<u32>(bits >> 16u, bits & 65535u))) / 32768.0 - 1.0;
}

/// A point at an apparent place.
fn point_at(seen: vec3<f32>, screen: vec4<f32>, level: u32, count: u32) -> vec4<u32> {
    let inverse = screen.z / -seen.z;
    let place = vec3<f32>(screen.x + inverse * seen.x, screen.y - inverse * seen.y, inverse * screen.w);
    return vec4<u32>(bitcast<vec3<u32>>(place), level | (count << 8u));
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
    let reach = texel(falls, electron.numbers.x * ROW + LEVELS / FOUR).x;
    // What does not change is read here: a software driver reads a uniform anew in every step.
    let across = array<vec3<f32>, 2>(frame.across[0].xyz, frame.across[1].xyz);
    let screen = frame.screen;
    let near = frame.various.x;
    var before = 0u;
    for (var level = 0u; level < LEVELS; level++) {
        let here = air[level];
        let left = pow(max(1.0 - here.z / reach, 0.0), ENERGY_POWER);
        let now = u32((1.0 - left) * electron.end.w + u);
        if now > before {
            let away = astray(key, level) * here.y;
            let position = electron.top.xyz + along * (TOP - here.x) + across[0] * away.x + across[1] * away.y;
            let seen = apparent(position);
            if -seen.z > near {
                let slot = atomicAdd(&draws[1], 1u);
                if slot < arrayLength(&points) {
                    points[slot] = point_at(seen, screen, level, now - before);
                }
            }
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
    let low = mix(texel(nodes, row).xyz, texel(nodes, row + 1u).xyz, s.x);
    let high = mix(texel(nodes, row + cells.x + 1u).xyz, texel(nodes, row + cells.x + 2u).xyz, s.x);
    return mix(low, high, s.y);
}

/// Levels with collisions: bit b of word w is level 32 w + b.
alias Levels = array<u32, 5>;

/// The 32 levels from `first` on at which there are collisions. `above` are the collisions above the first, and then above the last's end.
fn dealt(row: u32, first: u32, stop: u32, share: vec2<f32>, above: ptr<function, i32>) -> u32 {
    var found = 0u;
    for (var k = 0u; k < 32u && first + k < stop; k += FOUR) {
        let below = vec4<i32>(texel(falls, row + (first + k) / FOUR) * share.x + share.y);
        let some = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), below > vec4<i32>(*above, below.xyz));
        *above = below.w;
        found |= (some.x | some.y | some.z | some.w) << k;
    }
    return found;
}

/// The highest of the levels, which is taken away from them.
fn take(levels: ptr<function, Levels>) -> u32 {
    var first = 0u;
    var word = (*levels)[0];
    if word == 0u {
        word = (*levels)[1];
        first = 32u;
    }
    if word == 0u {
        word = (*levels)[2];
        first = 64u;
    }
    if word == 0u {
        word = (*levels)[3];
        first = 96u;
    }
    if word == 0u {
        word = (*levels)[4];
        first = 128u;
    }
    let rest = word & (word - 1u);
    (*levels)[0] = select((*levels)[0], rest, first == 0u);
    (*levels)[1] = select((*levels)[1], rest, first == 32u);
    (*levels)[2] = select((*levels)[2], rest, first == 64u);
    (*levels)[3] = select((*levels)[3], rest, first == 96u);
    (*levels)[4] = select((*levels)[4], rest, first == 128u);
    return min(first + firstTrailingBit(word), LEVELS - 1u);
}

/// Levels with collisions are found first. So the points' places are reserved at once, and there is work for every thread in each step: in
/// steps from level to level three threads of four would wait for the others. Points that are not before the camera have no light.
@compute @workgroup_size(64)
fn exact(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&electrons) {
        return;
    }
    let electron = electrons[id.x];
    let key = key_of(electron);
    let share = vec2<f32>(electron.end.w, unit(key));
    let row = electron.numbers.x * ROW;
    let stop = u32(texel(falls, row + LEVELS / FOUR).y);
    var levels: Levels;
    var above = 0i;
    levels[0] = dealt(row, 0u, stop, share, &above);
    levels[1] = dealt(row, 32u, stop, share, &above);
    levels[2] = dealt(row, 64u, stop, share, &above);
    levels[3] = dealt(row, 96u, stop, share, &above);
    levels[4] = dealt(row, 128u, stop, share, &above);
    let counts = countOneBits(vec4<u32>(levels[0], levels[1], levels[2], levels[3]));
    let count = counts.x + counts.y + counts.z + counts.w + countOneBits(levels[4]);
    var slot = atomicAdd(&draws[1], count);
    let end = min(slot + count, arrayLength(&points));
    let across = array<vec3<f32>, 2>(frame.across_seen[0].xyz, frame.across_seen[1].xyz);
    let screen = frame.screen;
    let near = frame.various.x;
    let chords = frame.cells.z;
    let height = (TOP - frame.various.z) / f32(chords);
    var before = 0i;
    var level = take(&levels);
    var here = air[level];
    var start = chord_end(electron.top.xy, 0u);
    for (var chord = 0u; chord < chords; chord++) {
        let next = chord_end(electron.top.xy, chord + 1u);
        let down = (next - start) / height;
        let high = TOP - height * f32(chord);
        let last = f32(chord);
        while slot < end && here.w <= last {
            let four = texel(falls, row + level / FOUR);
            let lane = level % FOUR;
            let below = select(select(four.x, four.y, lane == 1u), select(four.z, four.w, lane == 3u), lane >= 2u);
            let now = i32(below * share.x + share.y);
            let away = astray(key, level) * here.y;
            let seen = start + down * (high - here.x) + across[0] * away.x + across[1] * away.y;
            points[slot] = select(vec4<u32>(0u), point_at(seen, screen, level, u32(now - before)), -seen.z > near);
            slot++;
            before = now;
            level = take(&levels);
            here = air[level];
        }
        start = next;
    }
}
