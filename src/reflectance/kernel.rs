//! A scene made ready: what does not depend on the direction is worked out once, what does is
//! evaluated without allocating.

mod in_lanes;

use super::beckmann_spizzichino::RelativeRoughness;
use super::estimate::Estimate;
use super::fresnel::Medium;
use super::fresnel_average::mean_plane;
use super::fresnel_average::table::{Reflectivity, SlopeAverages};
use super::geometry::Geometry;
use super::lambertian;
use super::numeric::EPSILON;
use super::numeric::lobe_series::lanes::Choice;
use super::numeric::lobe_series::patches::{self, Tier};
use super::numeric::lobe_series::{LobeSeries, Method};
use super::numeric::scaled::Scaled;
use super::quantity::Wavelength;
use super::scene::{Component, FacetParameters, Model, Scene};
use super::shadowing::ShadowingFunction;
use super::torrance_sparrow::FacetLobe;
use super::unified;
use super::view::View;

pub(super) use in_lanes::InLanes;

/// Radiance `L_r` (2), BRDF `f_r = L_r/I_s` (3), or what an image of the surface receives, (51).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// W m⁻² sr⁻¹ (times whatever the irradiance carries).
    Radiance,
    /// sr⁻¹.
    Brdf,
    /// W m⁻² (times whatever the irradiance carries).
    ImageIrradiance {
        /// I_im/L_r of (51), steradian: [`super::radiometry::Camera::image_irradiance_factor`].
        factor: f64,
    },
}

impl Quantity {
    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Radiance => "radiance",
            Self::Brdf => "brdf",
            Self::ImageIrradiance { .. } => "image_irradiance",
        }
    }

    /// The unit of the values.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Radiance => "W m^-2 sr^-1",
            Self::Brdf => "sr^-1",
            Self::ImageIrradiance { .. } => "W m^-2",
        }
    }
}

/// What evaluated a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvaluatedBy {
    /// No series was needed.
    ClosedForm,
    /// The lobe series, by this method (never `auto`).
    Lobe(Method),
    /// The lobe's mean over the cone of a receiver.
    ConeQuadrature,
}

impl EvaluatedBy {
    /// Every possibility, in the order in which they are counted.
    pub const ALL: [Self; 7] = [
        Self::ClosedForm,
        Self::Lobe(Method::Series),
        Self::Lobe(Method::Paper),
        Self::Lobe(Method::Uniform),
        Self::Lobe(Method::Smooth),
        Self::Lobe(Method::Rough),
        Self::ConeQuadrature,
    ];

    /// Its place among all.
    pub(super) const fn index(self) -> usize {
        match self {
            Self::ClosedForm => 0,
            // Auto counts as what it takes.
            Self::Lobe(Method::Auto | Method::Series) => 1,
            Self::Lobe(Method::Paper) => 2,
            Self::Lobe(Method::Uniform) => 3,
            Self::Lobe(Method::Smooth) => 4,
            Self::Lobe(Method::Rough) => 5,
            Self::ConeQuadrature => 6,
        }
    }

    /// The name in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed_form",
            Self::Lobe(method) => method.name(),
            Self::ConeQuadrature => "cone_quadrature",
        }
    }
}

/// One direction's answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reflection {
    /// By [`Component::index`]; none where the component is not evaluated.
    pub(super) components: [Option<Estimate>; 3],
    /// Their sum.
    pub(super) total: Estimate,
    pub(super) evaluated_by: EvaluatedBy,
}

impl Reflection {
    /// Whether the total or a component is not 0 but below the normal numbers.
    fn underflows(&self) -> bool {
        let parts = self.components.iter().flatten().chain([&self.total]);
        parts.map(|part| part.value).any(|value| !value.is_zero() && value.to_f64().abs() < f64::MIN_POSITIVE)
    }
}

