//! What the pictures have in common: fonts, colours, legends.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use reflectance::reflectance::numeric::lobe_series::Method;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Drawn = Result<(), Box<dyn std::error::Error>>;

pub(super) const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// Text of a size in pixels.
pub(super) fn font(size: u32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&BLACK)
}

/// Text that starts at its point and is centred on its height.
pub(super) fn beside(size: u32) -> TextStyle<'static> {
    font(size).pos(Pos::new(HPos::Left, VPos::Center))
}

/// Okabe and Ito's colours, which the colour-blind can tell apart.
pub(super) const fn colour(method: Method) -> RGBColor {
    match method {
        Method::Auto => RGBColor(0, 0, 0),
        Method::Series => RGBColor(0, 114, 178),
        Method::Paper => RGBColor(213, 94, 0),
        Method::Uniform => RGBColor(0, 158, 115),
        Method::Smooth => RGBColor(230, 159, 0),
        Method::Rough => RGBColor(204, 121, 167),
    }
}

/// A power of ten as an axis writes it: 10⁻⁴.
pub(super) fn power_of_ten(exponent: f64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = format!("{exponent:.0}");
    let raised = raised.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]));
    "10".chars().chain(raised).collect()
}

/// A row of coloured boxes, each with its text, from `left` on at height `y`.
pub(super) fn boxes(
    root: &Area<'_>,
    (left, y): (i32, i32),
    entries: &[(RGBColor, String)],
    width: i32,
) -> Drawn {
    for (index, (colour, text)) in (0..).zip(entries) {
        let x = left + index * width;
        root.draw(&Rectangle::new([(x, y - 8), (x + 16, y + 8)], colour.filled()))?;
        root.draw(&Rectangle::new([(x, y - 8), (x + 16, y + 8)], RGBColor(90, 90, 90)))?;
        root.draw(&Text::new(text.clone(), (x + 22, y), beside(15)))?;
    }
    Ok(())
}
