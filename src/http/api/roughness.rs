//! `GET /v1/roughness`: every measure of one roughness, (9), (34), (78), (79), and what it means for the models.

use super::responses::GetProblems;
use crate::http::encode::json;
use crate::http::input::object::{Checked, object};
use crate::http::input::query::Query;
use crate::http::input::reader::Reader;
use crate::http::input::wire::is_given;
use crate::http::link::{Known, linked};
use crate::http::negotiate::JsonOnly;
use crate::http::problem::{Code, Problem};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::quantity::{
    BeckmannAlpha, CorrelationLength, InvertibleFacetSlope, RmsHeight, SourceZenith, Wavelength,
};
use crate::reflectance::roughness::Widths;
use crate::reflectance::surface::{
    RayleighPair, Regime, curvature_radius_in_wavelengths, is_geometrical, is_locally_flat,
};
use crate::reflectance::unified::{lobe_share, mirror_g, spike_share};
use axum::response::Response;
use serde::Serialize;
use std::hash::{Hash, Hasher};
use utoipa::ToSchema;

object! {
    partial
    /// A roughness in one of three measures.
    WidthsWire as "RoughnessMeasures" {
        /// σ_h, micrometres. With `correlation_length_um`.
        rms_height_um: Option<RmsHeight>,
        /// T, micrometres. With `rms_height_um`.
        correlation_length_um: Option<CorrelationLength>,
        /// σ_α, degrees, below 90/√2: (79) has no inverse beyond.
        facet_slope_deg: Option<InvertibleFacetSlope>,
        /// tan α₀ = 2σ_h/T.
        beckmann_alpha: Option<BeckmannAlpha>,
    }
}

/// The three measures, for messages.
const MEASURES: &str = "rms_height_um with correlation_length_um, or facet_slope_deg, or beckmann_alpha";

/// One measure of the three.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) enum Measure {
    Heights(RmsHeight, CorrelationLength),
    FacetSlope(InvertibleFacetSlope),
    BeckmannAlpha(BeckmannAlpha),
}

impl Checked for Measure {
    type Fields = WidthsWire;

    fn check(wire: WidthsWire, reader: &mut Reader) -> Option<Self> {
        let (height, length) = (is_given(&wire.rms_height_um), is_given(&wire.correlation_length_um));
        let (slope, alpha) = (is_given(&wire.facet_slope_deg), is_given(&wire.beckmann_alpha));
        let measures = usize::from(height || length) + usize::from(slope) + usize::from(alpha);
        if measures == 0 {
            return reader.fail(Code::Required, format!("required: one measure, {MEASURES}"));
        }
        if measures > 1 {
            let given = [
                (height, "rms_height_um"),
                (length, "correlation_length_um"),
                (slope, "facet_slope_deg"),
                (alpha, "beckmann_alpha"),
            ];
            for (_, name) in given.into_iter().filter(|(given, _)| *given) {
                let detail = format!("one of several measures: give one only, {MEASURES}");
                reader.within(name, |reader| reader.error(Code::Inconsistent, detail));
            }
            return None;
        }
        if slope {
            return wire.facet_slope_deg?.map(Self::FacetSlope);
        }
        if alpha {
            return wire.beckmann_alpha?.map(Self::BeckmannAlpha);
        }
        for (given, name, other) in [
            (height, "rms_height_um", "correlation_length_um"),
            (length, "correlation_length_um", "rms_height_um"),
        ] {
            if !given {
                let detail = format!("required: {other} needs it");
                reader.within(name, |reader| reader.error(Code::Required, detail));
            }
        }
        Some(Self::Heights(wire.rms_height_um??, wire.correlation_length_um??))
    }
}

object! {
    /// A roughness and, optionally, the light that meets it.
    RoughnessQuery as "RoughnessQuery" {
        /// λ, micrometres.
        wavelength_um: Option<Wavelength>,
        /// θ_i, degrees; 0 when absent.
        theta_i_deg: Option<SourceZenith>,
        ..measure: Measure,
    }
}

/// By what it asks for: the same where a default is given and where it is left out.
impl Hash for RoughnessQuery {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let theta_i = self.theta_i_deg.map_or(0.0, SourceZenith::get);
        (self.wavelength_um, theta_i.to_bits(), self.measure).hash(state);
    }
}

/// One roughness in every measure, and what it means at a wavelength. What the query does not determine is absent.
#[derive(Serialize, ToSchema)]
#[expect(clippy::struct_field_names, reason = "roughness_g is the name of g on the wire")]
pub(crate) struct Roughness {
    /// σ_h/T.
    rms_height_over_correlation_length: f64,
    /// σ_α of (79), degrees: the width of the density exp(−α²/2σ_α²) of the facet slope angle.
    facet_slope_deg: f64,
    /// √2 σ_h/T as an angle, degrees: σ_α for gentle slopes, matched by curvature instead of (79).
    facet_slope_small_deg: f64,
    /// α₀ of (78), degrees: where exp(−tan²α/tan²α₀) is 1/e.
    alpha0_deg: f64,
    /// tan α₀ = 2σ_h/T: the width m of Beckmann's facet density exp(−tan²α/m²)/(π m² cos⁴α).
    beckmann_alpha: f64,
    /// √2 σ_h/T: the standard deviation of the slope along any one line.
    rms_slope: f64,
    /// The height λ/(8 cos θ_i) of (9) up to which a surface counts as smooth, micrometres. Null at grazing
    /// incidence, where it is infinite. Needs a wavelength.
    #[serde(skip_serializing_if = "Option::is_none")]
    rayleigh_height_um: Option<f64>,
    /// g of (34) at the mirror direction. Needs a wavelength and `rms_height_um`, as all below.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    roughness_g: Option<f64>,
    /// `smooth` up to g = π²/4 (Rayleigh's criterion for σ_h), `rough` from g = 10 on, `moderate` between.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "moderate")]
    regime: Option<&'static str>,
    /// e^{−g}: the spike's share of the reflected energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    spike_share: Option<f64>,
    /// 1 − e^{−g}: the lobe's share.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    total_integrated_scatter: Option<f64>,
    /// What the models assume.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    validity: Option<Validity>,
    /// Why values are null.
    diagnostics: Vec<RoughnessDiagnostic>,
}

