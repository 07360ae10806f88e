//! Values of the command line: numbers whose refusal says what is allowed. It imports no floor, and every floor may import it.

/// Reads a whole number from `least` to `most`.
pub fn whole<T: TryFrom<u64>>(least: u64, most: u64) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.and_then(|number| T::try_from(number).ok()).ok_or_else(|| format!("allowed are whole numbers {least} to {most}"))
    }
}

/// Reads a real number; what it may be, beyond finite, is checked where the rest is known.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "allowed are numbers, as 0.5 or 1e-3".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_says_what_is_allowed() {
        assert_eq!(whole::<u32>(1, 300)("300"), Ok(300));
        for text in ["0", "301", "-1", "x", "", "1.5", "99999999999999999999999"] {
            assert_eq!(whole::<u32>(1, 300)(text), Err("allowed are whole numbers 1 to 300".into()), "{text}");
        }
        assert_eq!(whole::<u8>(1, 300)("300"), Err("allowed are whole numbers 1 to 300".into()), "larger than the type");
        assert_eq!(number("-1e-3"), Ok(-1e-3));
        for text in ["x", "", "nan", "inf", "1e999"] {
            assert_eq!(number(text), Err("allowed are numbers, as 0.5 or 1e-3".into()), "{text}");
        }
    }
}
