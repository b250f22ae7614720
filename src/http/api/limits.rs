//! `GET /v1/limits`: what a request may be and take, and the ranges of all numbers.

use super::diagrams::DiagramRequest;
use super::image_irradiance::{FixedSourceWire, FixedViewWire};
use super::radiance::GeometryWire;
use super::responses::GetProblems;
use super::roughness::RoughnessQuery;
use super::spike::SpikeWire;
use crate::config::Cli;
use crate::http::app::{App, Limits};
use crate::http::encode::json;
use crate::http::input::object::{WireObject, prose};
use crate::http::input::query::{MOST_PARAMETERS, NoQuery};
use crate::http::link::{Known, configured};
use crate::http::negotiate::{Format, JsonOnly};
use crate::http::plot::{MOST_CURVES, MOST_PIXELS};
use crate::http::problem::{Kind, Problem};
use crate::reflectance::bounds::{
    MAX_AVERAGED, MAX_CURVES, MAX_RECEIVED, MAX_SERIES, MAX_SWEEP_POINTS, MAX_WAVELENGTHS,
};
use axum::extract::State;
use axum::response::Response;
use clap::CommandFactory as _;
use serde::Serialize;
use std::sync::LazyLock;
use std::time::Duration;
use utoipa::ToSchema;

/// What the service refuses, and why.
#[derive(Serialize, ToSchema)]
pub(crate) struct LimitList {
    /// Of requests, connections and work.
    limits: Vec<Limit>,
    /// Of the numbers in requests.
    ranges: Vec<Range>,
}

/// One limit.
#[derive(Serialize, ToSchema)]
pub(crate) struct Limit {
    /// Its name.
    #[schema(example = "body_limit_bytes")]
    name: &'static str,
    /// Its value, in its unit.
    #[schema(value_type = f64, example = 67108864)]
    value: Value,
    /// Its unit; what is counted, for a count.
    #[schema(example = "bytes")]
    unit: &'static str,
    /// What it limits.
    description: String,
    /// The flag that sets it; absent where nothing does.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "--body-limit-bytes")]
    flag: Option<String>,
    /// The environment variable that sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "REFLECTANCE_BODY_LIMIT_BYTES")]
    variable: Option<String>,
    /// What happens beyond it.
    #[schema(example = "refused")]
    beyond: &'static str,
    /// The status of a request that is refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = 413)]
    status: Option<u16>,
    /// The type of the problem then.
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "/problems/content-too-large")]
    kind: Option<String>,
}

/// A value as it is written: counts without a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
enum Value {
    Whole(u64),
    Seconds(f64),
}

impl From<u64> for Value {
    fn from(value: u64) -> Self {
        Self::Whole(value)
    }
}

impl From<usize> for Value {
    fn from(value: usize) -> Self {
        Self::Whole(value as u64)
    }
}

impl From<Duration> for Value {
    fn from(value: Duration) -> Self {
        Self::Seconds(value.as_secs_f64())
    }
}