/// A scene ready to be evaluated for one quantity.
pub(super) struct Kernel<'a> {
    scene: &'a Scene,
    quantity: Quantity,
    irradiance: f64,
    /// Of the lobe; the spike has the mean plane's.
    reflectivity: Reflectivity<'a>,
    shadowing: ShadowingFunction,
    roughness: Option<RelativeRoughness>,
    view: Option<View>,
    facets: Option<FacetLobe>,
    method: Method,
    /// What the components left out leave of it.
    tolerance: f64,
    /// What `auto` may leave of the series.
    tier: &'static Tier,
}

impl<'a> Kernel<'a> {
    /// The scene is evaluated in its components; `omitted_share` bounds what the others would add, relative, and `averages` are
    /// those of its sources.
    pub(super) fn new(
        scene: &'a Scene,
        quantity: Quantity,
        omitted_share: f64,
        averages: &'a SlopeAverages,
    ) -> Self {
        let p = scene.parameters();
        let wavelength = p.illumination.wavelength.map(Wavelength::get);
        let shadowing = scene.shadowing_function();
        Self {
            scene,
            quantity,
            irradiance: p.illumination.irradiance.get(),
            reflectivity: Reflectivity::of(scene, averages),
            shadowing,
            roughness: scene.relative_roughness(),
            view: p.sensor.zip(wavelength).map(|(sensor, wavelength)| View::new(sensor, wavelength)),
            facets: scene.facets.map(|FacetParameters { sigma_alpha, scale, .. }| FacetLobe {
                sigma_alpha,
                specular_scale: scale,
                medium: p.surface.medium,
                polarization: p.illumination.polarization,
                shadowing,
            }),
            method: p.accuracy.method,
            tolerance: p.accuracy.relative_tolerance.get() - omitted_share,
            tier: patches::within(p.accuracy.relative_tolerance.get()),
        }
    }

    /// The roughness of a scene whose lobe series is evaluated in batches, and by what.
    pub(super) fn series(&self) -> Option<(RelativeRoughness, Choice<'static>)> {
        let is_needed = self.scene.parameters().model == Model::BeckmannSpizzichino
            && self.scene.evaluated().contains(&Component::SpecularLobe);
        let choice = match self.method {
            Method::Auto => Choice::auto(self.tier),
            Method::Uniform => Choice::uniform(),
            Method::Series | Method::Paper | Method::Smooth | Method::Rough => return None,
        };
        self.roughness.filter(|_| is_needed).map(|roughness| (roughness, choice))
    }

    /// g of (34) between these directions, where the scene has heights and a wavelength.
    pub(super) fn g(&self, geometry: &Geometry) -> Option<f64> {
        self.roughness.map(|roughness| roughness.g(geometry))
    }

    /// Whether the spike is evaluated.
    pub(super) fn has_spike(&self) -> bool {
        self.scene.evaluated().contains(&Component::SpecularSpike)
    }

    /// Whether a batch gives the best there is.
    fn is_at_its_best(&self) -> bool {
        self.tier.is_full() || self.method != Method::Auto
    }

    /// Whether a bound keeps the tolerance.
    pub(super) fn keeps(&self, bound: f64) -> bool {
        bound <= self.tolerance
    }

    /// Whether a bound keeps the tolerance, or no method could keep it.
    pub(super) fn is_enough(&self, bound: f64, rounding: f64) -> bool {
        self.keeps(bound) || rounding > self.tolerance || self.is_at_its_best()
    }

    /// The evaluated components in one direction, from a value of S that is good enough for the tolerance in most
    /// directions; else from the best one. Where a value underflows its logarithm is all there is of it: if
    /// `logarithms` are asked for they come from the best.
    pub(super) fn reflect(
        &self,
        geometry: &Geometry,
        series: Option<LobeSeries>,
        logarithms: bool,
    ) -> Reflection {
        if let Some(series) = series {
            let reflection = self.reflect_by(geometry, Some(&series));
            let is_enough = reflection.total.relative_error() <= self.tolerance
                && !(logarithms && reflection.underflows());
            if is_enough || self.is_at_its_best() {
                return reflection;
            }
        }
        self.reflect_by(geometry, None)
    }

