//! Directional-hemispherical reflectance ρ(θ_i): the share of a beam that leaves the surface, by component.
//!
//! ρ = ∫ f_r cos θ_r dω_r over the hemisphere of viewers. The diffuse lobe has it in closed form, ρ of (57). The spike has it
//! where the patch is large against the wavelength: ρ_o² integrates to λ²/A over the solid angle and the spike to F′ e^{−g},
//! g and F′ at the mirror direction. The specular lobe is integrated, to a tolerance.

mod findings;
mod hemisphere;
mod lobe;
#[cfg(test)]
mod tests;

use super::degrees::SinCos;
use super::estimate::Estimate;
use super::fresnel::{Energy, Medium, RefractiveIndex};
use super::fresnel_average::FresnelAverage;
use super::fresnel_average::table::{Reflectivity, SlopeAverages};
use super::geometry::{FacetAngles, Geometry};
use super::numeric::EPSILON;
use super::numeric::lobe_series::patches;
use super::numeric::scaled::Scaled;
use super::outline::{Outline, Parameter, SceneError};
use super::quantity::{SourceZenith, Wavelength};
use super::scene::{Component, Model, Scene, SceneParameters};
use super::shadowing::ShadowingFunction;
use super::unified;
use lobe::{Lobe, Slopes};

/// A scene whose albedo can be evaluated: it needs no sensor, and what it has of one is not used.
#[derive(Clone, Debug)]
pub struct AlbedoScene(Scene);

/// The albedo of one incidence.
#[derive(Clone, Copy, Debug)]
pub struct Albedo {
    /// By component, in the order of [`Component::ALL`]; none where it is not asked for.
    pub components: [Option<Estimate>; 3],
    /// Their sum.
    pub total: Estimate,
    /// F′ of (63) at θ_i, what a smooth plate reflects.
    pub fresnel: f64,
    /// 1 − e^{−g}, g in the mirror direction, where the scene has heights and a wavelength: the total integrated scatter.
    pub scattered: Option<f64>,
    /// Points at which the integrand was taken; 0 without a specular lobe.
    pub evaluations: usize,
}

/// Rounding of g at the mirror direction in ε.
const G_UNITS: f64 = 16.0;

impl AlbedoScene {
    /// Checks the parameters against each other. The tolerance is that of the integral, relative to each total.
    pub fn new(parameters: SceneParameters) -> Result<Self, Vec<SceneError>> {
        let outline = Self::outline(Outline::of(&parameters));
        let errors = outline.errors();
        if !errors.is_empty() {
            return Err(errors);
        }
        let listed = outline.components.as_ref();
        let evaluated = listed.map(|listed| outline.evaluated(parameters.model, listed)).unwrap_or_default();
        Ok(Self(Scene::of_parts(SceneParameters { sensor: None, ..parameters }, evaluated)))
    }

    /// What has to be given for an albedo: no sensor.
    #[must_use]
    pub fn outline(mut outline: Outline) -> Outline {
        outline.absent.retain(|&parameter| parameter != Parameter::Sensor);
        outline
    }

    /// The scene, with the components that are evaluated.
    pub fn scene(&self) -> &Scene {
        &self.0
    }

    /// The same scene in another light: see [`Scene::with_light`].
    #[must_use]
    pub fn with_light(&self, wavelength: Wavelength, index: Option<RefractiveIndex>) -> Self {
        Self(self.0.with_light(wavelength, index))
    }

    /// Whether nothing has to be integrated.
    pub fn is_closed(&self) -> bool {
        !self.0.evaluated().contains(&Component::SpecularLobe)
    }

    /// The albedo of light from this zenith. None as soon as `is_over` says so, which is asked every few microseconds.
    ///
    /// Infinite where a source at exactly 90° meets a lobe without shadowing, which sends light though none arrives.
    pub fn at(&self, theta_i: SourceZenith, is_over: impl Fn() -> bool) -> Option<Albedo> {
        let p = self.0.parameters();
        let source = SinCos::of_degrees(theta_i.get());
        let plate = p.surface.medium.reflectance(source, p.illumination.polarization);
        let g =
            self.0.relative_roughness().map(|roughness| unified::mirror_g(roughness.height, 1.0, source.cos));
        let mut components = [None; 3];
        for &component in self.0.evaluated() {
            components[component.index()] = match component {
                Component::DiffuseLobe => {
                    Some(Estimate::within(Scaled::new(p.surface.diffuse_albedo.get()), 0.0))
                }
                Component::SpecularSpike => g.map(|g| {
                    let share = Estimate::within(Scaled::exp(-g), EPSILON * (4.0 + G_UNITS * g));
                    share.times(plate.into())
                }),
                Component::SpecularLobe => None,
            };
        }
        let mut evaluations = 0;
        if let Some(lobe) = lobe_of(&self.0).filter(|_| !self.is_closed()) {
            let beside = Estimate::total(&components).value.to_f64();
            let (sent, points) = self.sent(&lobe, source, g, beside, is_over)?;
            components[Component::SpecularLobe.index()] = Some(sent);
            evaluations = points;
        }
        let total = Estimate::total(&components);
        Some(Albedo {
            components,
            total,
            fresnel: plate.value,
            // Not −0 for a source at the horizon.
            scattered: g.map(|g| unified::lobe_share(g).abs()),
            evaluations,
        })
    }

