//! The Beckmann-Spizzichino physical-optics model, (28)-(39) and (47)-(49): specular spike and
//! specular lobe of a surface of Gaussian heights.
//!
//! Radiances are per unit irradiance of the beam, ½ √(ε/μ) E₀² of (15) (errata E4), so that the
//! report's wave impedance and field amplitude never enter. The lobe carries D², the spike is
//! (47) as printed, without it (errata E15).

pub(super) mod lanes;

use super::estimate::Estimate;
use super::geometry::Geometry;
use super::numeric::EPSILON;
use super::numeric::lobe_series::{self, LobeSeries, Method};
use super::numeric::scaled::Scaled;
use super::numeric::sinc::sinc;
use core::f64::consts::PI;

/// The surface's two lengths over the wavelength; all that the model depends on besides angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeRoughness {
    /// σ_h/λ: standard deviation of the Gaussian height density (4); 0 is a perfect mirror.
    pub height: f64,
    /// T/λ: distance at which the autocorrelation (5) falls to 1/e.
    pub correlation_length: f64,
}

/// Rounding of the prefactors and of g and x, in ε: what (34), (36) and (47) cost when evaluated
/// as below, every operation at its worst.
const PREFACTOR_UNITS: f64 = 64.0;
const G_UNITS: f64 = 16.0;
const X_UNITS: f64 = 24.0;
const ALONG_UNITS: f64 = 12.0;

impl RelativeRoughness {
    /// g of (34), the roughness the light sees between these directions.
    pub fn g(&self, geometry: &Geometry) -> f64 {
        self.g_of(geometry.cos_sum)
    }

    #[inline(always)]
    fn g_of(&self, cos_sum: f64) -> f64 {
        let root = 2.0 * PI * self.height * cos_sum;
        root * root
    }

    /// x = v_xy² T²/4, the exponent of (33) times m.
    pub fn x(&self, geometry: &Geometry) -> f64 {
        self.x_of(geometry.horizontal)
    }

    #[inline(always)]
    fn x_of(&self, horizontal: f64) -> f64 {
        let root = PI * self.correlation_length * horizontal;
        root * root
    }

    /// tan α of about the width of the lobe of (47): the facets' slope, or what a patch of the size T diffracts.
    pub(super) fn facet_width(&self, cos_i: f64) -> f64 {
        let slope = 2.0 * self.height / self.correlation_length;
        let wave = 2.0 * PI * self.correlation_length;
        // v_xy T = 2 with v_xy = 2k cos θ′ sin α, and cos θ′ ≥ sin α near a grazing source.
        let diffraction = (1.0 / (wave * cos_i)).min(1.0 / wave.sqrt());
        slope.max(diffraction)
    }

    /// The specular lobe of (47) over the irradiance, per steradian, and the method that made S.
    ///
    /// `over_cosines` takes the place of 1/cos θ_r: G/cos θ_r for a shadowed radiance, and divided by
    /// cos θ_i for a BRDF. Infinite where it is.
    pub fn lobe(&self, geometry: &Geometry, over_cosines: f64, method: Method) -> (Estimate, Method) {
        let (g, x) = (self.g(geometry), self.x(geometry));
        let series = lobe_series::evaluate(method, g, x);
        if geometry.cos_sum == 0.0 && method != Method::Rough {
            return (self.grazing_lobe(geometry, over_cosines, x), series.method);
        }
        (self.lobe_of(geometry, over_cosines, &series), series.method)
    }

    /// (47)'s second term from a value of S: π/4 · (T/λ)² · (q (1 + tan² α))² · S/cos θ_r. A quarter
    /// of the last square is cos² θ_i D².
    pub(super) fn lobe_of(&self, geometry: &Geometry, over_cosines: f64, series: &LobeSeries) -> Estimate {
        let length = Scaled::new(geometry.length());
        let facet_factor = length.squared() / Scaled::new(geometry.cos_sum);
        let patch = Scaled::new(self.correlation_length) * facet_factor;
        let factor = patch.squared() * (0.25 * PI) * over_cosines;
        let value = factor * series.estimate.value;
        if !value.is_finite() {
            return finite_or_limit(value, 0.0);
        }
        let rounding = PREFACTOR_UNITS + G_UNITS * series.condition_g + X_UNITS * series.condition_x;
        series.estimate.scaled_by(factor).widened(EPSILON * rounding)
    }

