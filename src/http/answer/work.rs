//! What is to be evaluated for one answer: a scene over directions, or over the curves of a sweep.

use super::columns::Stretch;
use crate::http::api::light::{Light, Line};
use crate::http::app::Limits;
use crate::http::edge::Meter;
use crate::http::encode::rows::RowFormat;
use crate::http::problem::{Code, FieldError, Problem};
use crate::reflectance::bounds::{MAX_AVERAGED, MAX_RECEIVED, MAX_SERIES};
use crate::reflectance::diagram::Sweep;
use crate::reflectance::directions::{AngleColumn, Directions};
use crate::reflectance::evaluate::{Output, Prepared, Quantity, average_cost, expected_cost};
use crate::reflectance::findings::Warning;
use crate::reflectance::linear_image::LinearScene;
use crate::reflectance::material::Lookup;
use crate::reflectance::quantity::OutOfBounds;
use crate::reflectance::scene::{Component, Scene};
use std::ops::Range;
use std::sync::Arc;

/// Nanoseconds of one vectorised exponential, the unit of [`expected_cost`].
const EXPONENTIAL: f64 = 3.5;
/// Nanoseconds of a direction of a linear model.
const LINEAR: f64 = 400.0;
/// Nanoseconds of one number in JSON.
const NUMBER: f64 = 30.0;
/// Nanoseconds of a curve besides its rows: what it requires, its warnings and their text.
const CURVE: f64 = 5e3;
/// Nanoseconds of a piece of work for the pool: a change of threads costs a fortieth of it.
const PIECE: f64 = 1e6;
/// Rows of a piece: not so few that the changes of threads show, nor so many that text and columns take memory.
const LEAST_ROWS: usize = 128;
const MOST_ROWS: usize = 16 << 10;

/// What is asked for.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    pub(super) subject: Subject,
    pub(super) over: Over,
    /// Whether tables begin with the columns of the angles.
    pub(crate) has_angles: bool,
    /// Counts what is evaluated.
    pub(super) meter: Meter,
}

/// Of what.
#[derive(Clone, Debug)]
pub(crate) enum Subject {
    Scene { scene: Box<Scene>, light: Light, quantity: Quantity, output: Output },
    Linear { scene: Arc<LinearScene>, log10: bool },
}

/// Where.
#[derive(Clone, Debug)]
pub(crate) enum Over {
    Directions(Box<Directions>),
    Sweep(Box<Sweep>),
}

/// One curve made ready; directions without a sweep are one curve, at each wavelength.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// The wavelength, if there is one of several.
    pub(super) line: Option<Line>,
    /// The fixed angle of a sweep.
    pub(super) at_deg: Option<f64>,
    pub(super) model: Model,
}

/// What makes the numbers of a curve.
#[derive(Clone, Debug)]
pub(super) enum Model {
    Scene(Arc<Prepared>),
    Linear { scene: Arc<LinearScene>, log10: bool },
}

impl Work {
    pub(crate) fn new(subject: Subject, over: Over) -> Self {
        Self { subject, over, has_angles: true, meter: Meter::default() }
    }

    pub(super) fn rows(&self) -> usize {
        let rows = match &self.over {
            Over::Directions(directions) => directions.count(),
            Over::Sweep(sweep) => sweep.rows(),
        };
        rows * self.spectrum().map_or(1, <[Line]>::len)
    }

    /// The wavelengths, if there may be several.
    pub(super) fn spectrum(&self) -> Option<&[Line]> {
        match &self.subject {
            Subject::Scene { light: Light::Spectrum(lines), .. } => Some(lines),
            Subject::Scene { light: Light::One(_), .. } | Subject::Linear { .. } => None,
        }
    }

    /// What was looked up at the only wavelength.
    pub(super) fn looked_up(&self) -> Option<Lookup> {
        match &self.subject {
            Subject::Scene { light: Light::One(lookup), .. } => *lookup,
            Subject::Scene { light: Light::Spectrum(_), .. } | Subject::Linear { .. } => None,
        }
    }

    /// Rows of each curve.
    pub(super) fn points(&self) -> usize {
        match &self.over {
            Over::Directions(directions) => directions.count(),
            Over::Sweep(sweep) => sweep.positions().len(),
        }
    }

    /// Curves of each wavelength.
    fn fixed_angles(&self) -> usize {
        match &self.over {
            Over::Directions(_) => 1,
            Over::Sweep(sweep) => sweep.at().len(),
        }
    }

    /// All curves, those of one wavelength together.
    pub(super) fn curves(&self) -> usize {
        self.fixed_angles() * self.spectrum().map_or(1, <[Line]>::len)
    }