    /// The evaluated components in one direction.
    fn reflect_by(&self, geometry: &Geometry, series: Option<&LobeSeries>) -> Reflection {
        let mut components = [None; 3];
        let mut evaluated_by = EvaluatedBy::ClosedForm;
        for &component in self.scene.evaluated() {
            components[component.index()] = match component {
                Component::DiffuseLobe => Some(self.diffuse_lobe(geometry)),
                Component::SpecularLobe => self.specular_lobe(geometry, series).map(|(lobe, by)| {
                    evaluated_by = by;
                    lobe
                }),
                Component::SpecularSpike => self.spike(geometry).map(|spike| self.imaged(spike)),
            };
        }
        Reflection { total: Estimate::total(&components), components, evaluated_by }
    }

    /// The specular lobe from a value of S that is good enough for the tolerance in most directions, else from the best.
    pub(super) fn lobe(&self, geometry: &Geometry, series: Option<LobeSeries>) -> Option<Estimate> {
        if let Some(series) = series {
            let (lobe, _) = self.specular_lobe(geometry, Some(&series))?;
            if lobe.relative_error() <= self.tolerance || self.is_at_its_best() {
                return Some(lobe);
            }
        }
        self.specular_lobe(geometry, None).map(|(lobe, _)| lobe)
    }

    /// The specular lobe, and what evaluated it.
    fn specular_lobe(
        &self,
        geometry: &Geometry,
        series: Option<&LobeSeries>,
    ) -> Option<(Estimate, EvaluatedBy)> {
        let reflectance = match self.reflectivity.medium {
            Medium::PerfectConductor => None,
            Medium::Index(_) => Some(self.reflectivity.energy(geometry).into()),
        };
        if self.scene.parameters().model != Model::BeckmannSpizzichino {
            let lobe = self.facet_lobe(geometry, reflectance)?;
            return Some((self.imaged(lobe), EvaluatedBy::ClosedForm));
        }
        let roughness = self.roughness?;
        let over = self.shadowing_over_cosines(geometry);
        let (lobe, method) = match series {
            Some(series) => (roughness.lobe_of(geometry, over, series), series.method),
            None => roughness.lobe(geometry, over, self.method),
        };
        let lobe = self.with_reflectance(self.with_shadowing_error(lobe), reflectance);
        Some((self.imaged(lobe), EvaluatedBy::Lobe(method)))
    }

    /// (51): a radiance as the image receives it.
    fn imaged(&self, value: Estimate) -> Estimate {
        match self.quantity {
            // Nine roundings at most make the factor.
            Quantity::ImageIrradiance { factor } => {
                value.times(Estimate::within(Scaled::new(factor), 12.0 * EPSILON))
            }
            Quantity::Radiance | Quantity::Brdf => value,
        }
    }

    /// What is evaluated.
    pub(super) fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// (57): radiance κ_diff · irradiance · cos θ_i, BRDF κ_diff.
    pub(super) fn diffuse_lobe(&self, geometry: &Geometry) -> Estimate {
        let p = self.scene.parameters();
        let (albedo, irradiance) = (p.surface.diffuse_albedo, p.illumination.irradiance);
        let value = match self.quantity {
            Quantity::Radiance | Quantity::ImageIrradiance { .. } => {
                lambertian::radiance(albedo, irradiance, geometry.cos_i)
            }
            Quantity::Brdf => lambertian::kappa_diff(albedo),
        };
        self.imaged(Estimate::within(value, 8.0 * EPSILON))
    }

    /// Whether the facets have 1 − e^{−g} of the energy and the spike the rest.
    fn shares_with_spike(&self) -> bool {
        let p = self.scene.parameters();
        p.model == Model::Unified && p.surface.specular_scale.is_none()
    }

