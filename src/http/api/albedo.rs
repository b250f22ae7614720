//! `POST /v1/albedo`: how much of a beam leaves the surface, by component and in all.

use super::answer::{DiagnosticAnswer, WarningAnswer};
use super::light::{Light, MediumAnswer};
use super::responses::PostProblems;
use super::scene::{SceneWire, note};
use crate::http::app::App;
use crate::http::body::JsonBody;
use crate::http::compute;
use crate::http::compute::admission::Turn;
use crate::http::compute::job::Job;
use crate::http::compute::pool::NotDone;
use crate::http::edge::{Asked, Deadline};
use crate::http::encode::json;
use crate::http::encode::numbers::Numbers;
use crate::http::encode::rows::{Binary, Cells, Head, Heading, Kind as Column, RowFormat, Rows};
use crate::http::input::node::Node;
use crate::http::input::object::{Checked, object};
use crate::http::input::reader::Reader;
use crate::http::input::values::List;
use crate::http::input::wire::{Schemas, Wire, mismatch};
use crate::http::negotiate::{Tabular, VARY};
use crate::http::problem::{Code, FieldError, Kind, Problem};
use crate::reflectance::albedo::{Albedo, AlbedoScene};
use crate::reflectance::bounds::{Bounds, DEFAULT_ALBEDO_TOLERANCE, MAX_INCIDENCES};
use crate::reflectance::material::Lookup;
use crate::reflectance::quantity::{Quantity as _, SourceZenith};
use crate::reflectance::scene::Component;
use axum::extract::State;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use futures_util::{StreamExt as _, TryStreamExt as _, stream};
use serde::Serialize;
use std::sync::Arc;
use utoipa::ToSchema;
use utoipa::openapi::schema::Schema;
use utoipa::openapi::{OneOfBuilder, RefOr};

/// One incidence or several.
#[derive(Clone, Debug)]
pub(crate) struct Incidences(Vec<SourceZenith>);

type Listed = List<SourceZenith, MAX_INCIDENCES>;

impl Wire for Incidences {
    const RANGE: Option<&'static Bounds> = Some(SourceZenith::BOUNDS);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Array(array) if array.length == 0 => {
                reader.fail(Code::Empty, "the array is empty: expected at least one incidence")
            }
            Node::Array(_) => Listed::read(node, reader)?.0.into_iter().collect::<Option<_>>().map(Self),
            Node::Number(_) => Some(Self(vec![SourceZenith::read(node, reader)?])),
            other => {
                let expected = format!("{}, or an array of such", SourceZenith::BOUNDS);
                reader.fail(Code::WrongType, mismatch(&other, &expected))
            }
        }
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(SourceZenith::schema()).item(Listed::schema()).into()
    }

    fn collect(_: &mut Schemas) {}
}

/// A scene for an albedo, which needs no sensor and has a tolerance of its own, and its light.
#[derive(Clone, Debug)]
pub(crate) struct CheckedAlbedoScene {
    scene: AlbedoScene,
    light: Light,
}

impl Checked for CheckedAlbedoScene {
    type Fields = SceneWire;

    fn check(wire: SceneWire, reader: &mut Reader) -> Option<Self> {
        for error in AlbedoScene::outline(wire.outline()).errors() {
            note(&error, reader);
        }
        let lit = wire.lit(reader)?;
        let scene = AlbedoScene::new(wire.into_parameters(&lit, DEFAULT_ALBEDO_TOLERANCE)?).ok()?;
        Some(Self { scene, light: lit.light })
    }
}

object! {
    /// A scene of `/v1/radiance` without its directions and `output`, and the incidences. A sensor and the irradiance are
    /// read and not used; `accuracy.relative_tolerance` is that of each total, 1e-6 when absent or null.
    AlbedoRequest as "AlbedoRequest" {
        /// θ_i, degrees: one number, or an array of up to 1000 unless the service is set to another limit.
        theta_i_deg: Incidences,
        ..scene: CheckedAlbedoScene,
    }
}

