//! Figures as Markdown and as JSON.

use crate::measure::{Row, Times, median};
use serde_json::{Value as Json, json};
use std::fmt::Write;

/// The heading of the table of rows.
pub const HEADING: &str = "\
| work | by | median | least to most | first is faster by |
|---|---|---|---|---|
";

/// One row as lines of a table, one for each contender. Ratios above 1 say that the first one is faster.
pub fn markdown(row: &Row<'_>, times: &[Times]) -> String {
    let mut text = String::new();
    let first = times.first().and_then(|times| times.as_ref().ok()).map(|times| median(times));
    for (place, (contender, times)) in row.contenders.iter().zip(times).enumerate() {
        let name = if place == 0 { row.name.as_str() } else { "" };
        let _ = write!(text, "| {name} | {} ", contender.name);
        let _ = match times {
            Err(reason) => writeln!(text, "| {reason} | | |"),
            Ok(times) => {
                let figure = |time: f64| short(row.unit.figure(time));
                let mut ends = [least(times), most(times)].map(|time| row.unit.figure(time));
                ends.sort_by(f64::total_cmp);
                let ratio = match first {
                    Some(first) if place > 0 => format!("{:.2}", median(times) / first),
                    _ => String::new(),
                };
                let [low, high] = ends.map(short);
                writeln!(text, "| {} {} | {low} to {high} | {ratio} |", figure(median(times)), row.unit.name())
            }
        };
    }
    text
}

/// One row as JSON: times in seconds.
pub fn json(row: &Row<'_>, times: &[Times]) -> Json {
    let contenders: Vec<Json> = row
        .contenders
        .iter()
        .zip(times)
        .map(|(contender, times)| match times {
            Err(reason) => json!({ "by": contender.name, "missing": reason }),
            Ok(times) => json!({
                "by": contender.name,
                "figure": row.unit.figure(median(times)),
                "seconds": { "median": median(times), "least": least(times), "most": most(times), "runs": times.len() },
            }),
        })
        .collect();
    json!({ "work": row.name, "unit": row.unit.name(), "contenders": contenders })
}

fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

fn most(times: &[f64]) -> f64 {
    times.iter().copied().fold(0.0, f64::max)
}

/// Three digits that count.
pub fn short(number: f64) -> String {
    let digits = if number == 0.0 || !number.is_finite() { 0.0 } else { number.abs().log10().floor() };
    format!("{number:.*}", (2.0 - digits).clamp(0.0, 6.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Clock, Contender, Unit};

    #[test]
    fn three_digits_count() {
        for (number, text) in [(0.0, "0.00"), (0.001_234, "0.00123"), (1.0, "1.00"), (12.34, "12.3"), (1234.5, "1234")]
        {
            assert_eq!(short(number), text);
        }
    }

    #[test]
    fn a_row_is_printed_with_ratios_and_reasons() {
        let contender = |name: &str| Contender::new(name, Clock::Wall, || {});
        let contenders = vec![contender("us"), contender("them"), Contender::missing("others", "not installed")];
        let row = Row { name: "work".into(), unit: Unit::Points(1_000_000), contenders };
        let times = [Ok(vec![0.5]), Ok(vec![1.0, 2.0, 4.0]), Err("not installed".into())];
        assert_eq!(
            markdown(&row, &times),
            "| work | us | 2.00 M points/s | 2.00 to 2.00 |  |\n\
             |  | them | 0.500 M points/s | 0.250 to 1.00 | 4.00 |\n\
             |  | others | not installed | | |\n"
        );
        let json = json(&row, &times);
        assert_eq!(json["contenders"][1]["figure"], 0.5);
        assert_eq!(json["contenders"][2]["missing"], "not installed");
    }
}
