//! The lines of this machine: all parts, or those that are named.

fn main() -> Result<(), String> {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let parts: Vec<&str> = if named.is_empty() { lensrunner_bits::PARTS.to_vec() } else { named.iter().map(String::as_str).collect() };
    for part in parts {
        print!("{}", lensrunner_bits::lines(part, false)?);
    }
    Ok(())
}
