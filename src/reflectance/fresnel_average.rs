//! ⟨FF*⟩ of (41): the energy reflectance by which a rough surface of finite conductivity falls short of a perfect conductor.
//!
//! The report leaves open over what F is averaged (errata E25). Three readings agree as σ_h/T → 0 towards the mirror direction:
//! the mean plane ([`mean_plane`]), the facets that mirror the source to the viewer ([`half_vector`], which the models here
//! use and Torrance-Sparrow's F′ is), and all facets that the source reaches ([`slope_average`]).

use super::degrees::SinCos;
use super::fresnel::{Energy, Medium, Polarization, RefractiveIndex};
use super::geometry::Geometry;
use super::numeric::EPSILON;
use super::numeric::quadrature::{FINEST, Integral, integrate_to};
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// F′ of (63) at θ_i.
pub fn mean_plane(medium: &Medium, polarization: Polarization, geometry: &Geometry) -> Energy {
    medium.reflectance(SinCos { sin: geometry.sin_i, cos: geometry.cos_i }, polarization)
}

/// F′ of (63) at θ′ of (59).
pub fn half_vector(medium: &Medium, polarization: Polarization, geometry: &Geometry) -> Energy {
    medium.reflectance(geometry.local_incidence(), polarization)
}

/// The mean of F′ over the slopes of a Gaussian surface, and the share of them that it is taken over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeAverage {
    /// E[F′(θ′) | cos θ′ > 0].
    pub reflectance: Energy,
    /// P(cos θ′ > 0) = ½ erfc(−cot θ_i/2`r`) with `r` = σ_h/T: the share of the mean plane above which the surface faces the
    /// source.
    pub illuminated_fraction: f64,
}

/// The widest slope that is integrated, σ_h/T = 4: 45 deviations of it still cover every slope there is, but beyond it the
/// normals crowd at the horizon.
pub const LARGEST_RATIO: f64 = 4.0;

/// What is left out of the Gaussian: e^{−45} of its peak.
const CUT: f64 = 45.0;

/// The mean of F′ over all slopes (p, q) that face the source, each slope Gaussian with variance 2(σ_h/T)².
///
/// Domain: 0 ≤ θ_i ≤ 90°, 0 < `ratio` = σ_h/T ≤ [`LARGEST_RATIO`] (none beyond). The error comes with the value.
///
/// In polar coordinates about the source the normals at angle θ′ share one F′, so the slopes' density is first integrated
/// around it and then against F′ over θ′ − θ_i, in pieces that end at Brewster's angle and at the critical angle, where the
/// derivative of F′ is infinite.
pub fn slope_average(
    medium: &Medium,
    polarization: Polarization,
    incidence: SinCos,
    ratio: f64,
) -> Option<SlopeAverage> {
    if ratio.is_nan() || ratio <= 0.0 || ratio > LARGEST_RATIO {
        return None;
    }
    let illuminated_fraction = 0.5 * libm::erfc(-incidence.cos / incidence.sin / (2.0 * ratio));
    let index = match medium {
        Medium::PerfectConductor => {
            return Some(SlopeAverage { reflectance: Energy::ONE, illuminated_fraction });
        }
        Medium::Index(index) => index,
    };
    let normals = Normals::new(incidence, SQRT_2 * ratio);
    let reflectance = |local| index.energies(local).mixed(polarization);
    let mean = normals.integrate(FINEST, *index, |local| reflectance(local).value);
    // The error is a bound already: two digits of it are enough, with 2 % for the third.
    let bound = normals.integrate(0.01, *index, |local| reflectance(local).error);
    let value = mean.value / illuminated_fraction;
    // Of F′; of the quadrature; of the weights, whose exponents carry 20 ε of themselves, 1 on the average.
    let error = (1.02 * bound.value + mean.error) / illuminated_fraction + 64.0 * EPSILON * value;
    Some(SlopeAverage { reflectance: Energy { value, error }, illuminated_fraction })
}

/// Facet normals by their angle θ′ = θ_i + δ from the source.
struct Normals {
    incidence: SinCos,
    theta_i: f64,
    /// Standard deviation of either slope.
    deviation: f64,
    /// The largest sin²(α/2) that is not cut.
    reach: f64,
}

impl Normals {
    fn new(incidence: SinCos, deviation: f64) -> Self {
        let steepest = libm::atan(deviation * (2.0 * CUT).sqrt());
        let half = libm::sin(0.5 * steepest);
        Self { incidence, theta_i: libm::atan2(incidence.sin, incidence.cos), deviation, reach: half * half }
    }