/// What happens beyond a limit.
#[derive(Clone, Copy)]
enum Beyond {
    Refused(Kind),
    /// In these words.
    Else(&'static str),
}

/// The range of a number.
#[derive(Serialize, ToSchema)]
pub(crate) struct Range {
    /// The resource, or the object of a request, that the field belongs to.
    #[schema(example = "DiagramRequest")]
    of: &'static str,
    /// The field; in a query, the parameter.
    #[schema(example = "rms_height_um")]
    name: &'static str,
    /// What it is.
    description: String,
    /// What kind of number it is, as messages name it.
    #[schema(example = "length")]
    quantity: &'static str,
    /// Its unit; empty for a pure number.
    #[schema(example = "micrometres")]
    unit: &'static str,
    /// The least that is accepted.
    minimum: f64,
    /// The most that is accepted.
    maximum: f64,
}

/// The limits that have a flag: its name in the configuration, value, unit, and what happens beyond. Every field of
/// [`Limits`] is named here, so that none can be forgotten.
fn configured_limits(limits: &Limits) -> Vec<(&'static str, Value, &'static str, Beyond)> {
    use Beyond::{Else, Refused};
    let Limits {
        body_bytes,
        expanded_body_bytes,
        head_bytes,
        directions,
        rows,
        incidences,
        request_time,
        answer_time,
        cpu_time,
        in_flight,
        large_requests,
        queue,
        queue_time,
        connections,
        idle_time,
        stall_time,
        rate,
    } = *limits;
    let mut list = vec![
        ("body_limit_bytes", body_bytes.into(), "bytes", Refused(Kind::ContentTooLarge)),
        ("expanded_body_limit_bytes", expanded_body_bytes.into(), "bytes", Refused(Kind::ContentTooLarge)),
        ("head_limit_bytes", head_bytes.into(), "bytes", Refused(Kind::HeadTooLarge)),
        ("direction_limit", directions.into(), "directions", Refused(Kind::InvalidRequest)),
        ("row_limit", rows.into(), "rows", Refused(Kind::InvalidRequest)),
        ("incidence_limit", incidences.into(), "incidences", Refused(Kind::InvalidRequest)),
        ("request_timeout_seconds", request_time.into(), "seconds", Refused(Kind::TooSlow)),
        ("answer_timeout_seconds", answer_time.into(), "seconds", Else("the answer is cut short")),
        ("cpu_limit_seconds", cpu_time.into(), "seconds", Refused(Kind::CpuTime)),
        ("in_flight_limit", in_flight.into(), "requests", Refused(Kind::Overloaded)),
        ("large_request_limit", large_requests.into(), "requests", Else("they wait in the queue")),
        ("queue_limit", queue.into(), "requests", Refused(Kind::Overloaded)),
        ("queue_timeout_seconds", queue_time.into(), "seconds", Refused(Kind::Overloaded)),
        ("connection_limit", connections.into(), "connections", Else("they wait to be accepted")),
        ("idle_timeout_seconds", idle_time.into(), "seconds", Else("the connection is closed")),
        (
            "stall_timeout_seconds",
            stall_time.into(),
            "seconds",
            Else("refused with 408 while a body arrives; the connection is closed while an answer is sent"),
        ),
    ];
    if let Some([rate, burst]) = rate {
        let refused = Refused(Kind::RateLimited);
        list.push(("rate_limit_per_second", u64::from(rate.get()).into(), "requests of one client", refused));
        list.push(("rate_limit_burst", u64::from(burst.get()).into(), "requests of one client", refused));
    }
    list
}

/// Flag, variable and description of what the command line can set, by its name.
struct Setting {
    id: String,
    flag: Option<String>,
    variable: Option<String>,
    description: String,
}

static SETTINGS: LazyLock<Vec<Setting>> = LazyLock::new(|| {
    Cli::command()
        .get_arguments()
        .map(|argument| Setting {
            id: argument.get_id().to_string(),
            flag: argument.get_long().map(|long| format!("--{long}")),
            variable: argument.get_env().map(|name| name.to_string_lossy().into_owned()),
            description: argument.get_help().map(ToString::to_string).unwrap_or_default(),
        })
        .collect()
});

impl Limit {
    fn new(name: &'static str, value: Value, unit: &'static str, beyond: Beyond) -> Self {
        let setting = SETTINGS.iter().find(|setting| setting.id == name);
        let (beyond, status, kind) = match beyond {
            Beyond::Refused(kind) => ("refused", Some(kind.status().as_u16()), Some(kind.reference())),
            Beyond::Else(what) => (what, None, None),
        };
        Self {
            name,
            value,
            unit,
            description: setting.map(|setting| setting.description.clone()).unwrap_or_default(),
            flag: setting.and_then(|setting| setting.flag.clone()),
            variable: setting.and_then(|setting| setting.variable.clone()),
            beyond,
            status,
            kind,
        }
    }

