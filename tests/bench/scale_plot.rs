//! Curves of `ci/bench --scale` as one SVG with logarithmic axes: a row for each ladder, a column for each quantity.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::Result;
use super::scale::{Measured, QUANTITIES, Quantity, exponent};

/// Size of one plot, in pixels.
const PLOT: (u32, u32) = (380, 280);

const FLOOR: RGBColor = RGBColor(0x55, 0x55, 0x5c);
const GLUMBRA: RGBColor = RGBColor(0x00, 0x72, 0xb2);
const FONT: &str = "sans-serif";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Writes the plots.
pub fn write(all: &[Measured], path: &Path) -> Result<()> {
    let size = (PLOT.0 * QUANTITIES.len() as u32, PLOT.1 * all.len() as u32);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        let areas = root.split_evenly((all.len(), QUANTITIES.len()));
        for (row, measured) in areas.chunks(QUANTITIES.len()).zip(all) {
            for (column, (area, quantity)) in row.iter().zip(&QUANTITIES).enumerate() {
                plot(area, measured, column, quantity)?;
            }
        }
        root.present()?;
    }
    std::fs::write(path, svg)?;
    println!("\n{}", path.display());
    Ok(())
}

fn plot(area: &Area<'_>, measured: &Measured, column: usize, quantity: &Quantity) -> Result<()> {
    let curves = &measured.curves[column];
    let sizes: Vec<f64> = measured.sizes.iter().map(|size| *size as f64).collect();
    let values = || curves.glumbra.iter().chain(curves.floor.iter().flatten()).copied().filter(|value| *value > 0.0);
    let (low, high) = values().fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    let y = if low < high { 0.7 * low..1.4 * high } else { 0.5..2.0 };
    let x = 0.8 * sizes[0]..1.25 * sizes[sizes.len() - 1];
    let own = exponent(&measured.sizes, &curves.glumbra);
    let caption = format!("{}: {}, exponent {own:.2}", measured.name, quantity.name);
    let mut chart = ChartBuilder::on(area)
        .caption(caption, (FONT, 14))
        .margin(10)
        .x_label_area_size(34)
        .y_label_area_size(56)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        .x_desc(measured.unit)
        .y_desc(quantity.unit)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style((FONT, 11))
        .light_line_style(RGBColor(0xf0, 0xf0, 0xf3))
        .draw()?;
    let named = [("floor", FLOOR, curves.floor.as_ref()), ("glumbra", GLUMBRA, Some(&curves.glumbra))];
    for (name, color, values) in named {
        let Some(values) = values else { continue };
        let points: Vec<(f64, f64)> = sizes.iter().copied().zip(values.iter().copied()).collect();
        chart
            .draw_series([PathElement::new(points.clone(), color.stroke_width(2))])?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        chart.draw_series(points.into_iter().map(|place| Circle::new(place, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .label_font((FONT, 11))
        .background_style(WHITE.mix(0.8))
        .draw()?;
    Ok(())
}

/// A number at a line of the grid: 1, 2 or 5 and zeros; others would overlap.
fn label(value: &f64) -> String {
    let digit = (value / 10_f64.powf(value.log10().floor())).round();
    match [1.0, 2.0, 5.0].contains(&digit) {
        true if (0.01..1e4).contains(value) => format!("{value}"),
        true => format!("{value:.0e}"),
        false => String::new(),
    }
}
