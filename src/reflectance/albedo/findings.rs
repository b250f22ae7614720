//! What the caller should know of an albedo: where energy is not kept, and which assumptions are strained.

use super::{Albedo, AlbedoScene};
use crate::reflectance::directions::{Angles, Directions};
use crate::reflectance::findings::{Concern, Diagnostic, DiagnosticCode, Warning, WarningCode};
use crate::reflectance::fresnel::Medium;
use crate::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};
use crate::reflectance::scene::Component;
use crate::reflectance::strain;

/// Energy above 1 is told from here on.
const MORE_FROM: f64 = 0.01;
/// Energy that a perfect conductor loses is told from here on.
const LOST_FROM: f64 = 0.1;

impl AlbedoScene {
    /// What to know of the albedos of these incidences, each by its index. Assumptions are judged in the mirror directions.
    pub fn warnings(&self, incidences: &[SourceZenith], albedos: &[Albedo]) -> Vec<Warning> {
        let (mut more, mut lost, mut coarse) = (Concern::default(), Concern::default(), Concern::default());
        let tolerance = self.0.parameters().accuracy.relative_tolerance.get();
        for (index, albedo) in albedos.iter().enumerate() {
            // An infinite albedo is above 1 as well.
            let total = albedo.total.value.to_f64();
            let error = albedo.total.error.to_f64();
            if total.is_infinite() || total - error > 1.0 + MORE_FROM {
                more.add(index, total);
            }
            if let Some(excess) = self.excess(albedo)
                && excess < -LOST_FROM
                && self.0.parameters().surface.medium == Medium::PerfectConductor
            {
                lost.add(index, -excess);
            }
            let bound = albedo.total.relative_error();
            if total.is_finite() && bound > tolerance {
                coarse.add(index, bound);
            }
        }
        let finite = |value: f64| value.is_finite().then_some(value);
        let (most, least, bound) = (finite(more.largest), -lost.largest, finite(coarse.largest));
        let mut warnings: Vec<_> = self.strains(incidences);
        warnings.extend(more.warning(WarningCode::EnergyAboveOne, most));
        warnings.extend(lost.warning(WarningCode::EnergyLost, Some(least)));
        warnings.extend(coarse.warning(WarningCode::ToleranceNotMet, bound));
        warnings.sort_by_key(|warning| WarningCode::ALL.iter().position(|&code| code == warning.code));
        warnings
    }

    /// The assumptions that are strained. What the models' energy is like is known better here.
    fn strains(&self, incidences: &[SourceZenith]) -> Vec<Warning> {
        let mirrored =
            incidences.iter().filter_map(|theta_i| ViewerZenith::new(theta_i.get()).ok()).collect();
        let directions = Azimuth::new(0.0).ok().and_then(|ahead| {
            let (source, viewer) = (Angles::Each(incidences.to_vec()), Angles::Each(mirrored));
            Directions::new(source, viewer, Angles::One(ahead)).ok()
        });
        directions.map_or_else(Vec::new, |directions| {
            let extents = directions.extents(0..directions.count());
            let mut warnings = strain::warnings(&self.0, &self.0, &directions, &extents, &[]);
            warnings.retain(|warning| warning.code != WarningCode::EnergyAboveOne);
            warnings
        })
    }

    /// Why values are not numbers.
    pub fn diagnostics(albedos: &[Albedo]) -> Vec<Diagnostic> {
        let infinite = |(index, albedo): (usize, &Albedo)| {
            let value = albedo.total.value;
            let code = if value.is_finite() {
                DiagnosticCode::NoErrorBound
            } else {
                DiagnosticCode::GrazingDivergence
            };
            let is_finite = value.is_finite() && albedo.total.relative_error().is_finite();
            (!is_finite).then_some(Diagnostic { index, code })
        };
        albedos.iter().enumerate().filter_map(infinite).collect()
    }

    /// Whether there is an [`Self::excess`]: the model has specular components, and all are evaluated.
    pub fn has_excess(&self) -> bool {
        let components = self.0.parameters().model.components();
        let mut specular =
            components.iter().filter(|&&component| component != Component::DiffuseLobe).peekable();
        specular.peek().is_some() && specular.all(|component| self.0.evaluated().contains(component))
    }

    /// Whether 1 − e^{−g} is known.
    pub fn has_heights(&self) -> bool {
        self.0.relative_roughness().is_some()
    }

    /// Whether spike and lobe are both evaluated.
    pub fn has_shares(&self) -> bool {
        let both = [Component::SpecularSpike, Component::SpecularLobe];
        both.iter().all(|component| self.0.evaluated().contains(component))
    }

    /// Lobe and spike together less what a smooth plate reflects, F′ of (63) at θ_i; none where one of the model's is
    /// not evaluated, or the model has none.
    pub fn excess(&self, albedo: &Albedo) -> Option<f64> {
        let mut specular = self
            .0
            .parameters()
            .model
            .components()
            .iter()
            .filter(|&&c| c != Component::DiffuseLobe)
            .peekable();
        specular.peek()?;
        let reflected = specular
            .map(|component| albedo.components[component.index()].map(|part| part.value.to_f64()))
            .sum::<Option<f64>>()?;
        Some(reflected - albedo.fresnel)
    }

    /// The shares of spike and lobe in both together, where both are evaluated and they reflect something.
    pub fn shares_of(albedo: &Albedo) -> Option<[f64; 2]> {
        let of = |component: Component| albedo.components[component.index()].map(|part| part.value.to_f64());
        let (spike, lobe) = (of(Component::SpecularSpike)?, of(Component::SpecularLobe)?);
        let both = spike + lobe;
        (both > 0.0 && both.is_finite()).then(|| [spike / both, lobe / both])
    }
}
