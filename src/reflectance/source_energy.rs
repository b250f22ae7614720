//! How much of a source's light the components send back, and how much of it meets the surface again: what warnings
//! about energy rest on.

use super::albedo;
use super::degrees::SinCos;
use super::directions::Directions;
use super::facet_energy::{Facet, Facets};
use super::findings::{Concern, Warning, WarningCode};
use super::fresnel::{Medium, Polarization};
use super::fresnel_average::FresnelAverage;
use super::requirement;
use super::scene::{Component, FacetParameters, Model, Scene};
use super::shadowing::{Shadowing, smith_lambda, smith_visible_roughly};
use super::strain;
use super::surface::Regime;
use super::unified;
use core::cell::OnceCell;
use core::f64::consts::PI;

/// What the quadrature may be off by; an albedo above 1 is told from this on.
const COARSE: f64 = 0.05;
/// A share of the light that meets the surface again is told from this on.
const AGAIN_FROM: f64 = 0.1;
/// The quadrature divides by cos θ_i, so that sources beyond are judged at this zenith, degrees.
const STEEPEST: f64 = 85.0;
/// Zeniths of the source at which it is done, where they differ; between them it is interpolated.
const NODES: usize = 5;

/// The facets of a scene and what they reflect.
pub(super) struct SourceEnergy<'a> {
    scene: &'a Scene,
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
    /// Over what F of the lobe is averaged.
    average: FresnelAverage,
    /// Made when it is needed, as the facets are.
    fresnel: OnceCell<FresnelTable>,
}

/// F′ over cos θ′, linear between equal steps: good to 0.02 for indices from 1 to 3, and where it falls faster still between 0
/// and 1.
struct FresnelTable([f64; FRESNEL_NODES]);

const FRESNEL_NODES: usize = 25;

impl FresnelTable {
    fn new(medium: Medium, polarization: Polarization) -> Self {
        Self(match medium {
            Medium::PerfectConductor => [1.0; FRESNEL_NODES],
            Medium::Index(index) => core::array::from_fn(|node| {
                let cos = node as f64 / (FRESNEL_NODES - 1) as f64;
                index.energies(SinCos { sin: (1.0 - cos * cos).sqrt(), cos }).mixed(polarization).value
            }),
        })
    }

    fn at(&self, cos_local: f64) -> f64 {
        let place = cos_local * (FRESNEL_NODES - 1) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the last but one")]
        let node = (place.max(0.0) as usize).min(FRESNEL_NODES - 2);
        self.0[node] + (place - node as f64) * (self.0[node + 1] - self.0[node])
    }
}

struct Lobe {
    /// σ_α and c·a_f; none for a lobe of heights.
    angles: Option<FacetParameters>,
    facets: OnceCell<Facets>,
    /// Beckmann's m of slopes whose areas add up to the mean plane's, of which Smith's Λ speaks.
    width: f64,
    slopes: OnceCell<Facets>,
    shadowing: Shadowing,
}

impl<'a> SourceEnergy<'a> {
    /// None for a scene that cannot reflect more than arrives, nor twice.
    pub(super) fn of(scene: &'a Scene) -> Option<Self> {
        let p = scene.parameters();
        let has = |component| scene.evaluated().contains(&component);
        let diffuse = if has(Component::DiffuseLobe) { p.surface.diffuse_albedo.get() } else { 0.0 };
        let heights = p.model == Model::BeckmannSpizzichino;
        let lobe = if has(Component::SpecularLobe) { Lobe::of(scene) } else { None };
        let spike = has(Component::SpecularSpike) || requirement::lacks_sensor(scene);
        (lobe.is_some() || diffuse > 0.0 && spike).then_some(Self {
            scene,
            lobe,
            diffuse,
            spike,
            height: scene.relative_roughness().map(|roughness| roughness.height),
            shares: heights || p.model == Model::Unified && p.surface.specular_scale.is_none(),
            rough_only: heights,
            medium: p.surface.medium,
            polarization: p.illumination.polarization,
            average: scene.fresnel_average(),
            fresnel: OnceCell::new(),
        })
    }

    /// The directional albedo, and the share of what facets reflect that meets the surface again.
    fn at(&self, theta_i: f64) -> (f64, f64) {
        let source = SinCos::of_degrees(theta_i.min(STEEPEST));
        let g = self.height.map(|height| unified::mirror_g(height, 1.0, source.cos));
        let scattered = if self.shares { g.map_or(1.0, unified::lobe_share) } else { 1.0 };
        let coherent =
            if self.spike { g.map_or(0.0, unified::spike_share) * self.reflectance(source.cos) } else { 0.0 };
        let mut albedo = self.diffuse + coherent;
        let Some(lobe) = &self.lobe else { return (albedo, 0.0) };
        let again = scattered * lobe.again(source, theta_i);
        if self.rough_only && g.is_none_or(|g| g < Regime::ROUGH_FROM) {
            return (coherent + self.of_heights(lobe, source), again);
        }
        // The facets that face the source add up to 1 + Λ times what it sees of the plane: nothing to integrate where
        // that suffices.
        let incident = strain::lambda(theta_i.min(STEEPEST), lobe.width);
        let most = albedo + scattered * lobe.strength() * (1.0 + incident);
        if most <= 1.0 + COARSE {
            return (most, again);
        }
        let common = match self.average {
            FresnelAverage::HalfVector => None,
            FresnelAverage::MeanPlane => Some(self.reflectance(source.cos)),
            FresnelAverage::SlopeAverage => Some(lobe.slopes().mean(source, |local| self.reflectance(local))),
        };
        albedo += scattered
            * lobe.facets().albedo(source, |facet| {
                let seen = match lobe.shadowing {
                    Shadowing::None => 1.0,
                    Shadowing::VGroove => facet.groove(),
                    Shadowing::Smith => lobe.seen(facet, incident, true),
                    Shadowing::SmithUncorrelated => lobe.seen(facet, incident, false),
                };
                seen * common.unwrap_or_else(|| self.reflectance(facet.cos_local))
            });
        (albedo, again)
    }

