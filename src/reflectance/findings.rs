//! What an answer says besides its numbers: components left out, warnings, and why a value is not
//! a number.

use super::scene::Component;

/// A component that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Omitted {
    /// Which.
    pub component: Component,
    /// Bound of its share of the total; none where none can be stated.
    pub bound: Option<f64>,
    /// Why.
    pub reason: &'static str,
}

/// Something the caller should know of the answer as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// What it is about; stable.
    pub code: WarningCode,
    /// The number behind it.
    pub value: Option<f64>,
    /// The parameter that it is about.
    pub parameter: Option<&'static str>,
    /// The first directions it concerns, at most [`LISTED_INDICES`].
    pub indices: Vec<usize>,
    /// How many directions it concerns.
    pub count: usize,
}

impl Warning {
    /// About the scene rather than some of its directions.
    pub(super) const fn of_scene(
        code: WarningCode,
        value: Option<f64>,
        parameter: Option<&'static str>,
    ) -> Self {
        Self { code, value, parameter, indices: Vec::new(), count: 0 }
    }
}

/// Indices listed by one warning.
pub const LISTED_INDICES: usize = 20;

/// Directions that a warning is about, and the largest value seen.
#[derive(Debug, Default)]
pub(super) struct Concern {
    indices: Vec<usize>,
    count: usize,
    pub(super) largest: f64,
}

impl Concern {
    /// About every one of so many directions.
    pub(super) fn of_all(count: usize, value: f64) -> Self {
        Self { indices: (0..count.min(LISTED_INDICES)).collect(), count, largest: value }
    }

    pub(super) fn add(&mut self, index: usize, value: f64) {
        if self.indices.len() < LISTED_INDICES {
            self.indices.push(index);
        }
        self.count += 1;
        self.largest = self.largest.max(value);
    }

    /// Counts `before` directions before its own.
    pub(super) fn shift(&mut self, before: usize) {
        self.indices.iter_mut().for_each(|index| *index += before);
    }

    /// Those of the directions that follow.
    pub(super) fn append(&mut self, next: &Self) {
        let room = LISTED_INDICES - self.indices.len();
        self.indices.extend(next.indices.iter().take(room));
        self.count += next.count;
        self.largest = self.largest.max(next.largest);
    }

    pub(super) fn warning(self, code: WarningCode, value: Option<f64>) -> Option<Warning> {
        (self.count > 0).then_some(Warning {
            code,
            value,
            parameter: None,
            indices: self.indices,
            count: self.count,
        })
    }
}

/// The warnings there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WarningCode {
    /// The bound of some directions is above the tolerance asked for.
    ToleranceNotMet,
    /// Some totals are below the smallest f64.
    Underflow,
    /// The spike was left out for want of a sensor though it carries energy.
    SpikeWithoutSensor,
    /// A parameter was given that the model does not use.
    ParameterNotUsed,
    /// The surface is not locally flat, section 4.1.3.
    KirchhoffCurvature,
    /// Facets on a surface whose heights are below geometrical optics, section 4.2.3.
    HeightBelowGeometricalOptics,
    /// The patch holds few correlation lengths.
    PatchNotLarge,
    /// Facets hide each other and the model in force does not say so.
    ShadowingSignificant,
    /// Light meets the surface more than once.
    MultipleScatteringSignificant,
    /// The components reflect more than arrives.
    EnergyAboveOne,
    /// The components reflect less than arrives, and nothing absorbs it.
    EnergyLost,
    /// (79) on steep slopes.
    SmallSlopesViolated,
    /// A named method far from where it serves.
    MethodOutOfRange,
}

impl WarningCode {
    /// Every code, in the order in which answers list them.
    pub const ALL: [Self; 13] = [
        Self::SpikeWithoutSensor,
        Self::ParameterNotUsed,
        Self::KirchhoffCurvature,
        Self::HeightBelowGeometricalOptics,
        Self::PatchNotLarge,
        Self::SmallSlopesViolated,
        Self::ShadowingSignificant,
        Self::MultipleScatteringSignificant,
        Self::EnergyAboveOne,
        Self::EnergyLost,
        Self::MethodOutOfRange,
        Self::ToleranceNotMet,
        Self::Underflow,
    ];

