//! What the program was built from and for, written by `build.rs`.

include!(concat!(env!("OUT_DIR"), "/built.rs"));

/// The first twelve letters of the commit that the last line of a log of git (`.git/logs/HEAD`) leads to: the second of its two names.
/// Zeros where there is none.
const fn last_commit(log: &[u8]) -> [u8; 12] {
    let mut start = log.len().saturating_sub(1);
    while start > 0 && log[start - 1] != b'\n' {
        start -= 1;
    }
    while start < log.len() && log[start] != b' ' {
        start += 1;
    }
    let mut commit = [0; 12];
    let mut k = 0;
    while k < 12 {
        if start + 1 + k >= log.len() || !log[start + 1 + k].is_ascii_hexdigit() {
            return [0; 12];
        }
        commit[k] = log[start + 1 + k];
        k += 1;
    }
    commit
}
