//! What is answered of albedos: the same numbers as columns of JSON and as rows of tables.

use crate::http::api::answer::{DiagnosticAnswer, WarningAnswer};
use crate::http::api::light::{Light, Line, MediumAnswer};
use crate::http::encode::json;
use crate::http::encode::numbers::Numbers;
use crate::http::encode::rows::{Cells, Head, Heading, Kind, Rows};
use crate::http::problem::Problem;
use crate::reflectance::albedo::{Albedo, AlbedoScene};
use crate::reflectance::material::Lookup;
use crate::reflectance::quantity::SourceZenith;
use crate::reflectance::scene::Component;
use serde::Serialize;
use utoipa::ToSchema;

/// Directional-hemispherical reflectances: of one light, or of each of several.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
#[schema(as = AlbedoOrSpectrum)]
pub(crate) enum AlbedoOrSpectrum {
    /// Of one light.
    Albedo(Box<AlbedoAnswer>),
    /// Of each wavelength.
    Spectrum(AlbedoSpectrum),
}

/// Directional-hemispherical reflectances of one light.
#[derive(Serialize, ToSchema)]
#[schema(as = Albedo)]
pub(crate) struct AlbedoAnswer {
    /// `albedo`.
    #[schema(example = "albedo")]
    quantity: &'static str,
    #[serde(flatten)]
    values: AlbedoValues,
}

/// Directional-hemispherical reflectances at several wavelengths, in the order of the request's array.
#[derive(Serialize, ToSchema)]
pub(crate) struct AlbedoSpectrum {
    /// `albedo`.
    #[schema(example = "albedo")]
    quantity: &'static str,
    /// One for each wavelength.
    spectrum: Vec<AlbedoLine>,
}

/// Those at one of several wavelengths.
#[derive(Serialize, ToSchema)]
pub(crate) struct AlbedoLine {
    /// λ, micrometres.
    wavelength_um: f64,
    #[serde(flatten)]
    values: AlbedoValues,
}

/// Directional-hemispherical reflectances, shares of the incident power, in the order of the incidences. A value that is
/// infinite is null, and `diagnostics` says why.
#[derive(Serialize, ToSchema)]
pub(crate) struct AlbedoValues {
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

/// A number that is answered of each incidence.
#[derive(Clone, Copy)]
struct Field {
    name: &'static str,
    /// Whether the answers to a scene have it.
    is_there: fn(&AlbedoScene) -> bool,
    value: fn(&AlbedoScene, &Albedo) -> f64,
}

const fn component<const INDEX: usize>() -> Field {
    let component = Component::ALL[INDEX];
    Field {
        name: component.name(),
        is_there: |scene| scene.scene().evaluated().contains(&Component::ALL[INDEX]),
        value: |_, albedo| albedo.components[INDEX].map_or(f64::NAN, |part| part.value.to_f64()),
    }
}

const fn always(name: &'static str, value: fn(&AlbedoScene, &Albedo) -> f64) -> Field {
    Field { name, is_there: |_| true, value }
}

/// All that there may be, in the order of tables.
const FIELDS: [Field; 11] = [
    always("total", |_, albedo| albedo.total.value.to_f64()),
    component::<0>(),
    component::<1>(),
    component::<2>(),
    always("relative_error_bound", |_, albedo| albedo.total.relative_error()),
    always("fresnel_reflectance", |_, albedo| albedo.fresnel),
    Field {
        name: "excess",
        is_there: AlbedoScene::has_excess,
        value: |scene, albedo| scene.excess(albedo).unwrap_or(f64::NAN),
    },
    Field {
        name: "total_integrated_scatter",
        is_there: AlbedoScene::has_heights,
        value: |_, albedo| albedo.scattered.unwrap_or(f64::NAN),
    },
    Field {
        name: "scattered_reflectance",
        is_there: AlbedoScene::has_heights,
        value: |_, albedo| albedo.scattered.map_or(f64::NAN, |scattered| scattered * albedo.fresnel),
    },
    Field {
        name: "spike_share",
        is_there: AlbedoScene::has_shares,
        value: |_, albedo| AlbedoScene::shares_of(albedo).map_or(f64::NAN, |shares| shares[0]),
    },
    Field {
        name: "lobe_share",
        is_there: AlbedoScene::has_shares,
        value: |_, albedo| AlbedoScene::shares_of(albedo).map_or(f64::NAN, |shares| shares[1]),
    },
];

impl AlbedoValues {
    fn new(
        scene: &AlbedoScene,
        lookup: Option<Lookup>,
        incidences: &[SourceZenith],
        albedos: &[Albedo],
    ) -> Self {
        let column = |name: &str| {
            let field = FIELDS.iter().find(|field| field.name == name && (field.is_there)(scene))?;
            Some(Numbers(albedos.iter().map(|albedo| (field.value)(scene, albedo)).collect()))
        };
        let always = |name: &str| column(name).unwrap_or_else(|| Numbers(Vec::new()));
        Self {
            medium: lookup.map(MediumAnswer::from),
            theta_i_deg: Numbers(incidences.iter().map(|theta_i| theta_i.get()).collect()),
            total: always("total"),
            diffuse_lobe: column("diffuse_lobe"),
            specular_lobe: column("specular_lobe"),
            specular_spike: column("specular_spike"),
            relative_error_bound: always("relative_error_bound"),
            fresnel_reflectance: always("fresnel_reflectance"),
            excess: column("excess"),
            total_integrated_scatter: column("total_integrated_scatter"),
            scattered_reflectance: column("scattered_reflectance"),
            spike_share: column("spike_share"),
            lobe_share: column("lobe_share"),
            evaluations: albedos.iter().map(|albedo| albedo.evaluations).sum(),
            assumptions: assumptions(scene),
            warnings: scene.warnings(incidences, albedos).into_iter().map(WarningAnswer::from).collect(),
            diagnostics: AlbedoScene::diagnostics(albedos).into_iter().map(DiagnosticAnswer::from).collect(),
        }
    }
}

fn assumptions(scene: &AlbedoScene) -> Vec<&'static str> {
    let has_spike = scene.scene().evaluated().contains(&Component::SpecularSpike);
    [(has_spike, LARGE_PATCH), (!scene.is_closed(), ONCE)]
        .into_iter()
        .filter_map(|(holds, assumption)| holds.then_some(assumption))
        .collect()
}

