//! Answers as pictures: every row is evaluated on the pool, a piece at a time, of which only the points are kept that the
//! line needs; the picture is drawn last.

use super::Call;
use super::columns::headings;
use super::output::{self, End, Output};
use super::work::{Curve, Over, Subject, Work};
use crate::http::compute::admission::Turn;
use crate::http::compute::job::Job;
use crate::http::edge::Asked;
use crate::http::negotiate::VARY;
use crate::http::plot::{self, Columns, MOST_CURVES, Options, Picture, Plot, Point, Scale, Shown, Words};
use crate::http::problem::{Code, FieldError, Problem};
use crate::reflectance::diagram::Sweep;
use crate::reflectance::scene::Component;
use axum::http::{HeaderValue, header};
use axum::response::Response;
use futures_util::{StreamExt as _, pin_mut};
use std::ops::Range;
use std::sync::Arc;

/// A part of a curve: which curve, which kind of its columns (0 for the total), and points.
type Part = (usize, usize, Vec<Point>);

/// Draws the diagram of a scene over a sweep.
pub(crate) async fn respond(
    call: Call,
    turn: Option<Turn>,
    mut work: Work,
    (picture, options): (Picture, Options),
) -> Result<Response, Problem> {
    let Call { app, format, deadline } = call;
    work.check(app.limits()).map_err(Problem::invalid)?;
    if work.curves() > MOST_CURVES {
        let detail = format!("{} series in one picture: at most {MOST_CURVES} are drawn", work.curves());
        let error = FieldError { pointer: "/at_deg".to_owned(), code: Code::TooMany, detail };
        return Err(Problem::invalid(vec![error]));
    }
    if let Subject::Scene { output, .. } = &mut work.subject {
        output.log10 = options.scale == Scale::Log10;
        output.per_direction = false;
    }
    work.meter = app.edge().meter();
    let asked = Asked(work.rows());
    if work.nanoseconds(None) > 2e9 * app.limits().cpu_time.as_secs_f64() {
        return Err(output::cpu_time(&app));
    }
    let turn = match turn {
        Some(turn) => turn,
        None => app.admission().turn().await?,
    };
    let work = Arc::new(work);
    let make = move |output| make(work, picture, options, output);
    let mut response = output::begin(&app, deadline, turn, format.content_type(), make).await?;
    response.headers_mut().insert(header::VARY, HeaderValue::from_static(VARY));
    response.extensions_mut().insert(asked);
    Ok(response)
}

async fn make(work: Arc<Work>, picture: Picture, options: Options, output: Output) -> Result<(), End> {
    let mut plot = frame(&work)?;
    // At most a total and three components of each.
    let columns = Columns::new(plot.ends, options.width, 4 * work.curves());
    let shown = options.shown.unwrap_or(Shown::natural(work.curves()));
    let mut parts: Vec<Part> = Vec::new();
    {
        let groups: Box<dyn Iterator<Item = (Range<usize>, bool)> + Send> = match work.groups(None) {
            Some(groups) => Box::new(groups.map(|curves| (curves, true))),
            None => Box::new((0..work.curves()).map(|index| (index..index + 1, false))),
        };
        for (curves, is_whole) in groups {
            if is_whole {
                let of_group = Arc::clone(&work);
                let drawn =
                    output.run(move |job: &Job| whole(&of_group, curves, columns, shown, job)).await?;
                parts.append(&mut drawn?);
                continue;
            }
            let of_curve = Arc::clone(&work);
            let index = curves.start;
            let curve = output.run(move |job: &Job| of_curve.prepare(index, || job.is_stopped())).await??;
            let curve = Arc::new(curve);
            let pieces = output.run_all(work.pieces_of_a_column().map(|points| {
                let (work, curve) = (Arc::clone(&work), Arc::clone(&curve));
                move |job: &Job| part(&work, (index, &curve), points, (columns, shown), job)
            }));
            pin_mut!(pieces);
            while let Some(piece) = pieces.next().await {
                parts.append(&mut piece??);
            }
        }
    }
    gather(&mut plot, parts, work.curves());
    let drawn = output.run(move |_| plot::draw(&plot, picture, &options)).await??;
    output.send(drawn).await
}

