//! What stands at an axis: where it begins and ends, its marks, and how numbers are written.

use super::options::{Form, Options, Scale};
use super::thin::Point;
use super::{Curve, Plot};
use std::fmt::Write as _;

/// Marks of an axis, about.
const MARKS: f64 = 6.0;
/// Lobes diverge at grazing angles. Where what lies beyond this angle, degrees, is so many times larger than all the
/// rest, a linear axis ends at the rest.
const GRAZING: f64 = 80.0;
const MUCH_LARGER: f64 = 3.0;
/// Room above the largest value of such an axis.
const HEADROOM: f64 = 1.1;

/// The axis of the values. On a linear axis they are drawn in units of a power of ten, on a logarithmic one as their
/// logarithms.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ValueAxis {
    pub(super) least: f64,
    pub(super) largest: f64,
    pub(super) marks: Vec<Mark>,
    /// The power of ten in whose units the marks are.
    pub(super) exponent: i32,
    /// What is to be said of values that it does not show.
    pub(super) note: Option<String>,
    /// Whether any curve has a value to draw.
    pub(super) is_empty: bool,
    scale: Scale,
}

/// A mark and what is written at it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    pub(super) at: f64,
    pub(super) text: String,
}

impl ValueAxis {
    pub(super) fn new(plot: &Plot, options: &Options) -> Self {
        match options.scale {
            Scale::Linear => Self::linear(plot),
            Scale::Log10 => Self::logarithmic(&plot.curves, options.decades, options.form),
        }
    }

    fn linear(plot: &Plot) -> Self {
        let all = largest(&plot.curves, |_| true);
        let near = largest(&plot.curves, |point| point.0.abs() <= GRAZING);
        let is_cut = near > 0.0 && all > MUCH_LARGER * near;
        let top = if is_cut { near * HEADROOM } else { all };
        let note =
            is_cut.then(|| format!("Beyond ±{GRAZING:.0}° values up to {} leave the picture.", short(all)));
        let is_empty = all == f64::NEG_INFINITY;
        let top = if top > 0.0 { top } else { 1.0 };
        let magnitude = magnitude(top);
        let exponent = if (-2..=3).contains(&magnitude) { 0 } else { magnitude };
        let top = shifted(top, -exponent);
        let step = nice(top / MARKS, &[1.0, 2.0, 5.0]);
        let largest = (top / step - 1e-9).ceil() * step;
        Self {
            least: 0.0,
            largest,
            marks: marks((0.0, largest), step, |value, decimals| format!("{value:.decimals$}")),
            exponent,
            note,
            is_empty,
            scale: Scale::Linear,
        }
    }

    fn logarithmic(curves: &[Curve], decades: usize, form: Form) -> Self {
        let top = largest(curves, |_| true);
        let is_empty = top == f64::NEG_INFINITY;
        let (largest, bottom) = if is_empty { (0.0, -1.0) } else { (top.ceil(), least(curves).floor()) };
        // A curve of one value at a power of ten has room below it.
        let least = bottom.max(largest - decades as f64).min(largest - 1.0);
        let where_they_are = match form {
            Form::Cartesian => "leave the picture",
            Form::Polar => "are at the origin",
        };
        let note = (!is_empty && bottom < least)
            .then(|| format!("Values below 10{} {where_they_are}.", raised(&format!("{least:.0}"))));
        let step = nice((largest - least) / MARKS, &[1.0, 2.0, 5.0]).max(1.0);
        let text = |value: f64, _| format!("10{}", raised(&format!("{value:.0}")));
        Self {
            least,
            largest,
            marks: marks((least, largest), step, text),
            exponent: 0,
            note,
            is_empty,
            scale: Scale::Log10,
        }
    }

    /// Where a value stands on it.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => shifted(value, -self.exponent),
            Scale::Log10 => value,
        }
    }

    /// The points of a curve where they stand on it.
    pub(super) fn places<'a>(&'a self, curve: &'a Curve) -> impl Iterator<Item = Point> + 'a {
        curve.points.iter().map(|&(x, value)| (x, self.place(value)))
    }

    /// What the axis shows and in which unit.
    pub(super) fn label(&self, name: &str, unit: &str) -> String {
        let power = if self.exponent == 0 {
            String::new()
        } else {
            format!("10{}", raised(&self.exponent.to_string()))
        };
        match [power.as_str(), unit].join(" ").trim() {
            "" => name.to_owned(),
            unit => format!("{name} ({unit})"),
        }
    }
}