    /// (70), times 1 − e^{-g} where it shares the energy with a spike.
    fn facet_lobe(&self, geometry: &Geometry, reflectance: Option<Estimate>) -> Option<Estimate> {
        if !self.shares_with_spike() {
            let lobe = self.facets?.lobe(geometry, self.shadowing_over_cosines(geometry));
            return Some(self.with_reflectance(lobe, reflectance));
        }
        let g = unified::mirror_g(self.roughness?.height, 1.0, geometry.cos_i);
        let share = unified::lobe_share(g);
        if share == 0.0 && matches!(self.shadowing, ShadowingFunction::Smith(_)) {
            // At grazing 1 − e^{-g} goes with cos² θ_i, and Smith's G over both cosines not with more than 1/cos θ_i.
            return Some(Estimate::ZERO);
        }
        let (over_cosines, share) = match (self.quantity, self.shadowing) {
            // Nothing else makes up for the 1/cos θ_i of a BRDF: 1 − e^{-g} goes with cos² θ_i.
            (Quantity::Brdf, ShadowingFunction::None) => (
                self.shadowing.factor_over_cos_r(geometry),
                if geometry.cos_i == 0.0 {
                    Scaled::ZERO
                } else {
                    Scaled::new(share) / Scaled::new(geometry.cos_i)
                },
            ),
            _ => (self.shadowing_over_cosines(geometry), Scaled::new(share)),
        };
        // 1 − e^{-g} has no larger relative error than g, 16 ε, and 4 ε of its own; the cosine 4 ε.
        let lobe = self.facets?.lobe(geometry, over_cosines).times(Estimate::within(share, 28.0 * EPSILON));
        Some(self.with_reflectance(lobe, reflectance))
    }

    /// The spike of (47), with F′ at θ_i: it is what the mean plane reflects. Its BRDF divides by cos θ_i, which cancels one
    /// of the two it carries.
    fn spike(&self, geometry: &Geometry) -> Option<Estimate> {
        let Reflectivity { medium, polarization, .. } = self.reflectivity;
        let reflectance = match medium {
            Medium::PerfectConductor => None,
            Medium::Index(_) => Some(mean_plane(&medium, polarization, geometry).into()),
        };
        let patch = self.view?.patch(geometry.cos_r);
        let power = match self.quantity {
            Quantity::Radiance | Quantity::ImageIrradiance { .. } => geometry.cos_i * geometry.cos_i,
            Quantity::Brdf => geometry.cos_i,
        };
        Some(self.with_reflectance(self.roughness?.spike(geometry, power, &patch), reflectance))
    }

    /// (41) and (71): F′; and the irradiance where a radiance is asked for.
    fn with_reflectance(&self, lobe: Estimate, reflectance: Option<Estimate>) -> Estimate {
        let reflected = match reflectance {
            None => lobe,
            // No surface, no reflection: not even at grazing.
            Some(none) if none == Estimate::ZERO => Estimate::ZERO,
            Some(share) => lobe.times(share),
        };
        match self.quantity {
            Quantity::Radiance | Quantity::ImageIrradiance { .. } => {
                reflected.scaled_by(Scaled::new(self.irradiance))
            }
            Quantity::Brdf => reflected,
        }
    }

    /// What Smith's G has more of an error than [`RelativeRoughness::lobe`] allows it.
    fn with_shadowing_error(&self, lobe: Estimate) -> Estimate {
        match self.shadowing {
            ShadowingFunction::None | ShadowingFunction::VGroove => lobe,
            ShadowingFunction::Smith(_) => lobe.widened(EPSILON * self.shadowing.units()),
        }
    }

    /// G/cos θ_r for a radiance, G/(cos θ_i cos θ_r) for a BRDF, in forms that keep their limits.
    fn shadowing_over_cosines(&self, geometry: &Geometry) -> f64 {
        match self.quantity {
            Quantity::Radiance | Quantity::ImageIrradiance { .. } => {
                self.shadowing.factor_over_cos_r(geometry)
            }
            Quantity::Brdf => self.shadowing.factor_over_cosines(geometry),
        }
    }
}