    pub(super) fn quantity(&self) -> Quantity {
        match self.subject {
            Subject::Scene { quantity, .. } => quantity,
            Subject::Linear { .. } => Quantity::ImageIrradiance { factor: 1.0 },
        }
    }

    pub(super) fn output(&self) -> Output {
        match self.subject {
            Subject::Scene { output, .. } => output,
            Subject::Linear { log10, .. } => Output { log10, per_direction: false },
        }
    }

    /// What is wrong with it by the limits of this service, which may be below those of the document.
    pub(super) fn check(&self, limits: &Limits) -> Result<(), Vec<FieldError>> {
        let lines = self.spectrum().map_or(1, <[Line]>::len);
        let (pointer, what, whats, limit) = match self.over {
            Over::Directions(_) => {
                ("/geometry", "directions", "rows (directions times wavelengths)", limits.directions)
            }
            Over::Sweep(_) => (
                "/at_deg",
                "rows (points times fixed angles)",
                "rows (points times fixed angles times wavelengths)",
                limits.rows,
            ),
        };
        let (rows, series) = (self.rows(), self.curves());
        let (number, what, limit) = if rows / lines > limit {
            (rows / lines, what, limit)
        } else if rows > limits.rows && lines > 1 {
            (rows, whats, limits.rows)
        } else if series > MAX_SERIES {
            (series, "series (fixed angles times wavelengths)", MAX_SERIES)
        } else if self.is_received() && rows > MAX_RECEIVED {
            (rows, "rows with a receiver_half_angle_deg", MAX_RECEIVED)
        } else {
            let what = "zeniths of the source, over all series, with fresnel_average slope_average";
            (self.averaged_sources(), what, MAX_AVERAGED)
        };
        if number <= limit {
            return Ok(());
        }
        let detail = format!("{number} {what} in one request: at most {limit} are answered");
        Err(vec![FieldError { pointer: pointer.to_owned(), code: Code::TooMany, detail }])
    }

    /// Whether each row is the mean over a receiver's cone.
    fn is_received(&self) -> bool {
        match &self.subject {
            Subject::Scene { scene, .. } => scene.parameters().receiver.is_some(),
            Subject::Linear { .. } => false,
        }
    }

    /// Zeniths of the source under which F is averaged over the slopes, at each wavelength anew.
    fn averaged_sources(&self) -> usize {
        let sources = match &self.subject {
            Subject::Scene { scene, .. } if scene.averages_slopes() => match &self.over {
                Over::Directions(directions) => directions.distinct_sources(),
                Over::Sweep(sweep) => sweep.sources(),
            },
            Subject::Scene { .. } | Subject::Linear { .. } => 0,
        };
        sources * self.spectrum().map_or(1, <[Line]>::len)
    }

    /// Finds what a curve requires, `index` below [`Self::curves`]; `is_over` says whether to stop.
    pub(super) fn prepare(&self, index: usize, is_over: impl Fn() -> bool) -> Result<Curve, Problem> {
        let at_deg = match &self.over {
            Over::Directions(_) => None,
            Over::Sweep(sweep) => Some(sweep.at()[index % self.fixed_angles()]),
        };
        let line = self.spectrum().map(|lines| lines[index / self.fixed_angles()]);
        let model = match &self.subject {
            Subject::Linear { scene, log10 } => Model::Linear { scene: Arc::clone(scene), log10: *log10 },
            Subject::Scene { scene, quantity, output, .. } => {
                let lit = line.map(|line| scene.with_light(line.wavelength, line.index()));
                let scene = lit.as_ref().unwrap_or(scene);
                let prepared =
                    |directions: &_| Prepared::new(scene, directions, *quantity, *output, &is_over);
                Model::Scene(Arc::new(match &self.over {
                    Over::Directions(directions) => prepared(directions),
                    Over::Sweep(sweep) => {
                        let all = 0..sweep.positions().len();
                        prepared(&sweep.directions(at_deg.unwrap_or_default(), all).map_err(left_range)?)
                    }
                }))
            }
        };
        Ok(Curve { line, at_deg, model })
    }

    /// What the caller should know of a curve whatever its values are.
    pub(super) fn warnings(&self, curve: &Curve) -> Result<Vec<Warning>, Problem> {
        let Model::Scene(prepared) = &curve.model else { return Ok(Vec::new()) };
        Ok(match &self.over {
            Over::Directions(directions) => prepared.warnings(directions),
            Over::Sweep(sweep) => {
                let at = curve.at_deg.unwrap_or_default();
                prepared.warnings(&sweep.directions(at, 0..self.points()).map_err(left_range)?)
            }
        })
    }

