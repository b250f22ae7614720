//! `GET` and `POST /v1/diagrams`: a sweep over one zenith angle at several fixed ones.

use super::radiance::OutputWire;
use super::responses::{GetProblems, PostProblems};
use super::scene::CheckedScene;
use super::sweep::CheckedSweep;
use crate::http::answer::{self, Call, DrawableCall, Over, Subject, Work};
use crate::http::body::JsonBody;
use crate::http::compute::admission::Turn;
use crate::http::encode::rows::Binary;
use crate::http::encode::table::Diagram;
use crate::http::input::object::object;
use crate::http::input::query::Query;
use crate::http::input::wire::named;
use crate::http::link::{Known, key, linked};
use crate::http::plot::{Form, Options, Picture, PlotWire};
use crate::http::problem::Problem;
use crate::reflectance::evaluate::Quantity;
use axum::response::Response;
use std::hash::{Hash, Hasher};

named! {
    Quantity, "a quantity", [Quantity::Radiance, Quantity::Brdf];
}

object! {
    /// A scene, and a sweep through its directions.
    DiagramRequest as "DiagramRequest" {
        /// `radiance` (when absent or null) or `brdf`.
        quantity: Option<Quantity>,
        /// What to add.
        output: Option<OutputWire>,
        /// How it is drawn, where it is answered as a picture.
        plot: Option<PlotWire>,
        ..sweep: CheckedSweep,
        ..scene: CheckedScene,
    }
}

/// By what it asks for: the same where a default is given and where it is left out.
impl Hash for DiagramRequest {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let quantity = self.quantity.unwrap_or(Quantity::Radiance).name();
        (quantity, OutputWire::chosen(self.output.clone()), &self.sweep.0, &self.scene).hash(state);
        OutputWire::angles(self.output.as_ref()).unwrap_or(true).hash(state);
    }
}

/// A tabulated diagram, as a link.
///
/// The fields of the POST request, flattened into the query: `medium=perfect_conductor` or `n` and `k`,
/// `at_deg=10,30,45,60`. As `image/svg+xml` or `image/png` it is drawn. The answer is a function of the link alone and carries a strong entity tag.
#[utoipa::path(
    get,
    path = "/v1/diagrams",
    tag = "diagrams",
    params(DiagramRequest),
    responses(
        (status = 200, description = "The diagram.", content(
            (Diagram = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy"),
            (String = "image/svg+xml"),
            (Binary = "image/png")
        )),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn link(
    DrawableCall(call): DrawableCall,
    known: Known,
    Query(request): Query<DiagramRequest>,
) -> Result<Response, Problem> {
    let key = key(&("/v1/diagrams", call.format.media_type(), drawn(&call, &request), &request));
    linked(&known, &key, answer(call, None, request)).await
}

/// A tabulated diagram.
#[utoipa::path(
    post,
    path = "/v1/diagrams",
    tag = "diagrams",
    request_body(content = DiagramRequest, description = "The scene and the sweep."),
    responses(
        (status = 200, description = "The diagram.", content(
            (Diagram = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy"),
            (String = "image/svg+xml"),
            (Binary = "image/png")
        )),
        PostProblems
    )
)]
pub(crate) async fn diagram(
    DrawableCall(call): DrawableCall,
    JsonBody { value: request, turn }: JsonBody<DiagramRequest>,
) -> Result<Response, Problem> {
    answer(call, turn, request).await
}

/// Whether and how it is to be drawn.
fn drawn(call: &Call, request: &DiagramRequest) -> Option<(Picture, Options)> {
    let options = || Options::of(request.plot.as_ref(), Form::Cartesian);
    call.format.picture().map(|picture| (picture, options()))
}

async fn answer(call: Call, turn: Option<Turn>, request: DiagramRequest) -> Result<Response, Problem> {
    let drawn = drawn(&call, &request);
    let DiagramRequest { quantity, output, sweep: CheckedSweep(sweep), scene, .. } = request;
    let CheckedScene { scene, light } = scene;
    let angles = OutputWire::angles(output.as_ref());
    let subject = Subject::Scene {
        scene: Box::new(scene),
        light,
        quantity: quantity.unwrap_or(Quantity::Radiance),
        output: OutputWire::chosen(output),
    };
    let mut work = Work::new(subject, Over::Sweep(Box::new(sweep)));
    work.has_angles = angles.unwrap_or(true);
    match drawn {
        Some(how) => answer::picture::respond(call, turn, work, how).await,
        None => answer::respond(call, turn, work).await,
    }
}
