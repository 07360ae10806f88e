//! How deeply a TOML text is nested, seen before anything is made of it.

/// The most levels of arrays, inline tables and dotted keys within one another.
pub const MOST_LEVELS: usize = 32;

/// The line, from 1, in which a text goes deeper than [`MOST_LEVELS`].
pub fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut at, mut line, mut open, mut dots) = (0, 1, 0usize, 0usize);
    while let Some(&byte) = bytes.get(at) {
        let after = match byte {
            b'#' => at + bytes[at..].iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len() - at),
            b'"' | b'\'' => end_of_string(bytes, at),
            _ => at + 1,
        };
        match byte {
            b'[' | b'{' => open += 1,
            b']' | b'}' => open = open.saturating_sub(1),
            b'.' => dots += 1,
            _ => (),
        }
        // Parts of a dotted key, with spaces between them; anything else ends it.
        if !(byte.is_ascii_alphanumeric() || b"_-.\"' \t".contains(&byte)) {
            dots = 0;
        }
        if open.max(dots) > MOST_LEVELS {
            return Some(line);
        }
        line += bytes[at..after].iter().filter(|byte| **byte == b'\n').count();
        at = after;
    }
    None
}

/// Where the string that begins at `start` ends; a string in one line that has no end ends with its line.
fn end_of_string(bytes: &[u8], start: usize) -> usize {
    let quote = bytes[start];
    let is_long = bytes[start..].starts_with(&[quote; 3]);
    let mut at = start + if is_long { 3 } else { 1 };
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'\\' if quote == b'"' => at += 1,
            b'\n' if !is_long => return at,
            _ if byte == quote && !is_long => return at + 1,
            _ if is_long && bytes[at..].starts_with(&[quote; 3]) => return at + 3,
            _ => (),
        }
        at += 1;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_counted_outside_of_strings_and_comments() {
        let deep = format!("{}1{}", "[".repeat(33), "]".repeat(33));
        let keys = vec!["a"; 34].join(" . ");
        for (text, line) in [
            (format!("a = 1\nb = {deep}\n"), Some(2)),
            (format!("a = {}1{}", "[".repeat(32), "]".repeat(32)), None),
            (format!("a = {}", "[1.5, 2.5], ".repeat(100)), None),
            (format!("# {deep}\na = \"{deep}\"\nb = '{deep}'\n"), None),
            (format!("a = \"\\\"{deep}\"\nb = \"\"\"\n\"{deep}\"\"\"\nc = '\\'\nd = {deep}"), Some(5)),
            (format!("\n\n{keys} = 1"), Some(3)),
            (format!("[{keys}]"), Some(1)),
            (keys.replace('a', "\"a.b\""), Some(1)),
            ("\"".into(), None),
            ("\"\\".into(), None),
        ] {
            assert_eq!(too_deep(&text), line, "{text}");
        }
    }
}