/// Directional-hemispherical reflectances, shares of the incident power, in the order of the incidences. A value that is
/// infinite is null, and `diagnostics` says why.
#[derive(Serialize, ToSchema)]
#[schema(as = Albedo)]
pub(crate) struct AlbedoAnswer {
    /// `albedo`.
    #[schema(example = "albedo")]
    quantity: &'static str,
    /// What was looked up for a material; absent for other media.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    medium: Option<MediumAnswer>,
    /// θ_i, degrees.
    theta_i_deg: Numbers,
    /// The sum of the components.
    total: Numbers,
    /// ρ of (57).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    diffuse_lobe: Option<Numbers>,
    /// ∫ f_r cos θ_r dω_r of the second term of (47), or of (70).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    specular_lobe: Option<Numbers>,
    /// F′ e^{−g}, g and F′ in the mirror direction: all of the spike where the patch is large against the wavelength.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    specular_spike: Option<Numbers>,
    /// Bound of the relative error of `total` against the exact value of the model for the numbers as given; null where no
    /// bound below infinity is known. Where a lobe was integrated it is twice what the rule says of its own error: tried on
    /// thousands of scenes, not proven as the bounds of radiances are.
    relative_error_bound: Numbers,
    /// F′ of (63) at θ_i: what a smooth plate reflects, 1 for a perfect conductor.
    fresnel_reflectance: Numbers,
    /// Specular lobe and spike together less `fresnel_reflectance`: above 0 the model makes light, below 0 it loses some.
    /// Absent where a specular component of the model is not evaluated, or there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    excess: Option<Numbers>,
    /// 1 − e^{−g}, g in the mirror direction. Absent where the scene has no heights or wavelength.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    total_integrated_scatter: Option<Numbers>,
    /// `fresnel_reflectance` times that: what scalar scattering theory sends beside the mirror direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    scattered_reflectance: Option<Numbers>,
    /// The share of the spike in spike and lobe together, where both are evaluated; null where they reflect nothing, or the
    /// lobe is infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    spike_share: Option<Numbers>,
    /// The share of the lobe.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    lobe_share: Option<Numbers>,
    /// Points at which the lobe was taken, in all.
    evaluations: usize,
    /// What the values rest on.
    assumptions: Vec<&'static str>,
    /// What to know of the answer as a whole; `indices` are those of incidences.
    warnings: Vec<WarningAnswer>,
    /// Why values are null.
    diagnostics: Vec<DiagnosticAnswer>,
}

/// What the spike's closed form rests on.
const LARGE_PATCH: &str = "specular_spike: the patch is large against the wavelength, so that rho_o^2 of (35) holds all of \
     the spike's power next to the mirror direction";
/// What all rests on.
const ONCE: &str =
    "light is reflected once: what meets the surface again, or is sent below the horizon, is lost";

impl AlbedoAnswer {
    fn new(
        scene: &AlbedoScene,
        lookup: Option<Lookup>,
        incidences: &[SourceZenith],
        albedos: &[Albedo],
    ) -> Self {
        let column = |value: &dyn Fn(&Albedo) -> f64| Numbers(albedos.iter().map(value).collect());
        let component = |component: Component| {
            let is_evaluated = scene.scene().evaluated().contains(&component);
            let value = |albedo: &Albedo| {
                albedo.components[component as usize].map_or(f64::NAN, |part| part.value.to_f64())
            };
            is_evaluated.then(|| column(&value))
        };
        let optional = |value: &dyn Fn(&Albedo) -> Option<f64>| {
            albedos
                .iter()
                .any(|albedo| value(albedo).is_some())
                .then(|| column(&|albedo| value(albedo).unwrap_or(f64::NAN)))
        };
        let spike = component(Component::SpecularSpike);
        let mut assumptions = Vec::new();
        assumptions.extend(spike.is_some().then_some(LARGE_PATCH));
        assumptions.extend((!scene.is_closed()).then_some(ONCE));
        Self {
            quantity: "albedo",
            medium: lookup.map(MediumAnswer::from),
            theta_i_deg: Numbers(incidences.iter().map(|theta_i| theta_i.get()).collect()),
            total: column(&|albedo| albedo.total.value.to_f64()),
            diffuse_lobe: component(Component::DiffuseLobe),
            specular_lobe: component(Component::SpecularLobe),
            specular_spike: spike,
            relative_error_bound: column(&|albedo| albedo.total.relative_error()),
            fresnel_reflectance: column(&|albedo| albedo.fresnel),
            excess: optional(&|albedo| scene.excess(albedo)),
            total_integrated_scatter: optional(&|albedo| albedo.scattered),
            scattered_reflectance: optional(&|albedo| Some(albedo.scattered? * albedo.fresnel)),
            spike_share: optional(&|albedo| Some(AlbedoScene::shares_of(albedo)?[0])),
            lobe_share: optional(&|albedo| Some(AlbedoScene::shares_of(albedo)?[1])),
            evaluations: albedos.iter().map(|albedo| albedo.evaluations).sum(),
            assumptions,
            warnings: scene.warnings(incidences, albedos).into_iter().map(WarningAnswer::from).collect(),
            diagnostics: AlbedoScene::diagnostics(albedos).into_iter().map(DiagnosticAnswer::from).collect(),
        }
    }

    /// The columns that there are, in order.
    fn columns(&self) -> Vec<(&'static str, &Numbers)> {
        [
            ("theta_i_deg", Some(&self.theta_i_deg)),
            ("total", Some(&self.total)),
            (Component::DiffuseLobe.name(), self.diffuse_lobe.as_ref()),
            (Component::SpecularLobe.name(), self.specular_lobe.as_ref()),
            (Component::SpecularSpike.name(), self.specular_spike.as_ref()),
            ("relative_error_bound", Some(&self.relative_error_bound)),
            ("fresnel_reflectance", Some(&self.fresnel_reflectance)),
            ("excess", self.excess.as_ref()),
            ("total_integrated_scatter", self.total_integrated_scatter.as_ref()),
            ("scattered_reflectance", self.scattered_reflectance.as_ref()),
            ("spike_share", self.spike_share.as_ref()),
            ("lobe_share", self.lobe_share.as_ref()),
        ]
        .into_iter()
        .filter_map(|(name, numbers)| Some((name, numbers?)))
        .collect()
    }

