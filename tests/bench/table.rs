//! Ratios of same-round pairs as a table: medians and their spread.

use super::child::median;

/// One quantity: in each round, what it is compared with and what glumbra took.
pub struct Row {
    pub name: &'static str,
    pub unit: &'static str,
    /// The greatest ratio that the issue expects.
    pub expected: Option<f64>,
    pub pairs: Vec<(f64, f64)>,
}

/// Prints the table as Markdown.
pub fn print(rows: &[Row]) {
    println!("| quantity | base | measured | ratio, median | quartiles | all | expected |");
    println!("|---|---|---|---|---|---|---|");
    for row in rows {
        let of = |pick: fn(&(f64, f64)) -> f64| median(&mut row.pairs.iter().map(pick).collect::<Vec<_>>());
        let mut ratios: Vec<f64> = row.pairs.iter().map(|(base, measured)| measured / base).collect();
        let middle = median(&mut ratios);
        let at = |share: f64| ratios[(share * (ratios.len() - 1) as f64).round() as usize];
        let verdict = match row.expected {
            Some(most) if middle <= most => format!("<= {most}: met"),
            Some(most) => format!("<= {most}: MISSED"),
            None => String::new(),
        };
        println!(
            "| {} | {:.1} {unit} | {:.1} {unit} | {middle:.2} | {:.2}-{:.2} | {:.2}-{:.2} | {verdict} |",
            row.name,
            of(|pair| pair.0),
            of(|pair| pair.1),
            at(0.25),
            at(0.75),
            at(0.0),
            at(1.0),
            unit = row.unit,
        );
    }
}
