//! What the readers of TOML and JSON say of a value, in words that say what is allowed instead of naming a type of the program.

/// The sentence of a reader; one about the kind of a value in plain words, any other as it is.
pub fn in_words(said: &str) -> String {
    let Some(rest) = ["invalid type: ", "invalid value: "].iter().find_map(|start| said.strip_prefix(start)) else {
        return match said.strip_prefix("invalid length ").and_then(|rest| rest.split_once(", expected ")) {
            Some((length, expected)) => format!("it has {length} values, allowed {}", allowed(expected)),
            None => said.to_owned(),
        };
    };
    // The value may be a text with anything in it: what was expected stands last.
    let Some((value, expected)) = rest.rsplit_once(", expected ") else { return said.to_owned() };
    format!("{} must be {}", found(value), allowed(expected))
}

/// The value that was found.
fn found(value: &str) -> String {
    let kinds = ["string ", "integer ", "floating point ", "boolean "];
    let bare = kinds.iter().find_map(|kind| value.strip_prefix(kind)).map(|value| value.trim_matches('`'));
    match value {
        "sequence" => "a list".into(),
        "map" => "a table".into(),
        "unit" | "null" | "Option value" => "nothing".into(),
        _ => bare.unwrap_or(value).into(),
    }
}

/// What may stand there.
fn allowed(expected: &str) -> String {
    let whole = |least: i128, most: u128| format!("a whole number {least} to {most}");
    match expected {
        "u8" => whole(0, u8::MAX.into()),
        "u16" => whole(0, u16::MAX.into()),
        "u32" => whole(0, u32::MAX.into()),
        "u64" | "usize" => whole(0, u64::MAX.into()),
        "i32" => whole(i32::MIN.into(), i32::MAX as u128),
        "i64" | "isize" => whole(i64::MIN.into(), i64::MAX as u128),
        "f32" | "f64" => "a number".into(),
        "a boolean" => "true or false".into(),
        "a string" | "a borrowed string" => "a text in quotes".into(),
        "a sequence" => "a list".into(),
        _ if expected.starts_with("struct ") || expected == "a map" => "a table of keys and values".into(),
        _ => match ["an array of length ", "a tuple of size "].iter().find_map(|start| expected.strip_prefix(start)) {
            Some(length) => format!("a list of {length} values"),
            None => expected.into(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_type_of_the_program_is_named() {
        for (said, words) in [
            ("invalid type: string \"x\", expected u32", "\"x\" must be a whole number 0 to 4294967295"),
            ("invalid value: integer `-1`, expected u64", "-1 must be a whole number 0 to 18446744073709551615"),
            ("invalid type: floating point `1.5`, expected a string", "1.5 must be a text in quotes"),
            ("invalid type: integer `5`, expected struct Best", "5 must be a table of keys and values"),
            ("invalid type: map, expected an array of length 3", "a table must be a list of 3 values"),
            ("invalid length 4, expected an array of length 3", "it has 4 values, allowed a list of 3 values"),
            ("invalid type: string \"a, expected u8\", expected f64", "\"a, expected u8\" must be a number"),
            ("invalid type: null, expected f64", "nothing must be a number"),
            ("unknown field `a`, expected `b`", "unknown field `a`, expected `b`"),
        ] {
            assert_eq!(in_words(said), words);
        }
    }
}