    /// ∫ f(θ′) p(slopes) over the slopes with 0 < cos θ′.
    fn integrate(&self, tolerance: f64, index: RefractiveIndex, f: impl Fn(SinCos) -> f64) -> Integral {
        let steepest = 2.0 * libm::asin(self.reach.sqrt());
        let (first, last) = ((-self.theta_i).max(-steepest), (FRAC_PI_2 - self.theta_i).min(steepest));
        let n = index.n.get();
        let critical = if n < 1.0 { libm::asin(n) - self.theta_i } else { last };
        let mut ends =
            [first, 0.0, libm::atan(n) - self.theta_i, critical, last].map(|end| end.clamp(first, last));
        ends.sort_by(f64::total_cmp);
        let scale = 1.0 / (2.0 * PI) / self.deviation / self.deviation;
        ends.windows(2)
            .map(|piece| {
                integrate_to(tolerance, piece[0], piece[1], |delta| {
                    let local = self.local(delta);
                    scale * f(local) * (local.sin * self.around(delta, local.sin))
                })
            })
            .fold(Integral::ZERO, Integral::plus)
    }

    /// sin and cos of θ_i + δ, not negative.
    fn local(&self, delta: f64) -> SinCos {
        let (sin, cos) = libm::sincos(delta);
        let SinCos { sin: sin_i, cos: cos_i } = self.incidence;
        SinCos { sin: (sin_i * cos + cos_i * sin).max(0.0), cos: (cos_i * cos - sin_i * sin).max(0.0) }
    }

    /// ∫ exp(−tan²α/2s²)/cos³α dψ around the source: dp dq = dω/cos³α.
    ///
    /// The trapezoidal rule from ψ = 0 to where the integrand is cut or to π; it is even about both ends, so the
    /// rule converges faster than any power of its step.
    fn around(&self, delta: f64, sin_local: f64) -> f64 {
        let half = libm::sin(0.5 * delta);
        let nearest = half * half;
        let across = sin_local * self.incidence.sin;
        let end = if self.reach - nearest < across {
            2.0 * libm::asin(((self.reach - nearest) / across).max(0.0).sqrt())
        } else {
            PI
        };
        // sin²(α/2) = sin²(δ/2) + sin θ′ sin θ_i sin²(ψ/2)
        let density = |psi: f64| {
            let half = libm::sin(0.5 * psi);
            self.density(nearest + across * half * half)
        };
        let mut points = 8;
        let mut sum = 0.5 * (density(0.0) + density(end));
        sum += (1..points).map(|i| density(end * (f64::from(i) / f64::from(points)))).sum::<f64>();
        let mut value = sum * end / f64::from(points);
        while points < MOST_POINTS {
            sum +=
                (0..points).map(|i| density(end * ((f64::from(i) + 0.5) / f64::from(points)))).sum::<f64>();
            points *= 2;
            let finer = sum * end / f64::from(points);
            let settled = (finer - value).abs() <= FINEST * finer;
            value = finer;
            if settled {
                break;
            }
        }
        2.0 * value
    }

    /// exp(−tan²α/2s²)/cos³α from sin²(α/2); 0 at and below the horizon.
    fn density(&self, half_sin_squared: f64) -> f64 {
        let cos = 1.0 - 2.0 * half_sin_squared;
        if cos <= 0.0 {
            return 0.0;
        }
        let slope_squared = 4.0 * half_sin_squared * (1.0 - half_sin_squared) / (cos * cos);
        libm::exp(-0.5 * slope_squared / self.deviation / self.deviation) / (cos * cos * cos)
    }
}

/// The trapezoidal rule stops here; 64 points suffice up to σ_h/T = 0.5.
const MOST_POINTS: i32 = 1024;

#[cfg(test)]
mod tests {
    use super::{LARGEST_RATIO, Normals, half_vector, mean_plane, slope_average};
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::fresnel::{Energy, Medium, Polarization, RefractiveIndex};
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::numeric::{EPSILON, quadrature::integrate};
    use crate::reflectance::quantity::{Azimuth, IndexK, IndexN, Quantity, SourceZenith, ViewerZenith};
    use core::f64::consts::{PI, SQRT_2};