    /// The code in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ToleranceNotMet => "tolerance_not_met",
            Self::Underflow => "underflow",
            Self::SpikeWithoutSensor => "spike_without_sensor",
            Self::ParameterNotUsed => "parameter_not_used",
            Self::KirchhoffCurvature => "kirchhoff_curvature",
            Self::HeightBelowGeometricalOptics => "height_below_geometrical_optics",
            Self::PatchNotLarge => "patch_not_large",
            Self::ShadowingSignificant => "shadowing_significant",
            Self::MultipleScatteringSignificant => "multiple_scattering_significant",
            Self::EnergyAboveOne => "energy_above_one",
            Self::EnergyLost => "energy_lost",
            Self::SmallSlopesViolated => "small_slopes_violated",
            Self::MethodOutOfRange => "method_out_of_range",
        }
    }

    /// Whether it is known only once the values are.
    pub(super) const fn depends_on_values(self) -> bool {
        matches!(self, Self::MethodOutOfRange | Self::ToleranceNotMet | Self::Underflow)
    }

    /// What it means.
    pub const fn detail(self) -> &'static str {
        match self {
            Self::ToleranceNotMet => {
                "the error bound of these directions is above relative_tolerance: the input's conditioning or \
                 the method asked for allows no better; value is the largest bound"
            }
            Self::Underflow => {
                "the totals of these directions are below the smallest f64 and are answered as 0 or a \
                 subnormal number; output.log10 gives their true size"
            }
            Self::SpikeWithoutSensor => {
                "the specular spike depends on the sensor and none was given: total is without it; value is \
                 the largest share e^-g of the reflected energy that the spike can carry in these directions"
            }
            Self::ParameterNotUsed => {
                "this parameter was given and has no effect on the components evaluated"
            }
            Self::KirchhoffCurvature => {
                "the surface is not locally flat (section 4.1.3): with its radius of curvature r, 4π r cos θ′ is \
                 below ten wavelengths in these directions; value is 4π r over the wavelength"
            }
            Self::HeightBelowGeometricalOptics => {
                "a facet lobe on a surface whose heights are below the range of geometrical optics (section \
                 4.2.3): value is σ_h over the wavelength, which should be 1.5 or more"
            }
            Self::PatchNotLarge => {
                "the model wants A ≫ T², and in these directions the sensor sees fewer than 100 squares of the \
                 correlation length: one patch can differ from the mean; value is the least A/T²"
            }
            Self::ShadowingSignificant => {
                "facets hide each other and shadowing is none: 1 − G of a Gaussian surface (Smith) is above 0.1 in \
                 these directions; value is 1 − G at their largest zeniths"
            }
            Self::MultipleScatteringSignificant => {
                "the models reflect light once, and more than a tenth of what is reflected from these sources meets \
                 the surface again; value is the largest such share, good to 0.05 (sources beyond 85° are judged at 85°)"
            }
            Self::EnergyAboveOne => {
                "the components reflect more light from these sources than arrives: value is the largest directional \
                 albedo, null if infinite. But for /v1/albedo, which integrates it, it comes from a coarse quadrature over \
                 the facets that is good to 0.05 of it (sources beyond 85° are judged at 85°)"
            }
            Self::EnergyLost => {
                "a perfect conductor reflects all, and lobe and spike together reflect less from these sources: light that \
                 meets the surface again, or that the model sends below the horizon, is lost; value is the least excess"
            }
            Self::SmallSlopesViolated => {
                "facet_slope_deg follows from σ_h/T by (79), which holds for gentle slopes: above 0.1 the two models' \
                 lobes differ by more than 3 % of their peak; value is σ_h/T"
            }
            Self::MethodOutOfRange => {
                "the method asked for does not serve in these directions: the bound of its error is above 1, or null \
                 where it is not finite; value is the largest"
            }
        }
    }
}

/// Why something in a direction's answer is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The direction.
    pub index: usize,
    /// What happened.
    pub code: DiagnosticCode,
}

/// The diagnostics there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiagnosticCode {
    /// A cosine in the denominator is exactly 0.
    GrazingDivergence,
    /// The limit depends on the path taken to it.
    UndefinedLimit,
    /// Finite, but above the largest f64.
    Overflow,
    /// The error has no finite relative bound.
    NoErrorBound,
    /// The logarithm of an exact zero.
    LogarithmOfZero,
    /// The logarithm of a value of which rounding left nothing.
    LostToRounding,
    /// g of a scene without heights or wavelength.
    NoRoughness,
}

impl DiagnosticCode {
    /// The code in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::GrazingDivergence => "grazing_divergence",
            Self::UndefinedLimit => "undefined_limit",
            Self::Overflow => "overflow",
            Self::NoErrorBound => "no_error_bound",
            Self::LogarithmOfZero => "logarithm_of_zero",
            Self::LostToRounding => "lost_to_rounding",
            Self::NoRoughness => "no_roughness",
        }
    }

    /// What it means.
    pub const fn detail(self) -> &'static str {
        match self {
            Self::GrazingDivergence => "a cosine in the denominator is exactly 0: the model diverges here",
            Self::UndefinedLimit => "the model has no value here: its limit depends on the path",
            Self::Overflow => "above the largest f64; output.log10 gives the true size",
            Self::NoErrorBound => "the relative error has no finite bound",
            Self::LogarithmOfZero => "the value is exactly 0 and has no logarithm",
            Self::LostToRounding => {
                "rounding left nothing of a value that is close to 0; it has no logarithm"
            }
            Self::NoRoughness => "roughness_g needs rms_height_um and wavelength_um",
        }
    }
}
