//! Which scenes are evaluated in vector lanes as a whole, and what their directions have in common.

use super::{Component, Kernel, Quantity};
use crate::reflectance::lambertian;
use crate::reflectance::scene::Model;
use crate::reflectance::shadowing::lanes::Cosines;
use crate::reflectance::{beckmann_spizzichino, torrance_sparrow};

/// A scene whose answer is made in lanes.
#[derive(Clone, Copy)]
pub(in crate::reflectance) enum InLanes<'a> {
    /// The lobe of (47) alone.
    HeightLobe(beckmann_spizzichino::lanes::Common<'a>),
    /// Diffuse lobe, facet lobe or both.
    Facets(torrance_sparrow::lanes::Common<'a>),
}

impl<'a> Kernel<'a> {
    /// How the whole answer is made in lanes, if it is.
    pub(in crate::reflectance) fn in_lanes(&self) -> Option<InLanes<'a>> {
        let (irradiance, cosines) = match self.quantity {
            Quantity::Radiance => (self.irradiance, Cosines::OfView),
            Quantity::Brdf => (1.0, Cosines::OfBoth),
            Quantity::ImageIrradiance { .. } => return None,
        };
        if self.has_spike() {
            return None;
        }
        if self.scene.parameters().model == Model::BeckmannSpizzichino {
            let (roughness, _) = self.series()?;
            return Some(InLanes::HeightLobe(beckmann_spizzichino::lanes::Common {
                roughness,
                reflectivity: self.reflectivity,
                strength: irradiance,
                shadowing: self.shadowing,
                cosines,
            }));
        }
        let evaluates = |component| self.scene.evaluated().contains(&component);
        let diffuse = if evaluates(Component::DiffuseLobe) {
            (lambertian::kappa_diff(self.scene.parameters().surface.diffuse_albedo) * irradiance).to_f64()
        } else {
            0.0
        };
        let facets =
            if evaluates(Component::SpecularLobe) { Some(self.facets_in_lanes(irradiance)?) } else { None };
        // Without either the answer is an exact 0, which is not what lanes take for one.
        let is_ordinary = is_far_from_the_ends(diffuse) || diffuse == 0.0 && facets.is_some();
        is_ordinary.then_some(InLanes::Facets(torrance_sparrow::lanes::Common { diffuse, facets, cosines }))
    }

    fn facets_in_lanes(&self, irradiance: f64) -> Option<torrance_sparrow::lanes::Facets<'a>> {
        let facets = self.facets?;
        let strength = 0.25 * facets.specular_scale * irradiance;
        let height = if self.shares_with_spike() { Some(self.roughness?.height) } else { None };
        is_far_from_the_ends(strength).then_some(torrance_sparrow::lanes::Facets {
            sigma_alpha: facets.sigma_alpha,
            strength,
            reflectivity: self.reflectivity,
            shadowing: self.shadowing,
            height,
        })
    }
}

/// A cosine more or less does not bring it out of the range of normal numbers.
fn is_far_from_the_ends(value: f64) -> bool {
    (1e-290..1e290).contains(&value)
}