    fn index(n: f64, k: f64) -> RefractiveIndex {
        RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() }
    }

    #[test]
    fn the_weights_add_up_to_the_illuminated_fraction() {
        for ratio in [1e-100, 1e-6, 0.01, 0.1, 0.5, 1.0, LARGEST_RATIO] {
            for theta_i in [0.0, 1e-6, 30.0, 60.0, 85.0, 90.0] {
                let incidence = SinCos::of_degrees(theta_i);
                let normals = Normals::new(incidence, SQRT_2 * ratio);
                let whole = normals.integrate(super::FINEST, index(1.5, 0.0), |_| 1.0);
                let closed =
                    slope_average(&Medium::PerfectConductor, Polarization::unpolarized(), incidence, ratio)
                        .unwrap()
                        .illuminated_fraction;
                // The stated error of the quadrature, and 64 ε for the weights' exponents.
                let slack = whole.error + 64.0 * EPSILON * closed;
                assert!((whole.value - closed).abs() <= slack, "{ratio} {theta_i} {whole:?} {closed}");
            }
        }
    }

    #[test]
    fn normal_incidence_is_one_integral_even_across_total_reflection() {
        // θ′ = α: E[F′] = ∫ F′(atan st) t e^{−t²/2} dt, split where F′ is not smooth.
        let (n, deviation) = (1.0 / 1.5, 0.5);
        let parallel = Polarization::parallel();
        let f = |t: f64| {
            let cos = 1.0 / libm::hypot(1.0, deviation * t);
            let energy = index(n, 0.0).energies(SinCos { sin: deviation * t * cos, cos }).mixed(parallel);
            energy.value * t * libm::exp(-0.5 * t * t)
        };
        let critical = n / (1.0 - n * n).sqrt() / deviation;
        let exact = [
            (0.0, n / deviation),
            (n / deviation, critical),
            (critical, 2.0 * critical),
            (2.0 * critical, 12.0),
        ]
        .map(|(a, b)| integrate(a, b, f).value)
        .iter()
        .sum::<f64>();
        let got = slope_average(
            &Medium::Index(index(n, 0.0)),
            parallel,
            SinCos::of_degrees(0.0),
            deviation / SQRT_2,
        )
        .unwrap();
        let slack = got.reflectance.error + 64.0 * EPSILON * exact;
        assert!((got.reflectance.value - exact).abs() <= slack, "{got:?} {exact}");
        assert!(got.reflectance.error < 1e-12 * exact, "{got:?}");
    }

    #[test]
    fn oblique_incidence_across_total_reflection() {
        // By 22-digit nested quadrature over the plane of slopes, split along Brewster's and the critical angle. Without the
        // splits such a quadrature settles nowhere near: the critical angle, 53°, is one deviation of the slopes away from 40°.
        let exact = 0.207_622_019_237_823_78;
        let (sin, cos) = libm::sincos(0.7);
        let glass = Medium::Index(index(0.8, 0.0));
        let got = slope_average(&glass, Polarization::unpolarized(), SinCos { sin, cos }, 0.15).unwrap();
        let energy = got.reflectance;
        assert!((energy.value - exact).abs() <= energy.error, "{energy:?}");
        assert!(energy.error < 400.0 * EPSILON * exact, "{energy:?}");
    }

    #[test]
    fn oblique_incidence_agrees_with_the_plane_of_slopes() {
        let (metal, mix) = (index(0.2, 3.4), Polarization::unpolarized());
        let (incidence, deviation) = (SinCos::of_degrees(50.0), 0.2);
        // The source leaves the facets at p = −cot 50° = −4.2 deviations: most of its e^{−9} is within reach.
        let shadow = -incidence.cos / incidence.sin / deviation;
        let mean = integrate(shadow, 9.5, |p| {
            integrate(0.0, 9.5, |q| {
                let secant = (1.0 + deviation * deviation * (p * p + q * q)).sqrt();
                let cos = (incidence.cos + incidence.sin * deviation * p) / secant;
                let sin = (1.0 - cos * cos).max(0.0).sqrt();
                let weight = libm::exp(-0.5 * (p * p + q * q)) / PI;
                weight * metal.energies(SinCos { sin, cos }).mixed(mix).value
            })
            .value
        });
        let got = slope_average(&Medium::Index(metal), mix, incidence, deviation / SQRT_2).unwrap();
        // sin by 1 − cos² costs the reference ε/sin² near normal incidence of a facet; the weight there is small.
        let exact = mean.value / got.illuminated_fraction;
        assert!((got.reflectance.value / exact - 1.0).abs() < 256.0 * EPSILON, "{got:?} {exact}");
    }

    #[test]
    fn readings_meet_on_a_smooth_surface_in_the_mirror_direction() {
        let (glass, mix) = (Medium::Index(index(1.5, 0.0)), Polarization::unpolarized());
        let geometry = Geometry::new(
            SourceZenith::new(40.0).unwrap(),
            ViewerZenith::new(40.0).unwrap(),
            Azimuth::new(0.0).unwrap(),
        );
        let plane = mean_plane(&glass, mix, &geometry);
        let half = half_vector(&glass, mix, &geometry);
        let slopes = slope_average(&glass, mix, SinCos::of_degrees(40.0), 1e-12).unwrap().reflectance;
        for other in [half, slopes] {
            assert!((other.value - plane.value).abs() <= other.error + plane.error, "{other:?} {plane:?}");
        }
    }

    #[test]
    fn outside_the_domain_there_is_no_average() {
        let glass = Medium::Index(index(1.5, 0.0));
        for ratio in [0.0, -1.0, 4.1, f64::NAN] {
            assert!(
                slope_average(&glass, Polarization::parallel(), SinCos::of_degrees(9.0), ratio).is_none()
            );
        }
        let conductor =
            slope_average(&Medium::PerfectConductor, Polarization::parallel(), SinCos::of_degrees(9.0), 1.0)
                .unwrap();
        assert_eq!(conductor.reflectance, Energy::ONE);
    }
}