    /// Evaluates a range of a curve's points; `is_over` says whether to stop.
    pub(super) fn stretch(
        &self,
        curve: &Curve,
        range: Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Result<Stretch, Problem> {
        let (before, part);
        let (directions, range) = match &self.over {
            Over::Directions(directions) => {
                before = 0;
                (directions.as_ref(), range)
            }
            Over::Sweep(sweep) => {
                before = range.start;
                let at = curve.at_deg.unwrap_or_default();
                part = sweep.directions(at, range.clone()).map_err(left_range)?;
                (&part, 0..range.len())
            }
        };
        let stretch: Stretch = match &curve.model {
            Model::Scene(prepared) => {
                prepared.stretch(directions, range, is_over).into_parts_after(before).into()
            }
            Model::Linear { scene, log10 } => {
                let mut evaluation = scene.evaluate(directions, range, *log10, is_over);
                evaluation.diagnostics.iter_mut().for_each(|diagnostic| diagnostic.index += before);
                evaluation.into()
            }
        };
        self.meter.add(&stretch.tally);
        Ok(stretch)
    }

    /// The three angles of a range of a curve's points: θ_i, θ_r and φ_r, or the fixed and the swept angle and φ_r.
    pub(super) fn angles(&self, curve: &Curve, range: Range<usize>) -> [AngleColumn; 3] {
        match &self.over {
            Over::Directions(directions) => directions.columns(range),
            Over::Sweep(sweep) => [
                AngleColumn::One(curve.at_deg.unwrap_or_default()),
                AngleColumn::Each(sweep.positions()[range].to_vec()),
                AngleColumn::One(sweep.phi_r()),
            ],
        }
    }

    /// Nanoseconds of one row, before what it requires is known: good to a factor of two.
    pub(super) fn nanoseconds_a_row(&self, format: Option<RowFormat>) -> f64 {
        let numbers = if self.output().log10 { 8.0 } else { 4.0 };
        self.evaluation() + numbers * format.map_or(NUMBER, RowFormat::nanoseconds_a_number)
    }

    /// Nanoseconds of all of it, likewise.
    pub(super) fn nanoseconds(&self, format: Option<RowFormat>) -> f64 {
        self.nanoseconds_a_row(format) * self.rows() as f64
            + self.nanoseconds_a_curve() * self.curves() as f64
    }

    /// Of a curve, those besides its rows.
    fn nanoseconds_a_curve(&self) -> f64 {
        let averages = average_cost(self.averaged_sources()) / self.curves() as f64;
        CURVE + EXPONENTIAL * averages
    }

    /// Consecutive curves that are about a millisecond of work together; none where one is that much by itself.
    pub(super) fn groups(
        &self,
        format: Option<RowFormat>,
    ) -> Option<impl Iterator<Item = Range<usize>> + Send + use<>> {
        let curve = self.nanoseconds_a_row(format) * self.points() as f64 + self.nanoseconds_a_curve();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and small")]
        let together = (PIECE / curve) as usize;
        let curves = self.curves();
        (together > 1 && curves > 1)
            .then(|| (0..curves).step_by(together).map(move |first| first..curves.min(first + together)))
    }

    /// Of a row, those of the evaluation.
    fn evaluation(&self) -> f64 {
        match &self.subject {
            Subject::Scene { scene, output, .. } => EXPONENTIAL * expected_cost(scene, *output),
            Subject::Linear { .. } => LINEAR,
        }
    }

    /// The ranges of a curve's points that are about a millisecond of work each, if whole rows are made of them.
    pub(super) fn pieces(&self, format: RowFormat) -> impl Iterator<Item = Range<usize>> + Send + use<> {
        self.ranges(self.nanoseconds_a_row(Some(format)))
    }

    /// The same if they are evaluated and one column is written.
    pub(super) fn pieces_of_a_column(&self) -> impl Iterator<Item = Range<usize>> + Send + use<> {
        self.ranges(self.evaluation() + NUMBER)
    }

    fn ranges(&self, nanoseconds_a_row: f64) -> impl Iterator<Item = Range<usize>> + Send + use<> {
        let least = if self.is_received() { 1 } else { LEAST_ROWS };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped at once")]
        let piece = ((PIECE / nanoseconds_a_row) as usize).clamp(least, MOST_ROWS);
        let points = self.points();
        (0..points).step_by(piece).map(move |first| first..points.min(first + piece))
    }
}

impl Curve {
    /// The components that are evaluated, in the model's order.
    pub(super) fn components(&self) -> &[Component] {
        match &self.model {
            Model::Scene(prepared) => prepared.components(),
            Model::Linear { .. } => &Component::ALL,
        }
    }
}

fn left_range(error: OutOfBounds) -> Problem {
    tracing::error!(%error, "a checked sweep left its range");
    Problem::internal()
}
