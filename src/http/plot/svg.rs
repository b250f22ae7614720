//! The document around what plotters draws: size in pixels, a title and a description, letters once for all.

use super::options::{Options, Scale};
use super::style::{FONT, LINE};
use super::ticks::{ValueAxis, short, short_power};
use super::{Curve, Plot};
use std::fmt::Write as _;

/// Curves that a description speaks of one by one.
const DESCRIBED: usize = 12;

/// Makes a document of it.
pub(super) fn document(drawn: &str, plot: &Plot, values: &ValueAxis, options: &Options) -> String {
    let Options { width, height, .. } = options;
    let mut text = String::with_capacity(drawn.len());
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {} {}\" role=\"img\" font-family=\"{FONT}\" fill=\"none\" stroke-width=\"{LINE}\" stroke-linejoin=\"round\">\n<title>{}</title>\n\
         <desc>{}</desc>\n",
        options.units().0,
        options.units().1,
        escaped(&plot.title),
        escaped(&description(plot, values, options)),
    );
    // What every element says again.
    let family = format!(" font-family=\"{FONT}\"");
    let width = format!(" stroke-width=\"{LINE}\"");
    let short =
        |line: &str| line.replace(" opacity=\"1\"", "").replace(" fill=\"none\"", "").replace(&width, "");
    // The first line is plotters' own beginning, the last its end.
    let mut lines = drawn.lines().skip(1).peekable();
    while let Some(line) = lines.next() {
        if line.starts_with("<text") {
            let said = lines.next().unwrap_or_default();
            let _ = writeln!(text, "{}{}</text>", short(&line.replace(&family, "")), lowered(said));
            lines.next();
        } else {
            let _ = writeln!(text, "{}", short(line).replace(" \"/>", "\"/>"));
        }
    }
    text
}

/// What there is to see, for those who do not.
fn description(plot: &Plot, values: &ValueAxis, options: &Options) -> String {
    let scale = match options.scale {
        Scale::Linear => "linear",
        Scale::Log10 => "logarithmic",
    };
    let (symbol, name) = plot.axis;
    let (from, to) = plot.ends;
    let quantity = [plot.quantity, plot.unit.as_str()].join(" ");
    let mut text = format!(
        "{} ({scale} scale) over the {} {symbol} from {from}° to {to}°. {}.",
        quantity.trim(),
        name.to_lowercase(),
        plot.parameters
    );
    for curve in plot.curves.iter().take(DESCRIBED) {
        let _ = write!(text, " {}: {}.", label(plot, curve), extremes(curve, options.scale));
    }
    if plot.curves.len() > DESCRIBED {
        let _ = write!(text, " And {} curves more.", plot.curves.len() - DESCRIBED);
    }
    if let Some(note) = &values.note {
        let _ = write!(text, " {note}");
    }
    text
}

fn label(plot: &Plot, curve: &Curve) -> String {
    let of = |texts: &[String], index: usize| texts.get(index).cloned().unwrap_or_default();
    let dash = if plot.dashes.len() > 1 { of(&plot.dashes, curve.dash) } else { String::new() };
    let parts = [of(&plot.colours, curve.colour), dash];
    let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "The curve".to_owned() } else { parts.join(", ") }
}

fn extremes(curve: &Curve, scale: Scale) -> String {
    let finite = curve.points.iter().filter(|point| point.1.is_finite());
    let largest = finite.max_by(|a, b| a.1.total_cmp(&b.1));
    let written = if scale == Scale::Log10 { short_power } else { short };
    largest.map_or_else(
        || "no value to draw".to_owned(),
        |&(angle, value)| format!("largest {} at {}°", written(value), (angle * 1e3).round() / 1e3),
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A text whose indices (σ_h, c·a_f) are set lower. The text after one has to be raised again.
fn lowered(text: &str) -> String {
    let mut parts = text.split('_');
    let mut before = parts.next().unwrap_or_default();
    let mut set = before.to_owned();
    for part in parts {
        let length = part.chars().next().map_or(0, char::len_utf8);
        let (index, rest) = part.split_at(length);
        let _ = if before.ends_with(['σ', 'θ', 'φ']) || before.ends_with("·a") {
            let rest =
                if rest.is_empty() { String::new() } else { format!("<tspan dy=\"-0.15em\">{rest}</tspan>") };
            write!(set, "<tspan dy=\"0.2em\" font-size=\"75%\">{index}</tspan>{rest}")
        } else {
            write!(set, "_{part}")
        };
        before = part;
    }
    set
}

#[cfg(test)]
mod tests {
    use super::lowered;

    #[test]
    fn indices_are_lowered_and_nothing_else() {
        let low = |index: &str| format!("<tspan dy=\"0.2em\" font-size=\"75%\">{index}</tspan>");
        assert_eq!(lowered("σ_h"), format!("σ{}", low("h")));
        let [h, alpha] = [low("h"), low("α")];
        assert_eq!(
            lowered("σ_h/T, σ_α = 3°"),
            format!("σ{h}<tspan dy=\"-0.15em\">/T, σ</tspan>{alpha}<tspan dy=\"-0.15em\"> = 3°</tspan>")
        );
        assert_eq!(lowered("a_b, no index"), "a_b, no index");
        assert_eq!(lowered("plain"), "plain");
    }
}
