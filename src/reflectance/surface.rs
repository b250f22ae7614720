//! The surface as a random process: densities of height and slope (4)-(6), (73), the Rayleigh criterion (7)-(9), how
//! rough the light finds it, and Kirchhoff's condition of section 4.1.3.
//!
//! Densities are [`Scaled`], so that their logarithms stay right where they underflow; the exponent q of each Gaussian e^{−q}
//! has a relative error below 12 ε. Lengths in one unit; angles in radians.

use super::numeric::scaled::Scaled;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// p_h(h) of (4), per unit of length: Gaussian with mean 0 and standard deviation σ_h.
pub fn height_density(height: f64, rms_height: f64) -> Scaled {
    normal_density(height, rms_height)
}

/// C(τ) = exp(−τ²/T²) of (5).
pub fn autocorrelation(distance: f64, correlation_length: f64) -> Scaled {
    let ratio = distance / correlation_length;
    Scaled::exp(-ratio * ratio)
}

/// p_α(α) of (6), per radian: Gaussian density of the facet slope angle with standard deviation σ_α. One-dimensional:
/// the facet density of (58) per solid angle has another scale, [`super::torrance_sparrow::normalized_scale`].
pub fn slope_angle_density(alpha: f64, sigma_alpha: f64) -> Scaled {
    normal_density(alpha, sigma_alpha)
}

fn normal_density(value: f64, deviation: f64) -> Scaled {
    let ratio = value / deviation;
    Scaled::exp(-0.5 * ratio * ratio) / (Scaled::new(TAU.sqrt()) * deviation)
}

/// p_α(α) of (73), per radian, with the exponent −(tan α/(2σ_h/T))² (errata E39): the density of the slope angle along
/// one line of a surface of Gaussian heights. `ratio` is σ_h/T above 0, |α| ≤ π/2.
pub fn profile_slope_density(alpha: f64, ratio: f64) -> Scaled {
    let (width, secant_squared, exponential) = beckmann_parts(alpha, ratio);
    exponential * secant_squared / (width * PI.sqrt())
}

/// The density of facet normals per solid angle (steradian) of the mean plane that reproduces (49):
/// exp(−tan²α/m²)/(π m² cos⁴α), m = 2σ_h/T (errata E40). Times cos α it integrates to 1 over the hemisphere.
pub fn facet_density(alpha: f64, ratio: f64) -> Scaled {
    let (width, secant_squared, exponential) = beckmann_parts(alpha, ratio);
    exponential * secant_squared.squared() / (width.squared() * PI)
}

/// m = 2σ_h/T, 1/cos²α and exp(−tan²α/m²).
fn beckmann_parts(alpha: f64, ratio: f64) -> (Scaled, Scaled, Scaled) {
    let (sin, cos) = libm::sincos(alpha);
    let width = 2.0 * ratio;
    let slope = sin / cos / width;
    (Scaled::new(width), Scaled::ONE / Scaled::new(cos).squared(), Scaled::exp(-slope * slope))
}

/// Two rays of one beam on a surface whose irregularities have the height H, figure 5. The angle β is
/// measured from the surface: sin β = cos θ_i (errata E1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayleighPair {
    /// H: a peak height, not a standard deviation.
    pub height: f64,
    /// λ
    pub wavelength: f64,
    /// sin β = cos θ_i.
    pub sin_beta: f64,
}

impl RayleighPair {
    /// Δd of (7), 2 H sin β. Relative error 2 ε.
    pub fn path_difference(&self) -> Scaled {
        Scaled::new(self.height) * self.sin_beta * 2.0
    }

    /// ΔΩ of (8), 4π H sin β/λ, radians. Relative error 4 ε.
    pub fn phase_difference(&self) -> Scaled {
        Scaled::new(self.height) * self.sin_beta / Scaled::new(self.wavelength) * (4.0 * PI)
    }

    /// The height λ/(8 sin β) of (9) above which the surface counts as rough; infinite at grazing incidence. Relative error 1 ε.
    pub fn critical_height(&self) -> Scaled {
        Scaled::new(self.wavelength) / (Scaled::new(self.sin_beta) * 8.0)
    }

    /// Rayleigh's criterion (9). Equality counts as smooth.
    pub fn is_rough(&self) -> bool {
        // Two roundings off the border, exact on it for exact products.
        (Scaled::new(self.height) * self.sin_beta * 8.0 / Scaled::new(self.wavelength)).to_f64() > 1.0
    }
}

/// What g of (34) says of a surface, section 4.1.2: g ≪ 1, g ≈ 1, g ≫ 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// The spike holds most of what it can: g ≤ π²/4.
    Smooth,
    /// Both components matter.
    Moderate,
    /// The lobe holds all but 5e-5 of the reflected energy: g ≥ 10.
    Rough,
}

impl Regime {
    /// Smooth up to this g: Rayleigh's criterion (9), a phase of π/2, for irregularities of height σ_h (errata E1);
    /// e^{−g}, the spike's share, is 0.085 there.
    pub const SMOOTH_UP_TO: f64 = FRAC_PI_2 * FRAC_PI_2;
    /// Rough from this g on: e^{−g} is below 5e-5, and the rough form (49) errs by 1/g = 10 % at the mirror direction. On a patch
    /// much larger than T² the spike's peak may still stand above the lobe up to g of 20 or so.
    pub const ROUGH_FROM: f64 = 10.0;

    /// The regime of g ≥ 0.
    pub fn of(g: f64) -> Self {
        if g <= Self::SMOOTH_UP_TO {
            Self::Smooth
        } else if g < Self::ROUGH_FROM {
            Self::Moderate
        } else {
            Self::Rough
        }
    }