/// The assumptions of sections 4.1.3 and 4.2.3 that a roughness can strain.
#[derive(Serialize, ToSchema)]
pub(crate) struct Validity {
    /// Of Beckmann-Spizzichino, section 4.1.3: the surface is locally flat.
    kirchhoff: Check,
    /// Of Torrance-Sparrow, sections 4.2.2 and 4.2.3: σ_h is above the wavelength, and there is no spike.
    geometrical_optics: Check,
}

/// One assumption.
#[derive(Serialize, ToSchema)]
pub(crate) struct Check {
    /// The number it is judged by.
    value: f64,
    /// Whether it holds.
    holds: bool,
    /// What the number is, and where the line is drawn.
    criterion: &'static str,
}

/// Why a value is null.
#[derive(Serialize, ToSchema)]
pub(crate) struct RoughnessDiagnostic {
    /// Which field.
    #[schema(example = "rayleigh_height_um")]
    field: &'static str,
    /// Why, for programs.
    #[schema(example = "grazing_divergence")]
    code: &'static str,
    /// Why, for people.
    detail: &'static str,
}

const KIRCHHOFF: &str = "radius of curvature T²/(2√3 σ_h) over the wavelength; holds from 10/4π on";
const GEOMETRICAL: &str = "σ_h over the wavelength; holds from 1.5 on, where the report finds the spike gone";

/// Every measure of one roughness.
///
/// From σ_h and T, from σ_α, or from Beckmann's tan α₀. With a wavelength also the Rayleigh criterion, and with
/// σ_h too how the reflected energy is shared and whether the models' assumptions hold.
#[utoipa::path(
    get,
    path = "/v1/roughness",
    tag = "roughness",
    params(RoughnessQuery),
    responses(
        (status = 200, description = "The roughness in every measure.", body = Roughness),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn roughness(
    _: JsonOnly,
    known: Known,
    Query(query): Query<RoughnessQuery>,
) -> Result<Response, Problem> {
    linked(&known, &("/v1/roughness", &query), async { json::response(&answer(&query), 1024) }).await
}

fn answer(query: &RoughnessQuery) -> Roughness {
    let widths = match query.measure {
        Measure::Heights(height, length) => Widths::from_heights(height, length),
        Measure::FacetSlope(slope) => Widths::from_facet_slope(slope),
        Measure::BeckmannAlpha(alpha) => Widths::from_beckmann_alpha(alpha),
    };
    let cos_i = query.theta_i_deg.map_or(1.0, |theta_i| SinCos::of_degrees(theta_i.get()).cos);
    let heights = match query.measure {
        Measure::Heights(height, length) => Some((height.get(), length.get())),
        _ => None,
    };
    let wavelength = query.wavelength_um.map(Wavelength::get);
    let optics = heights.zip(wavelength);
    let g = optics.map(|((height, _), wavelength)| mirror_g(height, wavelength, cos_i));
    let rayleigh = wavelength.map(|wavelength| {
        let height = heights.map_or(0.0, |(height, _)| height);
        RayleighPair { height, wavelength, sin_beta: cos_i }.critical_height().to_f64()
    });
    let grazing = rayleigh.is_some_and(f64::is_infinite).then_some(RoughnessDiagnostic {
        field: "rayleigh_height_um",
        code: "grazing_divergence",
        detail: "at grazing incidence a surface of any height counts as smooth",
    });
    Roughness {
        rms_height_over_correlation_length: widths.height_to_length.get(),
        facet_slope_deg: widths.facet_slope.get(),
        facet_slope_small_deg: widths.small_slope.get(),
        alpha0_deg: widths.characteristic_angle.get(),
        beckmann_alpha: widths.beckmann_alpha.get(),
        rms_slope: widths.rms_slope.get(),
        rayleigh_height_um: rayleigh,
        roughness_g: g,
        regime: g.map(|g| Regime::of(g).name()),
        spike_share: g.map(spike_share),
        total_integrated_scatter: g.map(lobe_share),
        validity: optics.map(|((height, length), wavelength)| validity(height, length, wavelength)),
        diagnostics: grazing.into_iter().collect(),
    }
}

fn validity(height: f64, length: f64, wavelength: f64) -> Validity {
    let radius = curvature_radius_in_wavelengths(height, length, wavelength);
    Validity {
        kirchhoff: Check { value: radius, holds: is_locally_flat(radius), criterion: KIRCHHOFF },
        geometrical_optics: Check {
            value: height / wavelength,
            holds: is_geometrical(height / wavelength),
            criterion: GEOMETRICAL,
        },
    }
}