    /// The limit of the lobe where both directions are grazing: q → 0 and S → g e^{-x}, so that S/q²
    /// tends to (2π σ_h/λ)² e^{-x} and only `over_cosines` decides.
    fn grazing_lobe(&self, geometry: &Geometry, over_cosines: f64, x: f64) -> Estimate {
        let patch = Scaled::new(self.correlation_length) * Scaled::new(geometry.length()).squared();
        let phase = Scaled::new(2.0 * PI * self.height);
        let value = (patch * phase).squared() * (0.25 * PI) * Scaled::exp(-x) * over_cosines;
        finite_or_limit(value, EPSILON * (PREFACTOR_UNITS + X_UNITS * x))
    }

    /// The specular spike of (47) over the irradiance, per steradian; `cosines` is the cos² θ_i of
    /// (47), or cos θ_i for its BRDF.
    pub fn spike(&self, geometry: &Geometry, cosines: f64, patch: &Patch) -> Estimate {
        if geometry.cos_r == 0.0 {
            return if cosines == 0.0 { Estimate::UNDEFINED } else { Estimate::INFINITE };
        }
        let cos_r = Scaled::new(geometry.cos_r);
        let strength = Scaled::new(cosines) * patch.footprint / cos_r / cos_r;
        self.coherent(geometry, patch).scaled_by(strength).widened(EPSILON * PREFACTOR_UNITS)
    }

    /// e^{-g} ρ_o²: the share of a smooth plate's specular power that stays coherent.
    pub(super) fn coherent(&self, geometry: &Geometry, patch: &Patch) -> Estimate {
        let g = self.g(geometry);
        let share = Estimate::within(Scaled::exp(-g), EPSILON * (4.0 + G_UNITS * g));
        share.times(patch.rho_squared(geometry))
    }
}

/// A value known within a factor e^{±`log_error`}, or why there is none.
fn finite_or_limit(value: Scaled, log_error: f64) -> Estimate {
    if value.is_nan() {
        Estimate::UNDEFINED
    } else if value.is_finite() {
        Estimate::within(value, log_error)
    } else {
        Estimate::INFINITE
    }
}

/// The patch that the sensor sees, its lengths over the wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// (z/f)² dA_im cos γ/λ² of (43).
    pub footprint: Scaled,
    /// X/λ of (35).
    pub half_x: f64,
    /// Y/λ of (35).
    pub half_y: f64,
}

impl Patch {
    /// ρ_o of (35), sinc(v_x X) sinc(v_y Y) with sinc a = sin(a)/a (errata E16).
    pub fn rho(&self, geometry: &Geometry) -> f64 {
        sinc(2.0 * PI * self.half_x * geometry.along()) * sinc(2.0 * PI * self.half_y * geometry.across())
    }

    /// ρ_o² with what the rounding of the two phases does to it.
    pub(super) fn rho_squared(&self, geometry: &Geometry) -> Estimate {
        let (front, back) = geometry.along_parts();
        let along = Phase::new(self.half_x, front + back, front.abs() + back.abs());
        let across = Phase::new(self.half_y, geometry.across(), geometry.across().abs());
        let rho = along.sinc * across.sinc;
        let error =
            along.error * across.sinc.abs() + across.error * along.sinc.abs() + along.error * across.error;
        // Far from the specular direction ρ is small and its square may leave f64's range.
        let (rho, error) = (Scaled::new(rho.abs()), Scaled::new(error));
        let least = if error.to_f64() < rho.to_f64() { rho.distance(error).squared() } else { Scaled::ZERO };
        Estimate { value: rho.squared(), error: rho * error * 2.0 + error.squared(), least }
    }
}

/// sinc of one phase and a bound of its absolute error.
struct Phase {
    sinc: f64,
    error: f64,
}

impl Phase {
    /// Phase 2π·`half`·`component`, the component of v/k being the rounded sum of terms of
    /// magnitude `terms`.
    fn new(half: f64, component: f64, terms: f64) -> Self {
        let a = 2.0 * PI * half * component;
        let uncertainty = ALONG_UNITS * EPSILON * 2.0 * PI * half * terms;
        let sinc = sinc(a);
        let size = a.abs();
        // |sinc′| = |cos a − sinc a|/|a|; |sinc″| ≤ 1/3 and ≤ 2/|a| beyond 1.
        let slope = if size < 1e-3 { size / 3.0 } else { (libm::cos(a) - sinc).abs() / size };
        let curvature = if size < 6.0 { 1.0 / 3.0 } else { 2.0 / (size - uncertainty).max(6.0) };
        let taylor = slope * uncertainty + 0.5 * curvature * uncertainty * uncertainty;
        // |sinc| never exceeds 1/|a|, nor 1: past one radian of uncertainty that says more.
        let most = if size > uncertainty { (1.0 / (size - uncertainty)).min(1.0) } else { 1.0 };
        let error = taylor.min(sinc.abs() + most) + 4.0 * EPSILON * sinc.abs();
        Self { sinc, error }
    }
}
