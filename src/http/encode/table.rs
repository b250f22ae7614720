//! Tables as JSON: an axis, and one series a curve.

use crate::http::api::answer::{DiagnosticAnswer, OmittedAnswer, WarningAnswer};
use crate::http::api::light::MediumAnswer;
use crate::reflectance::evaluate::EvaluatedBy;
use crate::reflectance::table::{Curve, Table};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, Schema, SchemaType, Type};
use utoipa::openapi::{Ref, RefOr};
use utoipa::{PartialSchema, ToSchema};

use super::numbers::Numbers;

/// A tabulated diagram.
#[derive(Serialize, ToSchema)]
pub(crate) struct Diagram {
    /// What the values are.
    #[schema(example = "radiance")]
    quantity: &'static str,
    /// Their unit; empty for a pure number.
    #[schema(example = "W m^-2 sr^-1")]
    unit: &'static str,
    /// What was looked up, where the medium is a material at one wavelength.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    medium: Option<MediumAnswer>,
    /// The angle that runs.
    axis: Axis,
    /// The angle that stays; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    fixed: Option<Fixed>,
    /// φ_r, degrees.
    phi_r_deg: f64,
    /// One for each fixed angle, and for each wavelength where there are several.
    series: Vec<Series>,
}

/// The swept angle.
#[derive(Serialize, ToSchema)]
pub(crate) struct Axis {
    /// Its name.
    #[schema(example = "theta_r_deg")]
    name: &'static str,
    /// Its unit.
    #[schema(example = "degrees")]
    unit: &'static str,
    /// Its values.
    values: Vec<f64>,
}

/// The fixed angle.
#[derive(Serialize, ToSchema)]
pub(crate) struct Fixed {
    /// Its name.
    #[schema(example = "theta_i_deg")]
    name: &'static str,
    /// Its unit.
    #[schema(example = "degrees")]
    unit: &'static str,
}

/// One curve: columns as long as the axis, and what is to be said of them.
pub(crate) struct Series {
    label: Option<String>,
    at_deg: Option<f64>,
    columns: Vec<(&'static str, Numbers)>,
    method: Option<Vec<&'static str>>,
    methods: BTreeMap<&'static str, usize>,
    omitted: Vec<OmittedAnswer>,
    warnings: Vec<WarningAnswer>,
    diagnostics: Vec<DiagnosticAnswer>,
}

impl Diagram {
    /// Of a table; `labelled` tells whether its curves differ by more than the fixed angle.
    pub(crate) fn new(table: Table, labelled: bool) -> Self {
        Self {
            quantity: table.quantity,
            unit: table.unit,
            // No figure of the report names a material.
            medium: None,
            axis: Axis { name: table.axis.name, unit: table.axis.unit, values: table.axis.values },
            fixed: table.fixed.map(|name| Fixed { name, unit: "degrees" }),
            phi_r_deg: table.phi_r_deg,
            series: table.curves.into_iter().map(|curve| Series::new(curve, labelled)).collect(),
        }
    }

    /// About how many bytes it takes as JSON.
    pub(crate) fn size_hint(&self) -> usize {
        let columns: usize = self.series.iter().map(|series| series.columns.len()).sum();
        1024 + 24 * (columns + 1) * self.axis.values.len()
    }
}

impl Series {
    fn new(curve: Curve, labelled: bool) -> Self {
        Self {
            label: labelled.then_some(curve.label),
            at_deg: curve.at_deg,
            columns: curve.columns.into_iter().map(|column| (column.name, Numbers(column.values))).collect(),
            method: curve.method.map(|method| method.into_iter().map(EvaluatedBy::name).collect()),
            methods: curve.methods.into_iter().map(|(method, count)| (method.name(), count)).collect(),
            omitted: curve.omitted.into_iter().map(OmittedAnswer::from).collect(),
            warnings: curve.warnings.into_iter().map(WarningAnswer::from).collect(),
            diagnostics: curve.diagnostics.into_iter().map(DiagnosticAnswer::from).collect(),
        }
    }
}

impl Serialize for Series {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if let Some(label) = &self.label {
            map.serialize_entry("label", label)?;
        }
        if let Some(at) = self.at_deg {
            map.serialize_entry("at_deg", &at)?;
        }
        for (name, column) in &self.columns {
            map.serialize_entry(name, column)?;
        }
        if let Some(method) = &self.method {
            map.serialize_entry("method", method)?;
        }
        map.serialize_entry("methods", &self.methods)?;
        map.serialize_entry("omitted", &self.omitted)?;
        map.serialize_entry("warnings", &self.warnings)?;
        map.serialize_entry("diagnostics", &self.diagnostics)?;
        map.end()
    }
}