/// Marks of an axis of degrees.
pub(super) fn degrees((from, to): (f64, f64), most: f64) -> Vec<Mark> {
    let length = to - from;
    let steps = [10.0, 15.0, 30.0, 45.0, 90.0];
    let least = length / most;
    let step = if least > 5.0 {
        steps.into_iter().find(|&step| step >= least).unwrap_or(90.0)
    } else {
        nice(least, &[1.0, 2.0, 5.0])
    };
    let text = |value: f64, decimals: usize| minus(&format!("{value:.decimals$}"));
    if length > 0.0 {
        marks((from, to), step, text)
    } else {
        vec![Mark { at: from, text: minus(&from.to_string()) }]
    }
}

fn marks((from, to): (f64, f64), step: f64, text: impl Fn(f64, usize) -> String) -> Vec<Mark> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 17: a step of 1e-16 at 1"
    )]
    let decimals = (-step.log10().floor()).clamp(0.0, 17.0) as usize;
    #[expect(clippy::cast_possible_truncation, reason = "some marks: the step is a part of the length")]
    let [first, last] = [(from / step - 1e-6).ceil() as i64, (to / step + 1e-6).floor() as i64];
    (first..=last)
        .map(|count| {
            let at = count as f64 * step;
            Mark { at, text: text(at, decimals) }
        })
        .collect()
}

fn largest(curves: &[Curve], counts: impl Fn(&Point) -> bool) -> f64 {
    finite(curves).filter(|point| counts(point)).map(|point| point.1).fold(f64::NEG_INFINITY, f64::max)
}

fn least(curves: &[Curve]) -> f64 {
    finite(curves).map(|point| point.1).fold(f64::INFINITY, f64::min)
}

fn finite(curves: &[Curve]) -> impl Iterator<Item = &Point> {
    curves.iter().flat_map(|curve| &curve.points).filter(|point| point.1.is_finite())
}

/// The least of these numbers times a power of ten that is not below `least`.
fn nice(least: f64, of: &[f64]) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    of.iter().map(|part| part * power).find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// The power of ten of a number above 0.
fn magnitude(value: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "from -324 to 308")]
    let magnitude = (value.log10() + 1e-12).floor() as i32;
    magnitude
}

/// A number times a power of ten, in two steps: the power by itself may be beyond f64.
fn shifted(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    value * 10f64.powi(half) * 10f64.powi(exponent - half)
}

/// Three digits: 0.318, 1.92×10⁶.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let magnitude = magnitude(value.abs());
    if (-3..=3).contains(&magnitude) {
        #[expect(clippy::cast_sign_loss, reason = "not below 0")]
        let decimals = (2 - magnitude).max(0) as usize;
        return minus(&format!("{value:.decimals$}"));
    }
    minus(&format!("{:.2}×10{}", shifted(value, -magnitude), raised(&magnitude.to_string())))
}

/// A value of which the decimal logarithm is known.
pub(super) fn short_power(log10: f64) -> String {
    let exponent = (log10 + 1e-12).floor();
    if (-3.0..=3.0).contains(&exponent) {
        return short(10f64.powf(log10));
    }
    format!("{:.2}×10{}", 10f64.powf(log10 - exponent), raised(&format!("{exponent:.0}")))
}

/// A whole number as an exponent: ⁻¹².
pub(super) fn raised(number: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    number.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize])).collect()
}

/// The sign that a minus is.
pub(super) fn minus(number: &str) -> String {
    if number == "-0" { "0".to_owned() } else { number.replacen('-', "−", 1) }
}