    /// One that nothing sets.
    fn fixed(name: &'static str, value: usize, unit: &'static str, what: &str, kind: Kind) -> Self {
        let description = what.to_owned();
        Self { description, ..Self::new(name, value.into(), unit, Beyond::Refused(kind)) }
    }
}

/// The numbers among the fields of an object, inner objects included.
fn ranges<T: WireObject>() -> impl Iterator<Item = Range> {
    T::query_parameters(false).into_iter().filter_map(|parameter| {
        let bounds = parameter.bounds?;
        Some(Range {
            of: T::NAME,
            name: parameter.name,
            description: prose(&parameter.description),
            quantity: bounds.name,
            unit: bounds.unit,
            minimum: bounds.min,
            maximum: bounds.max,
        })
    })
}

fn list(limits: &Limits) -> LimitList {
    let mut all: Vec<_> = configured_limits(limits)
        .into_iter()
        .map(|(name, value, unit, beyond)| Limit::new(name, value, unit, beyond))
        .collect();
    let invalid = Kind::InvalidRequest;
    all.extend([
        Limit::fixed("sweep_points", MAX_SWEEP_POINTS, "points", "Most points along one sweep", invalid),
        Limit::fixed(
            "wavelengths",
            MAX_WAVELENGTHS,
            "wavelengths",
            "Most wavelengths of one spectrum",
            invalid,
        ),
        Limit::fixed(
            "series",
            MAX_SERIES,
            "series",
            "Most fixed angles times wavelengths of one diagram",
            invalid,
        ),
        Limit::fixed("fixed_angles", MAX_CURVES, "angles", "Most fixed angles of one diagram", invalid),
        Limit::fixed(
            "picture_series",
            MOST_CURVES,
            "series",
            "Most fixed angles times wavelengths of one diagram that is drawn",
            invalid,
        ),
        Limit::fixed("picture_pixels", MOST_PIXELS, "pixels", "Most width and height of a picture", invalid),
        Limit::fixed(
            "averaged_sources",
            MAX_AVERAGED,
            "angles",
            "Most zeniths of the source, over all curves, with fresnel_average slope_average",
            invalid,
        ),
        Limit::fixed(
            "received_rows",
            MAX_RECEIVED,
            "rows",
            "Most rows, over all curves and wavelengths, with receiver_half_angle_deg",
            invalid,
        ),
        Limit::fixed(
            "query_parameters",
            MOST_PARAMETERS,
            "parameters",
            "Most parameters of one query",
            Kind::MalformedQuery,
        ),
    ]);
    let ranges = ranges::<DiagramRequest>()
        .chain(ranges::<GeometryWire>())
        .chain(ranges::<RoughnessQuery>())
        .chain(ranges::<FixedSourceWire>())
        .chain(ranges::<FixedViewWire>())
        .chain(ranges::<SpikeWire>());
    LimitList { limits: all, ranges: ranges.collect() }
}

/// What a request may be and take.
///
/// Every limit with its value, the flag and the environment variable that set it, and what happens beyond it; and
/// the range of every number that a request can carry, for forms that refuse nothing else than the service does.
#[utoipa::path(
    get,
    path = "/v1/limits",
    tag = "reference",
    responses(
        (status = 200, description = "The limits in force.", body = LimitList),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn limits(
    State(app): State<App>,
    _: JsonOnly,
    known: Known,
    _: NoQuery,
) -> Result<Response, Problem> {
    let body = json::bytes(&list(app.limits()), 16 << 10)?;
    Ok(configured(&known, Format::Json.content_type(), body).await)
}

#[cfg(test)]
mod tests {
    use super::{Limits, SETTINGS, Value, list};
    use crate::config::Cli;
    use crate::http::app::App;
    use clap::Parser as _;

    /// Rates are not limited unless it is asked for.
    const RATED: [&str; 4] = ["--rate-limit-per-second", "7", "--rate-limit-burst", "9"];

    fn limits(flags: &[&str]) -> Limits {
        let cli = Cli::try_parse_from([&["reflectance"], flags].concat()).unwrap();
        *App::new(&cli.config).limits()
    }

    #[test]
    fn every_limit_has_its_flag_and_its_value() {
        // Every flag set to a value of its own: each has to come back under its name.
        for limit in list(&limits(&RATED)).limits {
            assert!(!limit.description.is_empty(), "{}", limit.name);
            assert!(limit.status.is_some() || limit.beyond != "refused", "{}", limit.name);
            let Some(flag) = &limit.flag else { continue };
            assert!(limit.variable.is_some_and(|name| name.starts_with("REFLECTANCE_")), "{flag}");
            let mut flags = RATED.to_vec();
            if let Some(place) = flags.iter().position(|other| other == flag) {
                flags[place + 1] = "12345";
            } else {
                flags.extend([flag, "12345"]);
            }
            let set = list(&limits(&flags)).limits;
            let set = set.iter().find(|other| other.name == limit.name).unwrap().value;
            assert!(matches!(set, Value::Whole(12345) | Value::Seconds(12345.0)), "{flag}: {set:?}");
            assert_ne!(set, limit.value);
        }
    }

    #[test]
    fn every_flag_that_is_a_limit_is_listed() {
        let listed = list(&limits(&RATED)).limits;
        for setting in SETTINGS.iter() {
            let is_limit = setting.id.contains("_limit") || setting.id.contains("_timeout");
            if is_limit && setting.id != "shutdown_timeout_seconds" {
                assert!(listed.iter().any(|limit| limit.name == setting.id), "{}", setting.id);
            }
        }
    }

    #[test]
    fn ranges_are_of_every_number() {
        let ranges = list(&limits(&[])).ranges;
        let find =
            |of: &str, name: &str| ranges.iter().find(|range| range.of == of && range.name == name).unwrap();
        assert_eq!(find("DiagramRequest", "rms_height_um").minimum, 1e-60);
        assert_eq!(find("DiagramRequest", "at_deg").unit, "degrees");
        assert_eq!(find("DiagramRequest", "k").maximum, 1e9);
        assert_eq!(find("DiagramRequest", "parallel").quantity, "fraction");
        assert_eq!(find("Geometry", "phi_r_deg").minimum, -360.0);
        // The same name, another range: only up to there can it be turned into heights.
        assert!(find("RoughnessQuery", "facet_slope_deg").maximum < 64.0);
        assert_eq!(find("DiagramRequest", "facet_slope_deg").maximum, 1e3);
        assert_eq!(find("FixedSource", "C_dl").quantity, "component strength");
        assert_eq!(find("SpikeShape", "width_deg").unit, "degrees");
    }
}
