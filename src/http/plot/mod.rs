//! Pictures of diagrams: what they show, and how it is drawn.
//!
//! plotters draws lines, marks and text as SVG; `svg.rs` makes a document of it that says what it shows, `png.rs` has
//! resvg turn that into pixels, with a font of its own. Coordinates are in tenths of a pixel of a picture of
//! usual size, since plotters places things at whole units.

mod cartesian;
mod header;
mod options;
mod png;
mod polar;
mod style;
mod svg;
mod tables;
mod thin;
mod ticks;
mod words;

pub(crate) use options::{Form, MOST_PIXELS, Options, PlotWire, Scale, Shown};
pub(crate) use tables::of_figure;
pub(crate) use thin::{Columns, Point};
pub(crate) use words::{Words, component, curve_label};

use super::problem::Problem;
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea as _};
use style::{Style, TENTHS, tenths};
use thin::runs;
use ticks::ValueAxis;

/// Curves of one picture: more could not be told apart, however large it is.
pub(crate) const MOST_CURVES: usize = 400;

/// What the sum of the components is called.
pub(crate) const TOTAL: &str = "total";

/// What pictures come as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Picture {
    Svg,
    Png,
}

/// What a picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Plot {
    /// What and of what model.
    pub(crate) title: String,
    /// The parameters.
    pub(crate) parameters: String,
    /// What the values are.
    pub(crate) quantity: &'static str,
    /// Their unit.
    pub(crate) unit: String,
    /// The symbol of the swept angle, and what it is.
    pub(crate) axis: (&'static str, &'static str),
    /// Where it begins and ends, degrees.
    pub(crate) ends: (f64, f64),
    /// What the fixed direction is, and its zenith angle where there is only one, degrees.
    pub(crate) fixed: Option<(&'static str, f64)>,
    /// What the curves of one colour have in common.
    pub(crate) colours: Vec<String>,
    /// What the curves of one kind of line have in common; empty or one where there is one kind.
    pub(crate) dashes: Vec<String>,
    /// The curves.
    pub(crate) curves: Vec<Curve>,
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Which of the plot's colours.
    pub(crate) colour: usize,
    /// Which of its kinds of lines.
    pub(crate) dash: usize,
    /// Degrees, and the value or on a logarithmic scale its decimal logarithm.
    pub(crate) points: Vec<Point>,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error + Send + Sync>>;

/// Draws it.
pub(crate) fn draw(plot: &Plot, picture: Picture, options: &Options) -> Result<Vec<u8>, Problem> {
    let values = ValueAxis::new(plot, options);
    let has_sum = plot.colours.len() > 1 && plot.colours[0] == TOTAL;
    let style = Style::of(options.theme, plot.colours.len(), has_sum);
    let mut inside = String::new();
    let drawn = on(&mut inside, plot, &values, &style, options);
    drawn.map_err(|error| {
        tracing::error!(%error, "a plot could not be drawn");
        Problem::internal()
    })?;
    let document = svg::document(&inside, plot, &values, options);
    match picture {
        Picture::Svg => Ok(document.into_bytes()),
        Picture::Png => png::of(&document),
    }
}

fn on(text: &mut String, plot: &Plot, values: &ValueAxis, style: &Style, options: &Options) -> Drawn {
    let root = SVGBackend::with_string(text, options.units()).into_drawing_area();
    root.fill(&style.background)?;
    let below = header::draw(&root, plot, values, style)?;
    let (_, area) = root.split_vertically(below);
    match options.form {
        Form::Cartesian => cartesian::draw(&area, plot, values, style)?,
        Form::Polar => polar::draw(&area, plot, values, style)?,
    }
    root.present()?;
    Ok(())
}

impl Plot {
    /// Without colours and kinds of lines that no curve has.
    pub(crate) fn without_unused(&mut self) {
        let Self { colours, dashes, curves, .. } = self;
        drop_unused(colours, curves, |curve| &mut curve.colour);
        drop_unused(dashes, curves, |curve| &mut curve.dash);
    }
}

fn drop_unused(texts: &mut Vec<String>, curves: &mut [Curve], place: fn(&mut Curve) -> &mut usize) {
    let mut used: Vec<usize> = curves.iter_mut().map(|curve| *place(curve)).collect();
    used.sort_unstable();
    used.dedup();
    for curve in curves {
        let place = place(curve);
        *place = used.binary_search(place).unwrap_or_default();
    }
    *texts = used.iter().filter_map(|&index| texts.get(index).cloned()).collect();
}

/// Keeps of total (kind 0) and components what is to be shown. A component that is alone is the total.
pub(crate) fn keep_shown<T>(columns: &mut Vec<T>, kind: impl Fn(&T) -> usize, shown: Shown) {
    let is_alone = columns.len() <= 2;
    match shown {
        Shown::Total => columns.retain(|column| kind(column) == 0),
        Shown::All if !is_alone => {}
        Shown::Components | Shown::All => columns.retain(|column| kind(column) > 0),
    }
}
