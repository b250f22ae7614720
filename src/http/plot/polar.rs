//! The value as the distance from the origin, in the direction of the swept angle from the surface normal.

use super::style::{Style, letters, placed, stroke};
use super::ticks::ValueAxis;
use super::{Area, Drawn, Plot, runs, tenths};
use plotters::element::{PathElement, Polygon, Text};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, VPos};

/// Sizes of letters, pixels.
const MARKS: f64 = 12.5;
const LABEL: f64 = 13.0;
/// Left free for the letters: at the sides, above, below, pixels.
const SIDE: f64 = 44.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 52.0;
/// Degrees between two spokes.
const SPOKES: i32 = 30;
/// Degrees between two points of a ring.
const ARC: f64 = 3.0;

/// The half disc above the surface.
struct Disc {
    centre: (f64, f64),
    radius: f64,
}

impl Disc {
    /// Where a share of the radius lies in a direction, tenths of a pixel.
    fn at(&self, share: f64, degrees: f64) -> (i32, i32) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        (tenths(self.centre.0 + self.radius * share * sin), tenths(self.centre.1 - self.radius * share * cos))
    }
}

pub(super) fn draw(area: &Area, plot: &Plot, values: &ValueAxis, style: &Style) -> Drawn {
    let (width, height) = area.dim_in_pixel();
    let [width, height] = [width, height].map(|tenths| f64::from(tenths) / super::TENTHS);
    let radius = (0.5 * width - SIDE).min(height - ABOVE - BELOW).max(20.0);
    let disc = Disc { centre: (0.5 * width, height - BELOW), radius };
    let share = |value: f64| (value - values.least) / (values.largest - values.least);
    mesh(area, &disc, plot, values, style)?;
    fixed(area, &disc, plot, style)?;
    for curve in &plot.curves {
        // What is below the least value is at the origin.
        let places = values
            .places(curve)
            .map(|(angle, value)| (angle, if value < values.least { values.least } else { value }));
        for run in runs(places, (values.least, values.largest)) {
            let points: Vec<_> = run.iter().map(|&(angle, value)| disc.at(share(value), angle)).collect();
            stroke(area, points, style.line(curve.colour, curve.dash, plot.dashes.len()), curve.dash)?;
        }
    }
    if values.is_empty {
        let middle = placed(&letters(LABEL, style.text), HPos::Center, VPos::Center);
        area.draw(&Text::new("no value to draw", disc.at(0.5, 0.0), middle))?;
    }
    Ok(())
}

/// Rings at the marks of the values, spokes at every thirtieth degree, and what is written at them.
fn mesh(area: &Area, disc: &Disc, plot: &Plot, values: &ValueAxis, style: &Style) -> Drawn {
    let thin = style.mesh.stroke_width(10);
    let marks = letters(MARKS, style.text);
    let share = |value: f64| (value - values.least) / (values.largest - values.least);
    let ring = |share: f64| -> Vec<(i32, i32)> {
        (0..=60).map(|step| disc.at(share, ARC * f64::from(step) - 90.0)).collect()
    };
    for mark in values.marks.iter().filter(|mark| mark.at > values.least) {
        area.draw(&PathElement::new(ring(share(mark.at)), thin))?;
    }
    for angle in (-90..=90).step_by(SPOKES.unsigned_abs() as usize) {
        let degrees = f64::from(angle);
        area.draw(&PathElement::new(vec![disc.at(0.0, degrees), disc.at(1.0, degrees)], thin))?;
        let (horizontal, vertical) = match angle {
            -90 => (HPos::Right, VPos::Center),
            90 => (HPos::Left, VPos::Center),
            ..0 => (HPos::Right, VPos::Bottom),
            0 => (HPos::Center, VPos::Bottom),
            1.. => (HPos::Left, VPos::Bottom),
        };
        let text = format!("{}°", super::ticks::minus(&angle.to_string()));
        let at = disc.at(1.0 + 6.0 / disc.radius, degrees);
        area.draw(&Text::new(text, at, placed(&marks, horizontal, vertical)))?;
    }
    area.draw(&PathElement::new(vec![disc.at(1.0, -90.0), disc.at(1.0, 90.0)], style.axis.stroke_width(12)))?;
    // The marks of the values stand below the surface, on both sides of the origin alike.
    let below = placed(&marks, HPos::Center, VPos::Top);
    let least = placed(&letters(MARKS, style.muted), HPos::Center, VPos::Top);
    for mark in &values.marks {
        let (x, y) = disc.at(share(mark.at), 90.0);
        let is_origin = mark.at <= values.least;
        let text = if is_origin { least.clone() } else { below.clone() };
        area.draw(&Text::new(mark.text.clone(), (x, y + tenths(7.0)), text))?;
    }
    let (symbol, name) = plot.axis;
    let label = format!(
        "{}; {} {symbol} from the normal",
        values.label(plot.quantity, &plot.unit),
        name.to_lowercase()
    );
    let at = (tenths(disc.centre.0), tenths(disc.centre.1 + 27.0));
    area.draw(&Text::new(label, at, placed(&letters(LABEL, style.text), HPos::Center, VPos::Top)))?;
    Ok(())
}

/// The direction that stays: it mirrors the swept one at its own angle.
fn fixed(area: &Area, disc: &Disc, plot: &Plot, style: &Style) -> Drawn {
    let Some((what, angle)) = plot.fixed else { return Ok(()) };
    let degrees = -angle;
    stroke(area, vec![disc.at(0.97, degrees), disc.at(0.0, degrees)], style.sample(1, 1), 1)?;
    // A source sends light to the surface, a viewer gets it.
    let (tip, back) = if what == "source" { (0.80, 0.85) } else { (0.85, 0.80) };
    let side = 1.6;
    let head = vec![disc.at(tip, degrees), disc.at(back, degrees - side), disc.at(back, degrees + side)];
    area.draw(&Polygon::new(head, style.muted.filled()))?;
    let (horizontal, at) = if degrees > 0.0 {
        (HPos::Left, disc.at(0.93, degrees + 4.0))
    } else {
        (HPos::Right, disc.at(0.93, degrees - 4.0))
    };
    area.draw(&Text::new(what, at, placed(&letters(MARKS, style.muted), horizontal, VPos::Center)))?;
    Ok(())
}
