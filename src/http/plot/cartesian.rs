//! The value over the swept angle.

use super::style::{Style, letters, placed, stroke};
use super::ticks::{Mark, ValueAxis, degrees};
use super::{Area, Drawn, Plot, runs, tenths};
use plotters::chart::ChartBuilder;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::element::Text;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color as _, TRANSPARENT};
use std::ops::Range;

/// Sizes of letters, pixels.
const MARKS: f64 = 12.5;
const LABEL: f64 = 13.0;
/// Pixels of the width for one mark of the angle.
const MARK_WIDTH: f64 = 80.0;

/// An axis with marks of its own.
struct Axis {
    range: RangedCoordf64,
    marks: Vec<Mark>,
}

impl Axis {
    fn new((from, to): (f64, f64), marks: Vec<Mark>) -> Self {
        Self { range: (from..to).into(), marks }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.marks.iter().map(|mark| mark.at).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        let mark = self.marks.iter().find(|mark| mark.at == *value);
        mark.map_or_else(|| Self::format(value), |mark| mark.text.clone())
    }
}

pub(super) fn draw(area: &Area, plot: &Plot, values: &ValueAxis, style: &Style) -> Drawn {
    let (from, to) = plot.ends;
    // A sweep without length stands in the middle.
    let (left, right) = if to > from { (from, to) } else { (from - 1.0, to + 1.0) };
    let width = f64::from(area.dim_in_pixel().0) / super::TENTHS;
    let angles = Axis::new((left, right), degrees(plot.ends, width / MARK_WIDTH));
    let mut chart = ChartBuilder::on(area)
        .margin_top(tenths(12.0))
        .margin_right(tenths(22.0))
        .margin_left(tenths(10.0))
        .margin_bottom(tenths(10.0))
        .x_label_area_size(tenths(44.0))
        .y_label_area_size(tenths(62.0))
        .build_cartesian_2d(angles, Axis::new((values.least, values.largest), values.marks.clone()))?;
    let (symbol, name) = plot.axis;
    let label = letters(LABEL, style.text);
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(style.mesh.stroke_width(10))
        .axis_style(style.axis.stroke_width(10))
        .set_all_tick_mark_size(tenths(4.0))
        .x_desc(format!("{name} {symbol} (degrees)"))
        .y_desc(values.label(plot.quantity, &plot.unit))
        .label_style(letters(MARKS, style.text))
        .axis_desc_style(label.clone())
        .draw()?;
    // Lines are drawn on the area itself: they have kinds that plotters' series have not.
    let (x0, y0) = area.get_base_pixel();
    for curve in &plot.curves {
        for run in runs(values.places(curve), (values.least, values.largest)) {
            let points = run.iter().map(|point| {
                let (x, y) = chart.backend_coord(point);
                (x - x0, y - y0)
            });
            stroke(
                area,
                points.collect(),
                style.line(curve.colour, curve.dash, plot.dashes.len()),
                curve.dash,
            )?;
        }
    }
    if values.is_empty {
        let (x, y) = chart.backend_coord(&(0.5 * (left + right), 0.5 * (values.least + values.largest)));
        let middle = placed(&label, HPos::Center, VPos::Center);
        area.draw(&Text::new("no value to draw", (x - x0, y - y0), middle))?;
    }
    Ok(())
}