    /// The name in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Moderate => "moderate",
            Self::Rough => "rough",
        }
    }
}

/// Radius of curvature over wavelength, 1/(rms curvature λ) = T²/(2√3 σ_h λ), for Kirchhoff's assumption of section 4.1.3
/// that the surface is locally flat (errata E29). Relative error below 6 ε.
///
/// The curvature along a line is −h″, whose variance under (5) is the fourth derivative of σ_h² C(τ) at 0: 12 σ_h²/T⁴.
pub fn curvature_radius_in_wavelengths(rms_height: f64, correlation_length: f64, wavelength: f64) -> f64 {
    (correlation_length / rms_height) * (correlation_length / wavelength) / 12f64.sqrt()
}

/// The σ_h/λ from which the report takes the spike for gone and the geometrical model for valid (4.1.5, 4.2.2).
/// Near grazing the spike lives on (errata, part D).
pub const GEOMETRICAL_FROM: f64 = 1.5;

/// Whether heights of this σ_h/λ are for geometrical optics.
pub fn is_geometrical(height_over_wavelength: f64) -> bool {
    height_over_wavelength >= GEOMETRICAL_FROM
}

/// Whether the radius of curvature is large enough for Kirchhoff's assumption. Brekhovskikh's condition 4π r cos θ′ ≫ λ, with ten
/// for "much greater" and normal incidence: from r = 10 λ/4π = 0.8 λ on.
pub fn is_locally_flat(radius_in_wavelengths: f64) -> bool {
    4.0 * PI * radius_in_wavelengths >= 10.0
}

#[cfg(test)]
mod tests {
    use super::{
        RayleighPair, Regime, autocorrelation, curvature_radius_in_wavelengths, facet_density,
        height_density, is_locally_flat, profile_slope_density, slope_angle_density,
    };
    use crate::reflectance::numeric::{EPSILON, quadrature::integrate};
    use core::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn densities_integrate_to_one() {
        // Beyond 9 deviations a Gaussian has 2e-19 left. Quadrature's own error is a few ε, the densities' below 40 ε on the
        // bulk of the mass, where the exponent is a few units.
        let whole = |f: &dyn Fn(f64) -> f64, end: f64| integrate(-end, end, f).value;
        let slack = 64.0 * EPSILON;
        assert!((whole(&|h| height_density(h, 0.3).to_f64(), 2.7) - 1.0).abs() < slack);
        assert!((whole(&|a| slope_angle_density(a, 0.1).to_f64(), 0.9) - 1.0).abs() < slack);
        for ratio in [0.03, 0.2, 2.0] {
            let total = whole(&|a| profile_slope_density(a, ratio).to_f64(), FRAC_PI_2);
            assert!((total - 1.0).abs() < slack, "{ratio} {total}");
            // Facets tile the mean plane: ∫ D cos α dω = 1.
            let tiled =
                integrate(0.0, FRAC_PI_2, |a| PI * facet_density(a, ratio).to_f64() * libm::sin(2.0 * a));
            assert!((tiled.value - 1.0).abs() < slack, "{ratio} {tiled:?}");
        }
    }

    #[test]
    fn correlation_falls_to_one_over_e() {
        assert!((autocorrelation(3.0, 3.0).to_f64() * 1f64.exp() - 1.0).abs() < 4.0 * EPSILON);
        assert_eq!(autocorrelation(0.0, 3.0).to_f64(), 1.0);
        assert!((autocorrelation(1e6, 1.0).ln() + 1e12).abs() < 4e12 * EPSILON);
    }

    #[test]
    fn rayleigh_at_the_border() {
        // H = λ/8 at normal incidence: phase π/2, and equality is smooth.
        let pair = RayleighPair { height: 0.0625, wavelength: 0.5, sin_beta: 1.0 };
        assert_eq!(pair.phase_difference().to_f64(), FRAC_PI_2);
        assert_eq!(pair.critical_height().to_f64(), 0.0625);
        assert!(!pair.is_rough());
        assert!(RayleighPair { height: 0.0625f64.next_up(), ..pair }.is_rough());
        assert_eq!(pair.path_difference().to_f64(), 0.125);
        // At grazing incidence nothing is rough.
        let grazing = RayleighPair { sin_beta: 0.0, ..pair };
        assert!(!grazing.is_rough());
        assert_eq!(grazing.critical_height().to_f64(), f64::INFINITY);
    }

    #[test]
    fn regimes_follow_g() {
        assert_eq!(Regime::of(0.0), Regime::Smooth);
        assert_eq!(Regime::of(Regime::SMOOTH_UP_TO), Regime::Smooth);
        assert_eq!(Regime::of(Regime::SMOOTH_UP_TO.next_up()), Regime::Moderate);
        assert_eq!(Regime::of(10.0), Regime::Rough);
    }

    #[test]
    fn figures_11a_and_12d_are_not_locally_flat() {
        // Errata E29: 0.06 λ and 0.02 λ.
        let radius = curvature_radius_in_wavelengths(0.001, 0.01, 0.5);
        assert!((radius - 0.06).abs() < 0.005, "{radius}");
        assert!(!is_locally_flat(radius));
        let radius = curvature_radius_in_wavelengths(0.001, 0.006, 0.5);
        assert!((radius - 0.02).abs() < 0.005, "{radius}");
        assert!(is_locally_flat(curvature_radius_in_wavelengths(0.2, 4.0, 0.55)));
    }
}