/// Columns that a series may have.
const COLUMNS: [(&str, &str); 12] = [
    ("total", "The sum of the components."),
    ("diffuse_lobe", "(57)"),
    ("specular_lobe", "The second term of (47), or (70)."),
    ("specular_spike", "The first term of (47)."),
    ("log10_total", "Decimal logarithm of `total`."),
    ("log10_diffuse_lobe", "Decimal logarithm of `diffuse_lobe`."),
    ("log10_specular_lobe", "Decimal logarithm of `specular_lobe`."),
    ("log10_specular_spike", "Decimal logarithm of `specular_spike`."),
    ("relative_error_bound", "Bound of the relative error of `total`."),
    ("roughness_g", "g of (34), if `output.per_direction` asks for it."),
    ("fresnel_reflectance", "F′ of (63), figure 18 only."),
    ("geometrical_attenuation", "G of (65), figure 19 only."),
];

impl PartialSchema for Series {
    fn schema() -> RefOr<Schema> {
        let number = || ObjectBuilder::new().schema_type(Type::Number);
        let list = |name: &'static str, description: &'static str| {
            let items = Ref::from_schema_name(name);
            utoipa::openapi::ArrayBuilder::new().items(items).description(Some(description))
        };
        let mut object = ObjectBuilder::new()
            .schema_type(SchemaType::Type(Type::Object))
            .description(Some(
                "One curve. Its columns are as long as the axis; a value that is not a number is null.",
            ))
            .property(
                "label",
                ObjectBuilder::new().schema_type(Type::String).description(Some("What it shows.")),
            )
            .property("at_deg", number().description(Some("The fixed angle, degrees.")))
            .property("wavelength_um", number().description(Some("λ, micrometres, where there are several.")))
            .property("medium", Ref::from_schema_name("LookedUp"));
        for (name, description) in COLUMNS {
            object = object.property(name, super::numbers::described(description));
        }
        let counts = ObjectBuilder::new()
            .schema_type(Type::Object)
            .description(Some("How many points each method evaluated."))
            .additional_properties(Some(AdditionalProperties::<Schema>::RefOr(
                ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(1)).into(),
            )));
        let names = utoipa::openapi::ArrayBuilder::new()
            .items(ObjectBuilder::new().schema_type(Type::String))
            .description(Some("The method of each point, if `output.per_direction` asks for it."));
        object
            .property("method", names)
            .property("methods", counts)
            .property("omitted", list("Omitted", "Components left out."))
            .property("warnings", list("Warning", "What the scene strains."))
            .property("diagnostics", list("Diagnostic", "Why values are null; indices count along the axis."))
            .required("methods")
            .required("omitted")
            .required("warnings")
            .required("diagnostics")
            .into()
    }
}

impl ToSchema for Series {
    fn name() -> Cow<'static, str> {
        Cow::Borrowed("Series")
    }

    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        schemas.push((OmittedAnswer::name().into_owned(), OmittedAnswer::schema()));
        schemas.push((WarningAnswer::name().into_owned(), WarningAnswer::schema()));
        schemas.push((DiagnosticAnswer::name().into_owned(), DiagnosticAnswer::schema()));
        schemas.push((MediumAnswer::name().into_owned(), MediumAnswer::schema()));
    }
}
