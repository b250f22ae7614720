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
#[derive(Default)]
pub(super) struct Concern {
    indices: Vec<usize>,
    count: usize,
    pub(super) largest: f64,
}

impl Concern {
    pub(super) fn add(&mut self, index: usize, value: f64) {
        if self.indices.len() < LISTED_INDICES {
            self.indices.push(index);
        }
        self.count += 1;
        self.largest = self.largest.max(value);
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
}

impl WarningCode {
    /// The code in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ToleranceNotMet => "tolerance_not_met",
            Self::Underflow => "underflow",
            Self::SpikeWithoutSensor => "spike_without_sensor",
            Self::ParameterNotUsed => "parameter_not_used",
        }
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
                 the largest share e^-g of the reflected energy that the spike carries"
            }
            Self::ParameterNotUsed => {
                "this parameter was given and has no effect on the components evaluated"
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