/// Some whole curves.
fn whole(
    work: &Work,
    curves: Range<usize>,
    columns: Columns,
    shown: Shown,
    job: &Job,
) -> Result<Vec<Part>, Problem> {
    let mut parts = Vec::new();
    for index in curves {
        let curve = work.prepare(index, || job.is_stopped())?;
        parts.append(&mut part(work, (index, &curve), 0..work.points(), (columns, shown), job)?);
    }
    Ok(parts)
}

/// Some points of a curve; nothing where nobody waits for them.
fn part(
    work: &Work,
    (index, curve): (usize, &Curve),
    points: Range<usize>,
    (columns, shown): (Columns, Shown),
    job: &Job,
) -> Result<Vec<Part>, Problem> {
    let Over::Sweep(sweep) = &work.over else { return Ok(Vec::new()) };
    let positions = &sweep.positions()[points.clone()];
    let stretch = work.stretch(curve, points, || job.is_stopped())?;
    if job.is_stopped() {
        return Ok(Vec::new());
    }
    let names = headings(curve.components(), work.quantity(), work.output());
    let is_log = work.output().log10;
    let mut drawn: Vec<(usize, usize)> = Vec::new();
    for (kind, name) in kinds(is_log).into_iter().enumerate() {
        drawn.extend(names.iter().position(|(other, _)| *other == name).map(|place| (kind, place)));
    }
    plot::keep_shown(&mut drawn, |(kind, _)| *kind, shown);
    let thin = |(kind, place): (usize, usize)| {
        let values = stretch.numbers[place].iter().copied();
        (index, kind, columns.thin(positions.iter().copied().zip(values)))
    };
    Ok(drawn.into_iter().map(thin).collect())
}

/// The columns that can be drawn: the total, then the components.
fn kinds(is_log: bool) -> [&'static str; 4] {
    let [diffuse, lobe, spike] =
        Component::ALL.map(|component| if is_log { component.log10_name() } else { component.name() });
    [if is_log { "log10_total" } else { "total" }, diffuse, lobe, spike]
}

/// The plot without its curves.
fn frame(work: &Work) -> Result<Plot, Problem> {
    let (Subject::Scene { scene, light, quantity, .. }, Over::Sweep(sweep)) = (&work.subject, &work.over)
    else {
        tracing::error!("only sweeps of a scene are drawn");
        return Err(Problem::internal());
    };
    let words = Words::of(scene, light, *quantity, sweep);
    let colours = (0..work.curves()).map(|index| label(work, sweep, index)).collect();
    Ok(Plot { colours, ..Plot::framed(words, *quantity, sweep) })
}

/// What tells a curve from the others.
fn label(work: &Work, sweep: &Sweep, index: usize) -> String {
    let angles = sweep.at().len();
    let wavelength = work.spectrum().map(|lines| lines[index / angles].wavelength);
    plot::curve_label(sweep, (angles > 1).then(|| sweep.at()[index % angles]), wavelength)
}

/// Puts parts together that came in the order of the sweep, and gives each curve its colour and kind of line.
fn gather(plot: &mut Plot, parts: Vec<Part>, curves: usize) {
    let is_alone = curves == 1;
    for (index, kind, mut points) in parts {
        let (colour, dash) = if is_alone { (kind, 0) } else { (index, kind) };
        match plot.curves.iter_mut().rev().take(4).find(|curve| (curve.colour, curve.dash) == (colour, dash))
        {
            Some(curve) => curve.points.append(&mut points),
            None => plot.curves.push(plot::Curve { colour, dash, points }),
        }
    }
    let kinds = [[plot::TOTAL].as_slice(), &Component::ALL.map(plot::component)].concat();
    let kinds: Vec<String> = kinds.into_iter().map(str::to_owned).collect();
    if is_alone {
        plot.colours = kinds;
    } else {
        plot.dashes = kinds;
    }
    plot.without_unused();
}
