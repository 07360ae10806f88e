//! The records of a replay, and how they are packed: column by column, each number less the one before, then DEFLATE.

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

/// Numbers of a record besides its pace: steps since the one before, six sticks, six switches.
const COLUMNS: usize = 8;

/// Packs records: column by column, each number less the one before, so that what stays the same is zero.
pub(super) fn pack(records: &[Record]) -> Vec<u8> {
    let mut raw = Vec::new();
    raw.extend((records.len() as u64).to_le_bytes());
    for column in 0..COLUMNS {
        let mut before = 0u64;
        for record in records {
            let value = column_of(record, column);
            let change = value.wrapping_sub(before);
            before = value;
            if column == 0 { varint(&mut raw, change) } else { raw.push(change as u8) }
        }
    }
    let mut before = 0u64;
    for record in records {
        let bits = record.commands.pace.to_bits();
        varint(&mut raw, bits ^ before);
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
    // Each takes a byte a column at least.
    if count > raw.len() / COLUMNS {
        return None;
    }
    let mut rest = &raw[8..];
    let mut columns = vec![[0u64; COLUMNS]; count];
    for column in 0..COLUMNS {
        let mut before = 0u64;
        for row in &mut columns {
            let change = if column == 0 {
                read_varint(&mut rest)?
            } else {
                let (&byte, after) = rest.split_first()?;
                rest = after;
                u64::from(byte)
            };
            before = if column == 0 { before.checked_add(change)? } else { before.wrapping_add(change) & 0xff };
            row[column] = before;
        }
    }
    let mut before = 0u64;
    let mut records = Vec::with_capacity(count);
    for row in columns {
        before ^= read_varint(&mut rest)?;
        let pace = f64::from_bits(before);
        if !(pace > 0.0 && pace.is_finite()) {
            return None;
        }
        records.push(record_of(row, pace));
    }
    rest.is_empty().then_some(records)
}

/// One number of a record; sticks as their bytes.
fn column_of(record: &Record, column: usize) -> u64 {
    let commands = &record.commands;
    let byte = |stick: i8| u64::from(stick as u8);
    match column {
        0 => record.tick,
        1..=3 => byte(commands.thrust[column - 1]),
        4..=6 => byte(commands.turn[column - 4]),
        _ => [
            commands.assist == AssistMode::Orbit,
            commands.autopilot,
            commands.looking,
            commands.fire,
            commands.assist == AssistMode::Target,
            commands.matching,
        ]
        .iter()
        .rev()
        .fold(0, |bits, &on| 2 * bits + u64::from(on)),
    }
}

/// The inverse of [`column_of`].
fn record_of(row: [u64; COLUMNS], pace: f64) -> Record {
    let stick = |column: usize| row[column] as u8 as i8;
    let switch = |bit: u64| row[7] >> bit & 1 == 1;
    Record {
        tick: row[0],
        commands: PlayerCommands {
            thrust: [stick(1), stick(2), stick(3)],
            turn: [stick(4), stick(5), stick(6)],
            assist: match (switch(0), switch(4)) {
                (_, true) => AssistMode::Target,
                (true, false) => AssistMode::Orbit,
                (false, false) => AssistMode::Off,
            },
            autopilot: switch(1),
            looking: switch(2),
            fire: switch(3),
            matching: switch(5),
            pace,
        },
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
