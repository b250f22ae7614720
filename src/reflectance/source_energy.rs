//! How much of a source's light the components send back, and how much of it meets the surface again: what warnings
//! about energy rest on.

use super::degrees::SinCos;
use super::directions::Directions;
use super::facet_energy::{Facet, Facets};
use super::findings::{Concern, Warning, WarningCode};
use super::fresnel::{Medium, Polarization};
use super::requirement;
use super::scene::{Component, FacetParameters, Model, Scene};
use super::shadowing::Shadowing;
use super::strain;
use super::surface::Regime;
use super::unified;

/// What the quadrature may be off by; an albedo above 1 is told from this on.
const COARSE: f64 = 0.03;
/// A share of the light that meets the surface again is told from this on.
const AGAIN_FROM: f64 = 0.1;
/// The quadrature divides by cos θ_i, so that sources beyond are judged at this zenith, degrees.
const STEEPEST: f64 = 85.0;
/// Zeniths of the source at which it is done, where they differ; between them it is interpolated.
const NODES: usize = 5;

/// The facets of a scene and what they reflect.
pub(super) struct SourceEnergy {
    /// Those of the lobe, if there is one whose facets are known.
    lobe: Option<Lobe>,
    /// ρ, where the diffuse lobe is there.
    diffuse: f64,
    /// Whether there is a spike.
    spike: bool,
    /// σ_h/λ
    height: Option<f64>,
    /// Whether the lobe carries 1 − e^{−g} of the light: by its factor, or because it is a lobe of heights.
    shares: bool,
    /// A lobe of heights has facets only where the surface is rough.
    rough_only: bool,
    medium: Medium,
    polarization: Polarization,
}

struct Lobe {
    facets: Facets,
    /// The same slopes, their areas adding up to the mean plane's, of which Smith's Λ speaks.
    slopes: Facets,
    /// Beckmann's m of them.
    width: f64,
    /// c·a_f over the value with which the facets' projections add up to the mean plane.
    strength: f64,
    shadowing: Shadowing,
}

impl SourceEnergy {
    /// None for a scene that cannot reflect more than arrives, nor twice.
    pub(super) fn of(scene: &Scene) -> Option<Self> {
        let p = scene.parameters();
        let has = |component| scene.evaluated().contains(&component);
        let diffuse = if has(Component::DiffuseLobe) { p.surface.diffuse_albedo.get() } else { 0.0 };
        let heights = p.model == Model::BeckmannSpizzichino;
        let lobe = if has(Component::SpecularLobe) { Lobe::of(scene) } else { None };
        let spike = has(Component::SpecularSpike) || requirement::lacks_sensor(scene);
        (lobe.is_some() || diffuse > 0.0 && spike).then_some(Self {
            lobe,
            diffuse,
            spike,
            height: scene.relative_roughness().map(|roughness| roughness.height),
            shares: heights || p.model == Model::Unified && p.surface.specular_scale.is_none(),
            rough_only: heights,
            medium: p.surface.medium,
            polarization: p.illumination.polarization,
        })
    }

    /// The directional albedo, and the share of what facets reflect that meets the surface again.
    fn at(&self, theta_i: f64) -> (f64, f64) {
        let source = SinCos::of_degrees(theta_i.min(STEEPEST));
        let g = self.height.map(|height| unified::mirror_g(height, 1.0, source.cos));
        let scattered = if self.shares { g.map_or(1.0, unified::lobe_share) } else { 1.0 };
        let reflectance = |local: SinCos| match self.medium {
            Medium::PerfectConductor => 1.0,
            Medium::Index(index) => index.energies(local).mixed(self.polarization).value,
        };
        let coherent =
            if self.spike { g.map_or(0.0, unified::spike_share) * reflectance(source) } else { 0.0 };
        let mut albedo = self.diffuse + coherent;
        let Some(lobe) = &self.lobe else { return (albedo, 0.0) };
        let again = scattered * lobe.again(source, theta_i);
        if self.rough_only && g.is_none_or(|g| g < Regime::ROUGH_FROM) {
            // What the spike lacks the lobe has (errata E19).
            return (0.0, again);
        }
        // The facets that face the source add up to 1 + Λ times what it sees of the plane: nothing to integrate where
        // that suffices.
        let most =
            albedo + scattered * lobe.strength * (1.0 + strain::lambda(theta_i.min(STEEPEST), lobe.width));
        if most <= 1.0 + COARSE {
            return (most, again);
        }
        albedo += scattered
            * lobe.facets.albedo(source, |facet| {
                let seen = match lobe.shadowing {
                    Shadowing::None => 1.0,
                    Shadowing::VGroove => facet.groove(),
                };
                seen * reflectance(facet.local)
            });
        (albedo, again)
    }
}

