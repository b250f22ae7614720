//! What `/v1/radiance` and `/v1/brdf` answer.

use super::light::MediumAnswer;
use crate::http::encode::numbers::Numbers;
use crate::reflectance::findings::{Diagnostic, Omitted, Warning, WarningCode};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::BTreeMap;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{Object, ObjectBuilder, Schema, Type};
use utoipa::{PartialSchema, ToSchema};

/// Values in each direction, in the order of the request's arrays. A value that is infinite or undefined is null,
/// and `diagnostics` says why. A value below the smallest 64-bit float is 0.
#[derive(ToSchema)]
#[expect(dead_code, reason = "for the document: answers are written column by column")]
pub(crate) struct Answer {
    /// `radiance` or `brdf`.
    #[schema(example = "radiance")]
    quantity: &'static str,
    /// Unit of the values.
    #[schema(example = "W m^-2 sr^-1")]
    unit: &'static str,
    /// What was looked up, where the medium is a material.
    #[schema(nullable = false)]
    medium: Option<MediumAnswer>,
    /// The sum of the components.
    total: Numbers,
    /// (57)
    #[schema(nullable = false)]
    diffuse_lobe: Option<Numbers>,
    /// The second term of (47), or (70).
    #[schema(nullable = false)]
    specular_lobe: Option<Numbers>,
    /// The first term of (47).
    #[schema(nullable = false)]
    specular_spike: Option<Numbers>,
    /// Decimal logarithm of `total`; null where the value is exactly 0.
    #[schema(nullable = false)]
    log10_total: Option<Numbers>,
    /// Decimal logarithm of `diffuse_lobe`.
    #[schema(nullable = false)]
    log10_diffuse_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_lobe`.
    #[schema(nullable = false)]
    log10_specular_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_spike`.
    #[schema(nullable = false)]
    log10_specular_spike: Option<Numbers>,
    /// Bound of the relative error of `total` against the exact value of the model for the numbers as given;
    /// null where no bound below infinity is known.
    relative_error_bound: Numbers,
    /// How many directions each method evaluated.
    methods: BTreeMap<&'static str, usize>,
    /// The method of each direction, if `output.per_direction` asks for it.
    #[schema(nullable = false)]
    method: Option<Vec<&'static str>>,
    /// g of (34) in each direction, if `output.per_direction` asks for it; null, with a diagnostic, where the
    /// scene has no heights or wavelength.
    #[schema(nullable = false)]
    roughness_g: Option<Numbers>,
    /// Components that `components: "auto"` left out.
    omitted: Vec<OmittedAnswer>,
    /// What to know of the answer as a whole.
    warnings: Vec<WarningAnswer>,
    /// Why values are null.
    diagnostics: Vec<DiagnosticAnswer>,
}

/// Answers at several wavelengths, in the order of the request's array.
#[derive(ToSchema)]
#[expect(dead_code, reason = "for the document: answers are written column by column")]
pub(crate) struct SpectrumAnswer {
    /// `radiance`, `brdf` or `image_irradiance`.
    #[schema(example = "radiance")]
    quantity: &'static str,
    /// Unit of the values.
    #[schema(example = "W m^-2 sr^-1")]
    unit: &'static str,
    /// One for each wavelength.
    spectrum: Vec<LineAnswer>,
}

/// The answer at one of several wavelengths: an [`Answer`] without what is said of all.
pub(crate) struct LineAnswer;

impl PartialSchema for LineAnswer {
    fn schema() -> RefOr<Schema> {
        let RefOr::T(Schema::Object(mut object)) = Answer::schema() else { return Answer::schema() };
        let of_all = ["quantity", "unit"];
        object.properties.retain(|name, _| !of_all.contains(&name.as_str()));
        object.required.retain(|name| !of_all.contains(&name.as_str()));
        let wavelength = ObjectBuilder::new().schema_type(Type::Number).description(Some("λ, micrometres."));
        object.properties.insert("wavelength_um".to_owned(), wavelength.into());
        object.required.push("wavelength_um".to_owned());
        object.description = Some("The answer at one wavelength.".to_owned());
        object.into()
    }
}

impl ToSchema for LineAnswer {
    fn name() -> Cow<'static, str> {
        Cow::Borrowed("SpectrumLine")
    }

    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        Answer::schemas(schemas);
    }
}

/// One answer, or one for each wavelength.
#[derive(ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "for the document: answers are written column by column")]
pub(crate) enum AnswerOrSpectrum {
    /// At one wavelength.
    #[schema(title = "One wavelength")]
    One(Box<Answer>),
    /// At several.
    #[schema(title = "Spectrum")]
    Spectrum(SpectrumAnswer),
}

/// A component that was left out.
#[derive(Serialize, ToSchema)]
#[schema(as = Omitted)]
pub(crate) struct OmittedAnswer {
    /// Which.
    #[schema(example = "specular_spike")]
    component: &'static str,
    /// What it could add to `total` at most, relative: the largest share over the directions, and part of
    /// `relative_error_bound`. Of a spike without a sensor, whose radiance is not known: the largest share e^-g of the
    /// reflected energy that it can carry, which is part of no bound; null without a height and a wavelength.
    bound: Option<f64>,
    /// Why it was left out.
    reason: &'static str,
}

/// Something to know about the answer.
#[derive(Serialize, ToSchema)]
#[schema(as = Warning)]
pub(crate) struct WarningAnswer {
    /// What, for programs.
    #[schema(schema_with = warning_codes)]
    code: &'static str,
    /// What, for people.
    detail: &'static str,
    /// How much, where it is a number.
    value: Option<f64>,
    /// The field of the request that it is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "surface.specular_scale")]
    parameter: Option<&'static str>,
    /// The directions concerned: 20 at most.
    indices: Vec<usize>,
    /// How many directions are concerned.
    count: usize,
}

/// The codes that there are, each with what it means.
fn warning_codes() -> Object {
    let meanings: Vec<_> =
        WarningCode::ALL.iter().map(|code| format!("- `{}`: {}", code.name(), code.detail())).collect();
    ObjectBuilder::new()
        .schema_type(Type::String)
        .enum_values(Some(WarningCode::ALL.map(WarningCode::name)))
        .description(Some(format!("What, for programs.\n\n{}", meanings.join("\n"))))
        .examples(["tolerance_not_met"])
        .build()
}

/// Why a value is null.
#[derive(Serialize, ToSchema)]
#[schema(as = Diagnostic)]
pub(crate) struct DiagnosticAnswer {
    /// Which direction.
    index: usize,
    /// Why, for programs.
    #[schema(example = "grazing_divergence")]
    code: &'static str,
    /// Why, for people.
    detail: &'static str,
}

impl From<Omitted> for OmittedAnswer {
    fn from(omitted: Omitted) -> Self {
        Self { component: omitted.component.name(), bound: omitted.bound, reason: omitted.reason }
    }
}

impl From<Warning> for WarningAnswer {
    fn from(warning: Warning) -> Self {
        Self {
            code: warning.code.name(),
            detail: warning.code.detail(),
            value: warning.value,
            parameter: warning.parameter,
            indices: warning.indices,
            count: warning.count,
        }
    }
}

impl From<Diagnostic> for DiagnosticAnswer {
    fn from(diagnostic: Diagnostic) -> Self {
        Self { index: diagnostic.index, code: diagnostic.code.name(), detail: diagnostic.code.detail() }
    }
}
