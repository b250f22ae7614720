//! Colours, lines and letters of the pictures.

use super::options::Theme;
use super::{Area, Drawn};
use plotters::element::{Circle, DashedPathElement, PathElement};
use plotters::style::colors::colormaps::{ColorMap as _, ViridisRGB};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontStyle, IntoFont as _, RGBColor, TextStyle};

/// Units of a picture in one pixel.
pub(super) const TENTHS: f64 = 10.0;

/// What letters are looked for. The first one comes with the service.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

/// plotters writes a font's size divided by this.
const FONT_SIZE: f64 = 1.24;

/// Pixels as units of a picture.
pub(super) fn tenths(pixels: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "some thousands at most")]
    let units = (pixels * TENTHS).round() as i32;
    units
}

/// The colours of a theme, those of the curves apart.
#[derive(Clone, Debug)]
pub(super) struct Style {
    pub(super) background: RGBColor,
    pub(super) text: RGBColor,
    /// Of what is said beside.
    pub(super) muted: RGBColor,
    pub(super) axis: RGBColor,
    pub(super) mesh: RGBColor,
    curves: Vec<RGBColor>,
}

/// Each at least 3:1 against the background, and neighbours apart for the colour-blind too.
const ON_LIGHT: [RGBColor; 8] = [
    RGBColor(0, 98, 177),
    RGBColor(204, 68, 0),
    RGBColor(0, 128, 96),
    RGBColor(150, 52, 132),
    RGBColor(138, 106, 0),
    RGBColor(70, 70, 70),
    RGBColor(24, 140, 190),
    RGBColor(176, 40, 70),
];
/// The one that is grey.
const NEUTRAL: usize = 5;
const ON_DARK: [RGBColor; 8] = [
    RGBColor(96, 180, 255),
    RGBColor(255, 157, 87),
    RGBColor(61, 214, 163),
    RGBColor(232, 150, 210),
    RGBColor(240, 204, 85),
    RGBColor(220, 220, 220),
    RGBColor(150, 220, 250),
    RGBColor(255, 135, 155),
];

impl Style {
    /// For so many colours of curves; the first has none of its own where it is of a sum.
    pub(super) fn of(theme: Theme, curves: usize, has_sum: bool) -> Self {
        let (few, range) = match theme {
            Theme::Light => (ON_LIGHT, (0.0, 0.8)),
            Theme::Dark => (ON_DARK, (0.3, 1.0)),
        };
        let mut curves = if curves <= few.len() { few.to_vec() } else { scale(curves, range) };
        if has_sum {
            curves.insert(0, few[NEUTRAL]);
        }
        match theme {
            Theme::Light => Self {
                background: RGBColor(255, 255, 255),
                text: RGBColor(26, 26, 26),
                muted: RGBColor(89, 89, 89),
                axis: RGBColor(110, 110, 110),
                mesh: RGBColor(226, 226, 226),
                curves,
            },
            Theme::Dark => Self {
                background: RGBColor(22, 24, 29),
                text: RGBColor(236, 236, 236),
                muted: RGBColor(172, 176, 184),
                axis: RGBColor(140, 144, 152),
                mesh: RGBColor(52, 56, 64),
                curves,
            },
        }
    }

    /// Colour and width of a curve's line. Where there are several kinds of lines, those of the first are wide and pale, so
    /// that the others show on them.
    pub(super) fn line(&self, colour: usize, dash: usize, kinds: usize) -> (RGBColor, u32) {
        let colour = self.curves[colour % self.curves.len()];
        if kinds > 1 && dash == 0 { (between(colour, self.background, PALE), WIDE) } else { (colour, LINE) }
    }

    /// The same for a line that is no curve's.
    pub(super) fn sample(&self, dash: usize, kinds: usize) -> (RGBColor, u32) {
        let width = if kinds > 1 && dash == 0 { WIDE } else { LINE };
        (if width == WIDE { between(self.muted, self.background, PALE) } else { self.muted }, width)
    }
}

/// How much of the background pale lines have.
const PALE: f64 = 0.5;

/// A colour with a share of another.
fn between(colour: RGBColor, other: RGBColor, share: f64) -> RGBColor {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two of 0 to 255")]
    let mix = |a: u8, b: u8| (f64::from(a) * (1.0 - share) + f64::from(b) * share).round() as u8;
    RGBColor(mix(colour.0, other.0), mix(colour.1, other.1), mix(colour.2, other.2))
}

/// Colours in the order of a scale, which curves of many angles have.
fn scale(count: usize, (from, to): (f64, f64)) -> Vec<RGBColor> {
    let part = |index: usize| from + (to - from) * index as f64 / (count - 1) as f64;
    (0..count).map(|index| ViridisRGB.get_color(part(index))).collect()
}

/// Text of a size in pixels that starts at its point and hangs below it.
pub(super) fn letters(pixels: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, pixels * TENTHS * FONT_SIZE).into_font().color(&colour)
}

pub(super) fn bold(pixels: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, pixels * TENTHS * FONT_SIZE).into_font().style(FontStyle::Bold).color(&colour)
}

pub(super) fn placed(style: &TextStyle<'static>, horizontally: HPos, vertically: VPos) -> TextStyle<'static> {
    style.pos(Pos::new(horizontally, vertically))
}

/// The width of a text in ems, rather too large than too small.
pub(super) fn ems(text: &str) -> f64 {
    text.chars()
        .map(|letter| match letter {
            ' ' | '.' | ',' | 'i' | 'l' | 'j' | '(' | ')' | '\'' | ':' | ';' => 0.36,
            '⁰'..='⁹' | '⁻' | '¹' | '²' | '³' | 'r' | 't' | 'f' => 0.44,
            'm' | 'w' | 'M' | 'W' | '−' | '=' | '×' | '+' => 0.88,
            letter if letter.is_uppercase() => 0.72,
            _ => 0.62,
        })
        .sum()
}

/// Width of most lines of curves, tenths of a pixel.
pub(super) const LINE: u32 = 20;
/// Of the lines that others are compared with.
const WIDE: u32 = 42;

/// How the kinds of lines are dashed, tenths of a pixel: length and gap.
const DASHES: [Option<(i32, i32)>; 4] = [None, Some((120, 70)), Some((40, 50)), Some((180, 50))];

/// Draws a stretch of a curve, at units of the area.
pub(super) fn stroke(
    area: &Area,
    points: Vec<(i32, i32)>,
    (colour, width): (RGBColor, u32),
    dash: usize,
) -> Drawn {
    if let [only] = points[..] {
        area.draw(&Circle::new(only, 25, colour.filled()))?;
        return Ok(());
    }
    let line = colour.stroke_width(width);
    match DASHES[dash % DASHES.len()] {
        None => area.draw(&PathElement::new(points, line))?,
        Some((length, gap)) => area.draw(&DashedPathElement::new(points, length, gap, line))?,
    }
    Ok(())
}