    /// One row an incidence.
    fn table(&self, format: RowFormat) -> Result<Vec<u8>, Problem> {
        let columns = self.columns();
        let heading = |&(name, _): &(&'static str, _)| Heading { name, unit: "", kind: Column::Number };
        let count = self.total.0.len();
        let warnings = json::bytes(&self.warnings, 1024)?;
        let notes = vec![
            ("quantity", self.quantity.to_owned()),
            ("assumptions", self.assumptions.join("; ")),
            ("warnings", String::from_utf8(warnings).unwrap_or_default()),
        ];
        let head = Head { columns: columns.iter().map(heading).collect(), rows: count, notes };
        let mut bytes = format.head(&head)?;
        let cells = columns.iter().map(|(_, numbers)| Cells::Numbers(numbers.0.as_slice().into())).collect();
        format.rows(&head, Rows { count, columns: cells }, &mut bytes)?;
        bytes.append(&mut format.tail(&head)?);
        Ok(bytes)
    }
}

/// Directional-hemispherical reflectance by component.
///
/// The share of a beam that leaves the surface, ρ(θ_i) = ∫ f_r cos θ_r dω_r, for up to 1000 incidences. The specular lobe is
/// integrated over the hemisphere to the tolerance, spike and diffuse lobe are closed forms, and `excess` says how far the
/// models are from keeping energy. As JSON, or one row an incidence.
#[utoipa::path(
    post,
    path = "/v1/albedo",
    tag = "reflection",
    request_body(content = AlbedoRequest, description = "The scene and the incidences."),
    responses(
        (status = 200, description = "The albedo of each incidence.", content(
            (AlbedoAnswer = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        PostProblems
    )
)]
pub(crate) async fn albedo(
    State(app): State<App>,
    Tabular(format): Tabular,
    deadline: Deadline,
    JsonBody { value: request, turn }: JsonBody<AlbedoRequest>,
) -> Result<Response, Problem> {
    let AlbedoRequest { theta_i_deg: Incidences(incidences), scene } = request;
    let CheckedAlbedoScene { scene, light } = scene;
    let lookup = light.single()?;
    let limit = app.limits().incidences;
    if incidences.len() > limit {
        let detail = format!("{} incidences in one request: at most {limit} are answered", incidences.len());
        let pointer = "/theta_i_deg".to_owned();
        return Err(Problem::invalid(vec![FieldError { pointer, code: Code::TooMany, detail }]));
    }
    let scene = Arc::new(scene);
    let albedos = if scene.is_closed() {
        incidences.iter().filter_map(|&theta_i| scene.at(theta_i, || false)).collect()
    } else {
        integrated(&app, deadline, turn, &scene, &incidences).await?
    };
    let answer = AlbedoAnswer::new(&scene, lookup, &incidences, &albedos);
    let bytes = match format.row_format() {
        None => json::bytes(&answer, 1024 + 256 * incidences.len())?,
        Some(rows) => answer.table(rows)?,
    };
    let mut response = ([(header::CONTENT_TYPE, format.content_type())], bytes).into_response();
    response.headers_mut().insert(header::VARY, HeaderValue::from_static(VARY));
    response.extensions_mut().insert(Asked(incidences.len()));
    Ok(response)
}

/// One piece of work an incidence, on the pool.
async fn integrated(
    app: &App,
    deadline: Deadline,
    turn: Option<Turn>,
    scene: &Arc<AlbedoScene>,
    incidences: &[SourceZenith],
) -> Result<Vec<Albedo>, Problem> {
    let _turn = match turn {
        Some(turn) => turn,
        None => app.admission().turn().await?,
    };
    // Dropped with this future: whoever leaves stops the work.
    let (job, _abandon) = Job::new(app.limits().cpu_time);
    let pieces = stream::iter(incidences.iter().copied()).map(|theta_i| {
        let (scene, of_piece) = (Arc::clone(scene), Arc::clone(&job));
        let job = Arc::clone(&job);
        async move { app.pool().run(&job, move || scene.at(theta_i, || of_piece.is_stopped())).await }
    });
    let all = pieces
        .buffered(app.pool().width() + 1)
        .map_err(|reason| (reason == NotDone::Panicked).then(Problem::internal))
        .and_then(|albedo| async move { albedo.ok_or(None) })
        .try_collect();
    match tokio::time::timeout_at(deadline.at, all).await {
        Ok(Ok(albedos)) => Ok(albedos),
        Ok(Err(Some(problem))) => Err(problem),
        Ok(Err(None)) if job.is_exhausted() => Err(cpu_time(app)),
        Ok(Err(None)) | Err(_) => Err(compute::too_slow(deadline)),
    }
}

/// What a request is told that takes more processor time than it may.
fn cpu_time(app: &App) -> Problem {
    let limit = app.limits().cpu_time.as_secs_f64();
    let detail = format!(
        "the limit of a request is {limit} s of processor time; ask for fewer incidences or a coarser tolerance"
    );
    Problem::new(Kind::CpuTime, detail)
}