impl Lobe {
    fn of(scene: &Scene) -> Option<Self> {
        let width = strain::slope_width(scene)?;
        // Facets of every slope: as steep as makes no difference.
        let slopes = Facets::of_slopes(width.min(1e3));
        let (facets, strength) = if scene.parameters().model == Model::BeckmannSpizzichino {
            (slopes.clone(), 1.0)
        } else {
            let FacetParameters { sigma_alpha, tiling_scale, scale } = scene.facets?;
            (Facets::of_angles(sigma_alpha, scale), scale / tiling_scale)
        };
        Some(Self { facets, slopes, width, strength, shadowing: scene.shadowing() })
    }

    /// 1 less the light that leaves after one reflection, with Smith's masking and shadowing.
    fn again(&self, source: SinCos, theta_i: f64) -> f64 {
        let incident = strain::lambda(theta_i.min(STEEPEST), self.width);
        // 95 % of the facets have a slope below 1.73 m. Where what those reflect leaves almost unhindered, the share
        // is below a tenth.
        let extreme = theta_i + 2.0 * super::degrees::from_radians(libm::atan(1.73 * self.width));
        if extreme < 90.0 && incident < 0.02 && strain::lambda(extreme, self.width) < 0.05 {
            return 0.0;
        }
        let leaving = self.slopes.albedo(source, |facet: &Facet| {
            let view = SinCos { sin: (1.0 - facet.cos_r * facet.cos_r).max(0.0).sqrt(), cos: facet.cos_r };
            1.0 / (1.0 + incident + super::shadowing::smith_lambda(view, self.width))
        });
        (1.0 - leaving).max(0.0)
    }
}

/// Albedo and repeated reflection over the zeniths of the sources.
pub(super) struct Sources {
    from: f64,
    to: f64,
    /// At equal steps from `from` to `to`.
    nodes: Vec<(f64, f64)>,
}

impl Sources {
    /// For sources between two zeniths, degrees.
    pub(super) fn new(energy: &SourceEnergy, [from, to]: [f64; 2]) -> Self {
        let count = if from == to { 1 } else { NODES };
        let step = if count == 1 { 0.0 } else { (to - from) / (count - 1) as f64 };
        Self { from, to, nodes: (0..count).map(|node| energy.at(from + step * node as f64)).collect() }
    }

    /// Both, at a zenith between the ends.
    fn at(&self, theta_i: f64) -> (f64, f64) {
        let last = self.nodes.len() - 1;
        if last == 0 {
            return self.nodes[0];
        }
        let place = (theta_i - self.from) / (self.to - self.from) * last as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the last but one")]
        let node = (place.max(0.0) as usize).min(last - 1);
        let ((albedo, again), (next_albedo, next_again)) = (self.nodes[node], self.nodes[node + 1]);
        let rest = place - node as f64;
        (albedo + rest * (next_albedo - albedo), again + rest * (next_again - again))
    }

    /// What there is to say.
    pub(super) fn warnings(&self, directions: &Directions) -> impl Iterator<Item = Warning> + use<> {
        let (mut more, mut again) = (Concern::default(), Concern::default());
        let any = |get: fn(&(f64, f64)) -> f64, limit: f64| self.nodes.iter().any(|node| get(node) > limit);
        if any(|node| node.0, 1.0 + COARSE) || any(|node| node.1, AGAIN_FROM) {
            for index in 0..directions.count() {
                let (albedo, share) = self.at(directions.angles(index).0.get());
                if share > AGAIN_FROM {
                    again.add(index, share);
                }
                if albedo > 1.0 + COARSE {
                    more.add(index, albedo);
                }
            }
        }
        let (largest, share) = (more.largest, again.largest);
        again
            .warning(WarningCode::MultipleScatteringSignificant, Some(share))
            .into_iter()
            .chain(more.warning(WarningCode::EnergyAboveOne, Some(largest)))
    }
}
