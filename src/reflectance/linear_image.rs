//! (74) and (80) in many directions: from strengths and angles to columns of answers.

use super::beckmann_spizzichino::Patch;
use super::columns::{Columns, ComponentColumn};
use super::degrees::{self, SinCos};
use super::directions::Directions;
use super::estimate::Estimate;
use super::findings::Diagnostic;
use super::image_irradiance::{LinearModel, Offset, Spike, Strengths};
use super::numeric::scaled::Scaled;
use super::quantity::{FacetSlope, Length, SourceZenith, SpikeWidth, Strength, ViewerZenith, Wavelength};
use super::scene::Component;
use core::ops::Range;

/// Which of the two models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearKind {
    /// (74): the view moves.
    FixedSource,
    /// (80): the source moves.
    FixedView,
}

impl LinearKind {
    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FixedSource => "fixed_source",
            Self::FixedView => "fixed_view",
        }
    }
}

/// What of ρ_o² a Gaussian keeps (errata E44).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Match {
    /// The curvature at the peak.
    Curvature,
    /// The integral over θ_r.
    Energy,
}

impl Match {
    /// The name in requests.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Curvature => "curvature",
            Self::Energy => "energy",
        }
    }
}

/// The spike's shape, section 5.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpikeShape {
    /// δ(θ_i − θ_r) δ(φ_r).
    Delta,
    /// ρ_o² of (35).
    Sinc2 {
        /// X
        half_x: Length,
        /// Y
        half_y: Length,
        /// λ
        wavelength: Wavelength,
    },
    /// A Gaussian of this width.
    Gaussian(SpikeWidth),
    /// A Gaussian that matches ρ_o² at the fixed angle.
    GaussianOfPatch {
        /// X
        half_x: Length,
        /// λ
        wavelength: Wavelength,
        /// What it keeps.
        matching: Match,
    },
}

/// One of the linear models with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearScene {
    /// (74) or (80).
    pub kind: LinearKind,
    /// C_dl or K_dl.
    pub diffuse_lobe: Strength,
    /// C_sl or K_sl.
    pub specular_lobe: Strength,
    /// C_ss or K_ss.
    pub specular_spike: Strength,
    /// σ_α
    pub facet_slope: FacetSlope,
    /// The spike's shape.
    pub spike: SpikeShape,
}

/// Directions between two looks at whether to go on: some tens of microseconds.
const BETWEEN_LOOKS: usize = 64;

/// Image irradiance in N directions.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearEvaluation {
    /// The sum of the three terms; without the spike if it is a delta.
    pub total: Vec<f64>,
    /// Decimal logarithms, if asked for.
    pub log10_total: Option<Vec<f64>>,
    /// The three terms.
    pub components: Vec<ComponentColumn>,
    /// Bound of the relative error of the total.
    pub relative_error_bound: Vec<f64>,
    /// Whether the viewer meets the spike exactly.
    pub delta_on: Vec<bool>,
    /// Why values are not numbers.
    pub diagnostics: Vec<Diagnostic>,
}

impl LinearScene {
    /// Evaluates the model in a range of the directions; `is_over` is asked now and then whether to stop, and what is missing
    /// then is missing at the end.
    pub fn evaluate(
        &self,
        directions: &Directions,
        range: Range<usize>,
        log10: bool,
        is_over: impl Fn() -> bool,
    ) -> LinearEvaluation {
        let mut columns = Columns::new(&Component::ALL, range.len(), log10);
        let mut delta_on = Vec::with_capacity(range.len());
        for index in range {
            if index % BETWEEN_LOOKS == 0 && is_over() {
                break;
            }
            let (theta_i, theta_r, phi_r) = directions.angles(index);
            let model = LinearModel {
                strengths: Strengths {
                    diffuse_lobe: self.diffuse_lobe.get(),
                    specular_lobe: self.specular_lobe.get(),
                    specular_spike: self.specular_spike.get(),
                },
                sigma_alpha: degrees::to_radians(self.facet_slope.get()),
                spike: self.spike(theta_i, theta_r),
            };
            let (geometry, offset) = (directions.geometry(index), Offset::new(theta_i, theta_r, phi_r));
            let image = match self.kind {
                LinearKind::FixedSource => model.fixed_source(&geometry, offset),
                LinearKind::FixedView => model.fixed_view(&geometry, offset),
            };
            let terms = [image.diffuse_lobe, image.specular_lobe, image.specular_spike].map(Some);
            columns.push(index, &terms, Estimate::total(&terms));
            delta_on.push(image.delta_on);
        }
        let Columns { total, log10_total, components, relative_error_bound, diagnostics, .. } = columns;
        LinearEvaluation { total, log10_total, components, relative_error_bound, delta_on, diagnostics }
    }

