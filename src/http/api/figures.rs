//! `GET /v1/figures` and `GET /v1/figures/{id}`: the report's diagrams with their captions' parameters.

use super::figure_links::links;
use super::responses::{GetProblems, list};
use crate::http::app::App;
use crate::http::compute;
use crate::http::edge::Deadline;
use crate::http::encode::rows::{Binary, RowFormat};
use crate::http::encode::table::Diagram;
use crate::http::encode::{flat, json};
use crate::http::input::object::object;
use crate::http::input::query::{NoQuery, Query};
use crate::http::link::{Known, linked};
use crate::http::negotiate::{Drawable, Format, JsonOnly};
use crate::http::plot::{self, Form, Options, Picture, PlotWire, Scale};
use crate::http::problem::{Kind, Problem};
use crate::reflectance::figures::{FIGURES, Figure, find};
use crate::reflectance::quantity::OutOfBounds;
use axum::extract::rejection::PathRejection;
use axum::extract::{Path, State};
use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::openapi::{RefOr, Response as Documented};
use utoipa::{IntoResponses, ToSchema};

/// A figure that can be computed.
#[derive(Serialize, ToSchema)]
pub(crate) struct FigureSummary {
    /// `11a` … `24`.
    #[schema(example = "13a")]
    id: &'static str,
    /// What the caption says it shows.
    title: &'static str,
    /// The parameters, and where they come from if not from the caption.
    parameters: &'static str,
    /// Where it is.
    #[schema(example = "/v1/figures/13a")]
    href: String,
    /// The diagrams that it is made of, as links: from there every parameter can be changed. None for figures 18 and 19,
    /// which plot a formula.
    diagrams: Vec<String>,
}

/// The figures that the report computes.
#[derive(Serialize, ToSchema)]
pub(crate) struct FigureList {
    /// In the report's order.
    figures: Vec<FigureSummary>,
}

/// A figure of the report, computed.
#[derive(Serialize, ToSchema)]
pub(crate) struct FigureAnswer {
    /// `11a` … `24`.
    #[schema(example = "13a")]
    id: &'static str,
    /// What the caption says it shows.
    title: &'static str,
    /// The parameters, and where they come from if not from the caption.
    parameters: &'static str,
    /// One diagram a model.
    panels: Vec<Panel>,
}

/// One diagram of a figure.
#[derive(Serialize, ToSchema)]
pub(crate) struct Panel {
    /// What it shows.
    label: &'static str,
    /// The numbers.
    diagram: Diagram,
}

object! {
    /// What to add to a figure.
    FigureQuery as "FigureQuery" {
        /// Adds the decimal logarithm of every value. False when absent.
        log10: Option<bool>,
        /// How it is drawn, where it is answered as a picture.
        plot: Option<PlotWire>,
    }
}

/// No figure of that id.
pub(crate) struct NoFigure;

impl IntoResponses for NoFigure {
    fn responses() -> BTreeMap<String, RefOr<Documented>> {
        list(&[(Kind::NotFound, "The report has no such figure; the detail lists those that it has.")])
    }
}

/// The report's figures.
#[utoipa::path(
    get,
    operation_id = "figures",
    path = "/v1/figures",
    tag = "diagrams",
    responses(
        (status = 200, description = "Every figure, with its link.", body = FigureList),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn index(_: JsonOnly, known: Known, _: NoQuery) -> Result<Response, Problem> {
    linked(&known, &"/v1/figures", async {
        let figures = FIGURES.iter().map(|figure| {
            Ok(FigureSummary {
                id: figure.id,
                title: figure.title,
                parameters: figure.parameters,
                href: format!("/v1/figures/{}", figure.id),
                diagrams: links(figure).map_err(|error| broken(figure, error))?,
            })
        });
        json::response(&FigureList { figures: figures.collect::<Result<_, Problem>>()? }, 32 << 10)
    })
    .await
}

/// One figure of the report, computed from its caption's parameters.
#[utoipa::path(
    get,
    path = "/v1/figures/{id}",
    tag = "diagrams",
    params(("id" = String, Path, description = "The figure's number and letter.", example = "13a"), FigureQuery),
    responses(
        (status = 200, description = "The figure.", content(
            (FigureAnswer = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy"),
            (String = "image/svg+xml"),
            (Binary = "image/png")
        )),
        (status = 304, description = "The client has this answer already."),
        NoFigure,
        GetProblems
    )
)]
pub(crate) async fn figure(
    State(app): State<App>,
    Drawable(format): Drawable,
    known: Known,
    deadline: Deadline,
    id: Result<Path<String>, PathRejection>,
    Query(query): Query<FigureQuery>,
) -> Result<Response, Problem> {
    // An id that is not UTF-8 is the id of no figure.
    let figure = id.ok().and_then(|Path(id)| find(&id)).ok_or_else(no_figure)?;
    let answer = Answer::of(format, figure, &query);
    linked(&known, &("/v1/figures", figure.id, format.media_type(), answer), async {
        // Pixels take memory: no more are drawn at a time than there is large work.
        let _turn = if let Answer::Drawn(..) = answer { Some(app.admission().turn().await?) } else { None };
        // Every figure has hundreds of directions at least: none is worth holding up connections for.
        let body = compute::blocking(deadline, move || make(figure, answer)).await??;
        Ok(([(header::CONTENT_TYPE, format.content_type())], body).into_response())
    })
    .await
}

/// What is made of a figure.
#[derive(Clone, Copy, Hash)]
enum Answer {
    Rows { format: Option<RowFormat>, log10: bool },
    Drawn(Picture, Options),
}

impl Answer {
    fn of(format: Format, figure: &Figure, query: &FigureQuery) -> Self {
        match format.picture() {
            Some(picture) => {
                let form = if figure.is_polar() { Form::Polar } else { Form::Cartesian };
                Self::Drawn(picture, Options::of(query.plot.as_ref(), form))
            }
            None => Self::Rows { format: format.row_format(), log10: query.log10.unwrap_or(false) },
        }
    }

    fn has_logarithms(self) -> bool {
        match self {
            Self::Rows { log10, .. } => log10,
            Self::Drawn(_, options) => options.scale == Scale::Log10,
        }
    }
}

fn no_figure() -> Problem {
    let ids = FIGURES.iter().map(|figure| figure.id).collect::<Vec<_>>().join(", ");
    Problem::new(Kind::NotFound, format!("The report has no such figure. It has: {ids}"))
}

fn broken(figure: &Figure, error: OutOfBounds) -> Problem {
    tracing::error!(%error, figure = figure.id, "a preset is out of range");
    Problem::internal()
}

fn make(figure: &'static Figure, answer: Answer) -> Result<Vec<u8>, Problem> {
    let panels = figure.evaluate(answer.has_logarithms()).map_err(|error| broken(figure, error))?;
    match answer {
        Answer::Drawn(picture, options) => {
            plot::draw(&plot::of_figure(figure, &panels, &options), picture, &options)
        }
        Answer::Rows { format: Some(rows), .. } => {
            let tables: Vec<_> = panels.into_iter().map(|panel| panel.table).collect();
            flat::write(rows, &tables, true)
        }
        Answer::Rows { format: None, .. } => {
            let panels: Vec<Panel> = panels
                .into_iter()
                .map(|panel| Panel { label: panel.label, diagram: Diagram::new(panel.table, true) })
                .collect();
            let size_hint = panels.iter().map(|panel| panel.diagram.size_hint()).sum();
            let Figure { id, title, parameters, .. } = *figure;
            json::bytes(&FigureAnswer { id, title, parameters, panels }, size_hint)
        }
    }
}