/// What is asked for: one row a wavelength and incidence.
#[derive(Debug)]
pub(super) struct Table {
    /// One for each wavelength.
    scenes: Vec<AlbedoScene>,
    light: Light,
    incidences: Vec<SourceZenith>,
}

impl Table {
    pub(super) fn new(scene: AlbedoScene, light: Light, incidences: Vec<SourceZenith>) -> Self {
        let scenes = match &light {
            Light::One(_) => vec![scene],
            Light::Spectrum(lines) => {
                lines.iter().map(|line| scene.with_light(line.wavelength, line.index())).collect()
            }
        };
        Self { scenes, light, incidences }
    }

    /// How many rows.
    pub(super) fn rows(&self) -> usize {
        self.scenes.len() * self.incidences.len()
    }

    /// Whether nothing has to be integrated.
    pub(super) fn is_closed(&self) -> bool {
        self.scenes.iter().all(AlbedoScene::is_closed)
    }

    /// A row's albedo; none as soon as `is_over` says so.
    pub(super) fn at(&self, row: usize, is_over: impl Fn() -> bool) -> Option<Albedo> {
        self.scenes[row / self.incidences.len()].at(self.incidences[row % self.incidences.len()], is_over)
    }

    fn lines(&self) -> Option<&[Line]> {
        match &self.light {
            Light::One(_) => None,
            Light::Spectrum(lines) => Some(lines),
        }
    }

    /// All of it, from an albedo a row.
    pub(super) fn json(&self, albedos: &[Albedo]) -> Result<Vec<u8>, Problem> {
        let quantity = "albedo";
        let parts = self.scenes.iter().zip(albedos.chunks(self.incidences.len()));
        let values = |scene, lookup, albedos| AlbedoValues::new(scene, lookup, &self.incidences, albedos);
        let answer = match &self.light {
            Light::One(lookup) => AlbedoOrSpectrum::Albedo(Box::new(AlbedoAnswer {
                quantity,
                values: values(&self.scenes[0], *lookup, albedos),
            })),
            Light::Spectrum(lines) => {
                let line = |(line, (scene, albedos)): (&Line, (_, _))| AlbedoLine {
                    wavelength_um: line.wavelength.get(),
                    values: values(scene, line.lookup, albedos),
                };
                AlbedoOrSpectrum::Spectrum(AlbedoSpectrum {
                    quantity,
                    spectrum: lines.iter().zip(parts).map(line).collect(),
                })
            }
        };
        json::bytes(&answer, 1024 + 256 * albedos.len())
    }

    fn fields(&self) -> impl Iterator<Item = Field> + '_ {
        FIELDS.into_iter().filter(|field| (field.is_there)(&self.scenes[0]))
    }

    /// What stands before the rows. With the albedos known, their warnings too: those of the first wavelength first.
    pub(super) fn head(&self, albedos: Option<&[Albedo]>) -> Result<Head, Problem> {
        let number = |name| Heading { name, unit: "", kind: Kind::Number };
        let mut columns: Vec<_> = self.lines().map(|_| number("wavelength_um")).into_iter().collect();
        columns.push(number("theta_i_deg"));
        columns.extend(self.fields().map(|field| number(field.name)));
        let mut notes =
            vec![("quantity", "albedo".to_owned()), ("assumptions", assumptions(&self.scenes[0]).join("; "))];
        if let Some(albedos) = albedos {
            let parts = self.scenes.iter().zip(albedos.chunks(self.incidences.len()));
            let warnings: Vec<_> = parts
                .flat_map(|(scene, albedos)| scene.warnings(&self.incidences, albedos))
                .map(WarningAnswer::from)
                .collect();
            notes.push(("warnings", String::from_utf8(json::bytes(&warnings, 1024)?).unwrap_or_default()));
        }
        Ok(Head { columns, rows: self.rows(), notes })
    }

    /// Consecutive rows from `first` on.
    pub(super) fn some_rows(&self, first: usize, albedos: &[Albedo]) -> Rows<'static> {
        let count = albedos.len();
        let scene = |place: usize| (first + place) / self.incidences.len();
        let cells =
            |value: &dyn Fn(usize) -> f64| Cells::Numbers((0..count).map(value).collect::<Vec<_>>().into());
        let mut columns: Vec<_> = self
            .lines()
            .map(|lines| cells(&|place| lines[scene(place)].wavelength.get()))
            .into_iter()
            .collect();
        columns.push(cells(&|place| self.incidences[(first + place) % self.incidences.len()].get()));
        columns.extend(
            self.fields()
                .map(|field| cells(&|place| (field.value)(&self.scenes[scene(place)], &albedos[place]))),
        );
        Rows { count, columns }
    }
}