    fn spike(&self, theta_i: SourceZenith, theta_r: ViewerZenith) -> Spike {
        match self.spike {
            SpikeShape::Delta => Spike::Delta,
            SpikeShape::Sinc2 { half_x, half_y, wavelength } => Spike::Sinc2(Patch {
                // ρ_o does not depend on the footprint.
                footprint: Scaled::ONE,
                half_x: half_x.get() / wavelength.get(),
                half_y: half_y.get() / wavelength.get(),
            }),
            SpikeShape::Gaussian(width) => Spike::Gaussian { width: degrees::to_radians(width.get()) },
            SpikeShape::GaussianOfPatch { half_x, wavelength, matching } => {
                let fixed = match self.kind {
                    LinearKind::FixedSource => theta_i.get(),
                    LinearKind::FixedView => theta_r.get(),
                };
                let (half_x, cos) = (half_x.get() / wavelength.get(), SinCos::of_degrees(fixed).cos);
                Spike::Gaussian {
                    width: match matching {
                        Match::Curvature => Spike::width_by_curvature(half_x, cos),
                        Match::Energy => Spike::width_by_energy(half_x, cos),
                    },
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LinearKind, LinearScene, Match, SpikeShape};
    use crate::reflectance::directions::{Angles, Directions};
    use crate::reflectance::quantity::{
        Azimuth, FacetSlope, Length, Quantity, SourceZenith, Strength, ViewerZenith, Wavelength,
    };

    fn scene(spike: SpikeShape) -> LinearScene {
        LinearScene {
            kind: LinearKind::FixedSource,
            diffuse_lobe: Strength::new(2.0).unwrap(),
            specular_lobe: Strength::new(3.0).unwrap(),
            specular_spike: Strength::new(5.0).unwrap(),
            facet_slope: FacetSlope::new(10.0).unwrap(),
            spike,
        }
    }

    fn mirror_and_grazing() -> Directions {
        Directions::new(
            Angles::One(SourceZenith::new(60.0).unwrap()),
            Angles::Each([60.0, 90.0].map(|angle| ViewerZenith::new(angle).unwrap()).to_vec()),
            Angles::One(Azimuth::new(0.0).unwrap()),
        )
        .unwrap()
    }

    #[test]
    fn columns_hold_the_three_terms_and_say_where_the_spike_is() {
        let patch = SpikeShape::GaussianOfPatch {
            half_x: Length::new(100.0).unwrap(),
            wavelength: Wavelength::new(0.5).unwrap(),
            matching: Match::Curvature,
        };
        let answer = scene(patch).evaluate(&mirror_and_grazing(), 0..2, true, || false);
        // 2 + 3/cos 60° + 5 in the mirror direction, to the bound that comes with it.
        assert!((answer.total[0] - 13.0).abs() <= 13.0 * answer.relative_error_bound[0]);
        assert_eq!(answer.delta_on, [true, false]);
        assert!(answer.total[1].is_infinite());
        assert_eq!(answer.diagnostics[0].index, 1);
        assert_eq!(answer.diagnostics[0].code.name(), "grazing_divergence");
        let delta = scene(SpikeShape::Delta).evaluate(&mirror_and_grazing(), 0..2, false, || false);
        assert!((delta.total[0] - 8.0).abs() <= 8.0 * delta.relative_error_bound[0]);
        assert_eq!(delta.components[2].values, [0.0, 0.0]);
    }
}