    /// The albedo of the lobe of (47) on a surface that is not rough, or 0 where that cannot make more than arrives: what the
    /// spike lacks the lobe has (errata E19), but near grazing it has more.
    fn of_heights(&self, lobe: &Lobe, source: SinCos) -> f64 {
        // Waves spread the light as slopes of λ/(2π T cos θ_i) do.
        let spread = self
            .scene
            .relative_roughness()
            .map_or(0.0, |roughness| 0.5 / (PI * roughness.correlation_length * source.cos));
        let width = libm::hypot(lobe.width, spread);
        if source.sin == 0.0 || smith_lambda(source, width) <= COARSE {
            return 0.0;
        }
        albedo::height_lobe_roughly(self.scene, source).unwrap_or(0.0)
    }

    /// F′
    fn reflectance(&self, cos_local: f64) -> f64 {
        self.fresnel.get_or_init(|| FresnelTable::new(self.medium, self.polarization)).at(cos_local)
    }
}

impl Lobe {
    fn of(scene: &Scene) -> Option<Self> {
        let width = strain::slope_width(scene)?;
        let heights = scene.parameters().model == Model::BeckmannSpizzichino;
        let angles = if heights { None } else { Some(scene.facets?) };
        Some(Self {
            angles,
            facets: OnceCell::new(),
            width,
            slopes: OnceCell::new(),
            shadowing: scene.shadowing(),
        })
    }

    fn slopes(&self) -> &Facets {
        // Facets of every slope: as steep as makes no difference.
        self.slopes.get_or_init(|| Facets::of_slopes(self.width.min(1e3)))
    }

    /// The facets of the lobe itself.
    fn facets(&self) -> &Facets {
        match self.angles {
            Some(FacetParameters { sigma_alpha, scale, .. }) => {
                self.facets.get_or_init(|| Facets::of_angles(sigma_alpha, scale))
            }
            None => self.slopes(),
        }
    }

    /// c·a_f over the value with which the facets' projections add up to the mean plane.
    fn strength(&self) -> f64 {
        self.angles.map_or(1.0, |angles| angles.scale / angles.tiling_scale)
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
        let leaving = self.slopes().albedo(source, |facet| self.seen(facet, incident, true));
        (1.0 - leaving).max(0.0)
    }

    /// Smith's G of a facet from Λ_i: 1/(1 + Λ_i + Λ_r), or 1/((1 + Λ_i)(1 + Λ_r)) if not correlated.
    fn seen(&self, facet: &Facet, incident: f64, correlated: bool) -> f64 {
        let view = SinCos { sin: (1.0 - facet.cos_r * facet.cos_r).max(0.0).sqrt(), cos: facet.cos_r };
        let from_there = smith_visible_roughly(view, self.width);
        if correlated { 1.0 / (incident + 1.0 / from_there) } else { from_there / (1.0 + incident) }
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
    pub(super) fn new(energy: &SourceEnergy<'_>, [from, to]: [f64; 2]) -> Self {
        let count = if from == to { 1 } else { NODES };
        let step = if count == 1 { 0.0 } else { (to - from) / (count - 1) as f64 };
        Self { from, to, nodes: (0..count).map(|node| energy.at(from + step * node as f64)).collect() }
    }

    /// Both, at a zenith between the ends of several nodes.
    fn at(&self, theta_i: f64) -> (f64, f64) {
        let last = self.nodes.len() - 1;
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
        let count = directions.count();
        if let &[(albedo, share)] = &self.nodes[..] {
            if share > AGAIN_FROM {
                again = Concern::of_all(count, share);
            }
            if albedo > 1.0 + COARSE {
                more = Concern::of_all(count, albedo);
            }
        } else if self.nodes.iter().any(|&(albedo, share)| albedo > 1.0 + COARSE || share > AGAIN_FROM) {
            for index in 0..count {
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

#[cfg(test)]
mod tests {
    use super::FresnelTable;
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
    use crate::reflectance::quantity::{IndexK, IndexN, Quantity};

    #[test]
    fn the_table_of_reflectances_is_as_good_as_it_says() {
        let mut worst: f64 = 0.0;
        for (n, k) in [(1.3, 0.0), (1.5, 0.0), (3.0, 0.0), (0.96, 6.7), (0.13, 4.0), (2.9, 3.1)] {
            let medium =
                Medium::Index(RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() });
            let mix = Polarization::unpolarized();
            let table = FresnelTable::new(medium, mix);
            for step in 0..=900 {
                let local = SinCos::of_degrees(0.1 * f64::from(step));
                worst = worst.max((table.at(local.cos) - medium.reflectance(local, mix).value).abs());
            }
        }
        assert!(worst < 0.02 && worst > 0.002, "{worst}");
    }
}
