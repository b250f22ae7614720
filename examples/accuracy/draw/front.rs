//! Error against time.

use super::maps::picture;
use super::style::{Area, Drawn, beside, colour, font, power_of_ten};
use crate::front::{Band, Point};
use plotters::prelude::*;
use reflectance::reflectance::numeric::lobe_series::Method;
use std::error::Error;

/// Decades of the axes: time over one exp(), and error.
const TIMES: (f64, f64) = (0.0, 4.0);
const ERRORS: (f64, f64) = (-15.0, 1.0);

/// A panel a band.
pub(crate) fn front(bands: &[Band]) -> Result<String, Box<dyn Error>> {
    picture((1220, 900), |root| {
        let (top, rest) = root.split_vertically(70);
        top.draw(&Text::new("Largest error of a radiance", (20, 24), beside(17)))?;
        for (index, method) in (0..).zip(Method::ALL) {
            let x = 290 + 105 * index;
            marker(&top, (x, 24), method)?;
            top.draw(&Text::new(method.name(), (x + 14, 24), beside(15)))?;
        }
        top.draw(&PathElement::new([(935, 24), (965, 24)], front_style()))?;
        top.draw(&Text::new("nothing is faster and better", (973, 24), beside(15)))?;
        for (band, area) in bands.iter().zip(rest.split_evenly((2, 3))) {
            panel(&area, band)?;
        }
        Ok(())
    })
}

fn front_style() -> ShapeStyle {
    RGBColor(130, 130, 130).stroke_width(2)
}

/// Each method has a colour and a shape of its own.
fn marker(area: &Area<'_>, at: (i32, i32), method: Method) -> Drawn {
    let (style, (x, y)) = (colour(method).filled(), at);
    match method {
        Method::Auto => area.draw(&Circle::new(at, 5, style))?,
        Method::Series => area.draw(&Rectangle::new([(x - 5, y - 5), (x + 5, y + 5)], style))?,
        Method::Paper => area.draw(&Cross::new(at, 5, colour(method).stroke_width(3)))?,
        Method::Uniform => area.draw(&TriangleMarker::new(at, 7, style))?,
        Method::Smooth => {
            let corners = [(x - 6, y), (x, y - 6), (x + 6, y), (x, y + 6)];
            area.draw(&Polygon::new(corners, style))?;
        }
        Method::Rough => area.draw(&Rectangle::new([(x - 7, y - 3), (x + 7, y + 3)], style))?,
    }
    Ok(())
}

fn panel(area: &Area<'_>, band: &Band) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption(format!("μ from {}", band.name()), font(18))
        .margin(6)
        .margin_right(18)
        .x_label_area_size(46)
        .y_label_area_size(66)
        .build_cartesian_2d(TIMES.0..TIMES.1, ERRORS.0..ERRORS.1)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225))
        .x_desc("time of a direction, exp()")
        .y_desc("relative error")
        .x_labels(5)
        .y_labels(9)
        .x_label_formatter(&|v| power_of_ten(*v))
        .y_label_formatter(&|v| power_of_ten(*v))
        .label_style(font(14))
        .axis_desc_style(font(15))
        .draw()?;
    let place = |point: &Point| {
        (point.time.log10().clamp(TIMES.0, TIMES.1), point.largest.log10().clamp(ERRORS.0, ERRORS.1))
    };
    let mut best: Vec<(f64, f64)> = band.points.iter().filter(|point| point.on_front).map(place).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Until the next point is reached, nothing better than this one is to be had.
    let ends = (best.first().map(|a| (a.0, ERRORS.1)), best.last().map(|b| (TIMES.1, b.1)));
    let steps = best.iter().zip(best.iter().skip(1)).flat_map(|(a, b)| [*a, (b.0, a.1), *b]);
    let steps = ends.0.into_iter().chain(best.first().copied()).chain(steps).chain(ends.1);
    chart.draw_series(LineSeries::new(steps, front_style()))?;
    let (left, top) = area.get_base_pixel();
    let mut labels: Vec<Label> = Vec::new();
    for point in &band.points {
        let (x, y) = chart.backend_coord(&place(point));
        let at = (x - left, y - top);
        marker(area, at, point.accuracy.method)?;
        if point.accuracy.method == Method::Auto {
            let tolerance = point.accuracy.relative_tolerance.get();
            match labels.last_mut().filter(|last| last.is_close(at)) {
                Some(last) => last.to = tolerance,
                None => labels.push(Label { at, from: tolerance, to: tolerance }),
            }
        }
    }
    for label in labels {
        area.draw(&Text::new(label.text(), (label.at.0 + 9, label.at.1 - 10), beside(13)))?;
    }
    Ok(())
}

/// Tolerances of `auto` that end at one place.
struct Label {
    at: (i32, i32),
    from: f64,
    to: f64,
}

impl Label {
    fn is_close(&self, (x, y): (i32, i32)) -> bool {
        (self.at.0 - x).abs() < 40 && (self.at.1 - y).abs() < 14
    }

    /// "10⁻¹" or "10⁻¹…10⁻¹²"
    fn text(&self) -> String {
        let [from, to] = [self.from, self.to].map(|tolerance| power_of_ten(tolerance.log10()));
        if self.from == self.to { from } else { format!("{from}…{to}") }
    }
}