/// A unit as it is printed: W m⁻² sr⁻¹.
pub(super) fn unit(ascii: &str) -> String {
    let mut text = String::with_capacity(ascii.len());
    for (index, part) in ascii.split('^').enumerate() {
        let digits = if index == 0 { 0 } else { part.find(' ').unwrap_or(part.len()) };
        // Writing to a string cannot fail.
        let _ = write!(text, "{}{}", raised(&part[..digits]), &part[digits..]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Curve, Form, ValueAxis, degrees, minus, short, short_power, unit};
    use crate::http::plot::Plot;

    fn plot(values: &[f64]) -> Plot {
        let points = values.iter().enumerate().map(|(index, &value)| (10.0 * index as f64, value)).collect();
        Plot { curves: vec![Curve { colour: 0, dash: 0, points }], ..Plot::default() }
    }

    fn texts(axis: &ValueAxis) -> Vec<&str> {
        axis.marks.iter().map(|mark| mark.text.as_str()).collect()
    }

    #[test]
    fn a_linear_axis_begins_at_0_and_ends_at_a_mark() {
        let axis = ValueAxis::linear(&plot(&[0.1, 0.83]));
        assert_eq!(texts(&axis), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let axis = ValueAxis::linear(&plot(&[4.2e17]));
        assert_eq!((axis.exponent, axis.largest), (17, 5.0));
        assert_eq!(axis.label("BRDF", "sr⁻¹"), "BRDF (10¹⁷ sr⁻¹)");
        assert!((axis.place(4.2e17) - 4.2).abs() < 1e-12);
        for (least, exponent) in [(5e-324, -324), (3e-310, -310), (1.7e308, 308)] {
            let axis = ValueAxis::linear(&plot(&[least]));
            assert_eq!(axis.exponent, exponent);
            assert!(axis.place(least) > 0.5 && axis.place(least) <= axis.largest, "{least}");
        }
    }

    #[test]
    fn what_diverges_at_grazing_angles_does_not_flatten_the_rest() {
        let mut values = vec![1.0; 10];
        values[9] = 500.0;
        let axis = ValueAxis::linear(&plot(&values));
        assert!(axis.largest < 2.0 && axis.note.is_some_and(|note| note.contains("500")));
        values[9] = 2.0;
        assert_eq!(ValueAxis::linear(&plot(&values)).note, None);
    }

    #[test]
    fn a_logarithmic_axis_shows_whole_decades() {
        let axis = ValueAxis::logarithmic(&plot(&[-2.5, 0.3]).curves, 12, Form::Cartesian);
        assert_eq!(texts(&axis), ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        let axis = ValueAxis::logarithmic(&plot(&[-36061.0, 3.0]).curves, 12, Form::Cartesian);
        assert_eq!((axis.least, axis.largest), (-9.0, 3.0));
        assert_eq!(axis.note.as_deref(), Some("Values below 10⁻⁹ leave the picture."));
        let axis = ValueAxis::logarithmic(&plot(&[-36061.0, 3.0]).curves, 100_000, Form::Cartesian);
        assert!(axis.marks.len() < 10 && axis.note.is_none());
        let axis = ValueAxis::logarithmic(&plot(&[2.0, 2.0]).curves, 12, Form::Cartesian);
        assert_eq!((axis.least, axis.largest), (1.0, 2.0));
    }

    #[test]
    fn nothing_to_draw_has_axes_all_the_same() {
        for axis in [
            ValueAxis::linear(&plot(&[f64::NAN])),
            ValueAxis::logarithmic(&plot(&[f64::NEG_INFINITY]).curves, 12, Form::Cartesian),
        ] {
            assert!(axis.is_empty && axis.largest > axis.least && axis.marks.len() > 1, "{axis:?}");
        }
        let zero = ValueAxis::linear(&plot(&[0.0, 0.0]));
        assert_eq!((zero.is_empty, zero.largest), (false, 1.0));
    }

    #[test]
    fn degrees_are_marked_where_one_expects_them() {
        let texts = |ends| degrees(ends, 8.0).into_iter().map(|mark| mark.text).collect::<Vec<_>>();
        assert_eq!(texts((-89.5, 89.5)), ["−60", "−30", "0", "30", "60"]);
        assert_eq!(texts((20.0, 40.0)), ["20", "25", "30", "35", "40"]);
        assert_eq!(texts((30.0, 30.0)), ["30"]);
        assert_eq!(texts((29.9999, 30.0001)).first().map(String::as_str), Some("29.99990"));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 0.3179, 12.0, 1.92e6, 4e-9, -0.5].map(short),
            ["0", "0.318", "12.0", "1.92×10⁶", "4.00×10⁻⁹", "−0.500"]
        );
        assert_eq!(short_power(-1703.9238319931344), "1.19×10⁻¹⁷⁰⁴");
        assert_eq!(short_power(0.0), "1.00");
        assert_eq!(unit("W m^-2 sr^-1"), "W m⁻² sr⁻¹");
        assert_eq!(unit("sr^-1"), "sr⁻¹");
        assert_eq!(unit(""), "");
        assert_eq!(minus("-0"), "0");
    }
}