    /// Whether the facets have 1 − e^{−g} of the energy and the spike the rest.
    fn shares(&self) -> bool {
        let p = self.0.parameters();
        p.model == Model::Unified && p.surface.specular_scale.is_none()
    }

    /// The albedo of the lobe beside that of the others, and the points at which it was taken.
    fn sent(
        &self,
        lobe: &Lobe,
        source: SinCos,
        g: Option<f64>,
        beside: f64,
        is_over: impl Fn() -> bool,
    ) -> Option<(Estimate, usize)> {
        let is_bare = lobe.shadowing == ShadowingFunction::None;
        if lobe.is_dark() || source.cos == 0.0 && self.shares() {
            return Some((Estimate::ZERO, 0));
        }
        if source.cos == 0.0 && is_bare {
            // No light arrives, and some is sent.
            return Some((Estimate::INFINITE, 0));
        }
        // What does not depend on the viewer.
        let mut factor = Estimate::from(average_of(&self.0, source));
        if self.shares() {
            let share = Scaled::new(g.map_or(1.0, unified::lobe_share));
            factor = factor.times(Estimate::within(share, 28.0 * EPSILON));
        }
        if is_bare {
            factor = factor.scaled_by(Scaled::ONE / Scaled::new(source.cos)).widened(4.0 * EPSILON);
        }
        if factor.value.is_zero() {
            return Some((factor, 0));
        }
        let tolerance = 0.9 * self.0.parameters().accuracy.relative_tolerance.get();
        let beside = (Scaled::new(beside) / factor.value).to_f64();
        let power = lobe.power(source, tolerance, beside, is_over)?;
        let least = Scaled::new((power.value - power.error).max(0.0));
        let power_sent = Estimate { value: Scaled::new(power.value), error: Scaled::new(power.error), least };
        Some((power_sent.times(factor), power.evaluations))
    }
}

/// The specular lobe of a scene, if it has one whose parameters are given.
fn lobe_of(scene: &Scene) -> Option<Lobe> {
    let p = scene.parameters();
    let slopes = if p.model == Model::BeckmannSpizzichino {
        Slopes::Heights {
            roughness: scene.relative_roughness()?,
            method: p.accuracy.method,
            tier: patches::within(0.1 * p.accuracy.relative_tolerance.get()),
        }
    } else {
        let facets = scene.facets?;
        Slopes::Angles { sigma_alpha: facets.sigma_alpha, scale: facets.scale }
    };
    Some(Lobe {
        slopes,
        medium: match scene.fresnel_average() {
            FresnelAverage::HalfVector => p.surface.medium,
            FresnelAverage::MeanPlane | FresnelAverage::SlopeAverage => Medium::PerfectConductor,
        },
        polarization: p.illumination.polarization,
        shadowing: scene.shadowing_function(),
        finest: match scene.slope() {
            Some(slope) if scene.shadowing().needs_slope() => 1.0 / slope.get().max(1.0),
            _ => 1.0,
        },
    })
}

/// F′ of the lobe where it is the same for all viewers; 1 where it is integrated.
fn average_of(scene: &Scene, source: SinCos) -> Energy {
    if scene.fresnel_average() == FresnelAverage::HalfVector {
        return Energy::ONE;
    }
    let level = Geometry::of_facet(&FacetAngles {
        source,
        slope: SinCos { sin: 0.0, cos: 1.0 },
        azimuth: SinCos { sin: 0.0, cos: 1.0 },
        cos_local: source.cos,
        cos_r: source.cos,
    });
    Reflectivity::of(scene, &SlopeAverages::default()).energy(&level)
}

/// The albedo of the lobe of (47) to 0.02 of 1 or of itself, whichever is more, in a quarter of a millisecond: it serves to
/// warn. The source is not at the horizon.
pub(super) fn height_lobe_roughly(scene: &Scene, source: SinCos) -> Option<f64> {
    let lobe = lobe_of(scene)?;
    let over = if lobe.shadowing == ShadowingFunction::None { 1.0 / source.cos } else { 1.0 };
    Some(lobe.roughly(source, 1.0 / over) * over * average_of(scene, source).value)
}
