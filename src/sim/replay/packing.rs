//! The records of a replay, and how they are packed: column by column, then DEFLATE.

use std::io::Read as _;

use flate2::{Compression, read::ZlibDecoder, read::ZlibEncoder};

use crate::sim::assist::AssistMode;
use crate::sim::player_commands::PlayerCommands;

/// The most bytes of a file, and of its records unpacked: hours of flight.
pub(super) const MOST_BYTES: u64 = 16 << 20;

/// The player's commands from a step on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// The step, counted from 0.
    pub tick: u64,
    /// From then on.
    pub commands: PlayerCommands,
}

/// Bytes of a record besides its step and pace: six sticks, seven switches.
const COLUMNS: usize = 7;

/// The bits of a pace that come in steps: sign, exponent and four of the rest.
const PACE_BITS: u32 = 16;

/// Packs records column by column. Sticks are as they are: a hand has some ways of its own that come again.
pub(super) fn pack(records: &[Record]) -> Vec<u8> {
    let mut raw = Vec::new();
    raw.extend((records.len() as u64).to_le_bytes());
    let mut before = 0u64;
    for record in records {
        varint(&mut raw, record.tick.wrapping_sub(before));
        before = record.tick;
    }
    for column in 0..COLUMNS {
        raw.extend(records.iter().map(|record| bytes_of(&record.commands)[column]));
    }
    let mut before = 0u64;
    for record in records {
        let bits = record.commands.pace.to_bits();
        // The few bits of a pace are the high ones.
        varint(&mut raw, (bits ^ before).rotate_left(PACE_BITS));
        before = bits;
    }
    let mut packed = Vec::new();
    // Reading from memory does not fail.
    _ = ZlibEncoder::new(&raw[..], Compression::best()).read_to_end(&mut packed);
    packed
}

/// The records of a log; None if it is damaged.
pub(super) fn unpack(packed: &[u8]) -> Option<Vec<Record>> {
    let mut raw = Vec::new();
    ZlibDecoder::new(packed).take(MOST_BYTES).read_to_end(&mut raw).ok()?;
    let count = usize::try_from(u64::from_le_bytes(raw.get(..8)?.try_into().ok()?)).ok()?;
    // Each takes a byte a column at least, and two for step and pace.
    if count > raw.len() / (COLUMNS + 2) {
        return None;
    }
    let mut rest = &raw[8..];
    let mut tick = 0u64;
    let mut ticks = Vec::with_capacity(count);
    for _ in 0..count {
        tick = tick.checked_add(read_varint(&mut rest)?)?;
        ticks.push(tick);
    }
    let (columns, mut rest) = rest.split_at_checked(COLUMNS * count)?;
    let mut bits = 0u64;
    let mut records = Vec::with_capacity(count);
    for (row, &tick) in ticks.iter().enumerate() {
        bits ^= read_varint(&mut rest)?.rotate_right(PACE_BITS);
        let pace = f64::from_bits(bits);
        if !(pace > 0.0 && pace.is_finite()) {
            return None;
        }
        let bytes = std::array::from_fn(|column| columns[column * count + row]);
        records.push(Record { tick, commands: commands_of(bytes, pace) });
    }
    rest.is_empty().then_some(records)
}

/// Commands as bytes: sticks, then switches.
fn bytes_of(commands: &PlayerCommands) -> [u8; COLUMNS] {
    let [right, up, back] = commands.thrust.map(|stick| stick as u8);
    let [pitch, yaw, roll] = commands.turn.map(|stick| stick as u8);
    let switches = [
        commands.assist == AssistMode::Orbit,
        commands.autopilot,
        commands.looking,
        commands.fire,
        commands.assist == AssistMode::Target,
        commands.matching,
        commands.facing,
    ];
    [right, up, back, pitch, yaw, roll, switches.iter().rev().fold(0, |bits, &on| 2 * bits + u8::from(on))]
}

/// The inverse of [`bytes_of`].
fn commands_of([right, up, back, pitch, yaw, roll, switches]: [u8; COLUMNS], pace: f64) -> PlayerCommands {
    let switch = |bit: u8| switches >> bit & 1 == 1;
    PlayerCommands {
        thrust: [right, up, back].map(|byte| byte as i8),
        turn: [pitch, yaw, roll].map(|byte| byte as i8),
        assist: match (switch(0), switch(4)) {
            (_, true) => AssistMode::Target,
            (true, false) => AssistMode::Orbit,
            (false, false) => AssistMode::Off,
        },
        autopilot: switch(1),
        looking: switch(2),
        fire: switch(3),
        matching: switch(5),
        facing: switch(6),
        pace,
    }
}

/// Seven bits a byte, the low ones first (LEB128).
fn varint(out: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

fn read_varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0u64;
    for place in 0..10 {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << (7 * place);
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}
