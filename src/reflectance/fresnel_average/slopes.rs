//! The mean of F′ over the slopes of a Gaussian surface.

use crate::reflectance::degrees::SinCos;
use crate::reflectance::fresnel::{Energy, Medium, Polarization, RefractiveIndex};
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::quadrature::{Integral, integrate_to};
use crate::reflectance::quantity::AveragedRatio;
use core::cell::Cell;
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// The mean of F′ over the slopes of a Gaussian surface, and the share of them that it is taken over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeAverage {
    /// E[F′(θ′) | cos θ′ > 0].
    pub reflectance: Energy,
    /// P(cos θ′ > 0) = ½ erfc(−cot θ_i/2`r`) with `r` = σ_h/T: the share of the mean plane above which the surface faces the
    /// source.
    pub illuminated_fraction: f64,
}

/// What is left out of the Gaussian: e^{−60} of its peak, and as much of all slopes.
const CUT: f64 = 60.0;
/// A ring of normals is followed to where the Gaussian is e^{−60} of what it is at most on the ring.
const RING_CUT: f64 = 60.0;
/// What that and the ends of the rules that stop there make of a mean, at most.
const BEYOND_CUT: f64 = 1e-24;
/// The finest relative tolerance: below it rounding of the weights may keep the value from settling.
pub const FINEST: f64 = 64.0 * EPSILON;
/// Of a bound.
const ENOUGH: f64 = 0.01;
/// What a coarser one than this would save is not worth asking for.
const COARSEST: f64 = 1e-4;

/// Errors in ε. Of sin θ′ and cos θ′ formed from θ_i and δ, absolute; of the former over its terms.
const LOCAL_UNITS: f64 = 12.0;
/// Of the weight's exponent and of 1/cos³α, relative, times cos α: sin²(α/2) is known to 15 ε beside that, and the ratio σ_h/T
/// to 8 ε.
const SLOPE_UNITS: f64 = 54.0;
/// Of its other factors.
const FACTOR_UNITS: f64 = 32.0;

/// The mean of F′ over all slopes (p, q) that face the source, each slope Gaussian with variance 2(σ_h/T)².
///
/// Domain: 0 ≤ θ_i ≤ 90°. The error comes with the value: it holds for a ratio known to 8 ε and is about 2e-14 at the [`FINEST`]
/// tolerance, relative; the value is as good as `tolerance`, or as f64 can.
///
/// In polar coordinates about the source the normals at angle θ′ share one F′, so the slopes' density is first integrated
/// around it and then against F′ over θ′ − θ_i, in pieces that end at Brewster's angle and at the critical angle, where the
/// derivative of F′ is infinite.
pub fn slope_average(
    medium: &Medium,
    polarization: Polarization,
    incidence: SinCos,
    ratio: AveragedRatio,
    tolerance: f64,
) -> SlopeAverage {
    let illuminated_fraction = 0.5 * libm::erfc(-incidence.cos / incidence.sin / (2.0 * ratio.get()));
    let index = match medium {
        Medium::PerfectConductor => {
            return SlopeAverage { reflectance: Energy::ONE, illuminated_fraction };
        }
        Medium::Index(index) => *index,
    };
    let tolerance = tolerance.clamp(FINEST, COARSEST);
    let normals = Normals::new(incidence, SQRT_2 * ratio.get(), tolerance / 8.0);
    // Two digits of a bound are enough, with 2 % for the third.
    let rough = Normals::new(incidence, normals.deviation, ENOUGH);
    let reflectance = |local| index.energies(local).mixed(polarization);
    let mean = normals.integrate(tolerance, index, |normal| normal.weight * reflectance(normal.local).value);
    let bound = rough.integrate(ENOUGH, index, |normal| {
        let energy = reflectance(normal.local);
        // What θ′ is off by moves F′ along its course, beside the error of F′ itself.
        let off = LOCAL_UNITS * EPSILON;
        let SinCos { sin, cos } = normal.local;
        let moved = (reflectance(SinCos { sin, cos: (cos + off).min(1.0) }).value - energy.value).abs()
            + (reflectance(SinCos { sin: (sin + off).min(1.0), cos }).value - energy.value).abs();
        normal.weight * (energy.error + moved) + normal.weight_error * energy.value
    });
    let value = (mean.value / illuminated_fraction).min(1.0);
    let absolute = 1.02 * bound.value
        + mean.error
        + normals.unsettled.get() * mean.value
        + normals.horizon_error()
        + BEYOND_CUT;
    let error = absolute / illuminated_fraction + 8.0 * EPSILON * value;
    SlopeAverage { reflectance: Energy { value, error: error.min(1.0) }, illuminated_fraction }
}

/// Facet normals by their angle θ′ = θ_i + δ from the source.
struct Normals {
    incidence: SinCos,
    theta_i: f64,
    /// Standard deviation of either slope.
    deviation: f64,
    /// The largest sin²(α/2) that is not cut.
    reach: f64,
    /// Relative, of the rule around the source.
    tolerance: f64,
    /// The last change of that rule, the largest so far.
    unsettled: Cell<f64>,
}

/// The normals at one θ′.
struct Ring {
    /// sin and cos of θ′, not negative.
    local: SinCos,
    /// The density of slopes by θ′, and the bound of its error but for that of the rule around the source.
    weight: f64,
    weight_error: f64,
}

impl Normals {
    fn new(incidence: SinCos, deviation: f64, tolerance: f64) -> Self {
        let steepest = libm::atan(deviation * (2.0 * CUT).sqrt());
        let half = libm::sin(0.5 * steepest);
        let theta_i = libm::atan2(incidence.sin, incidence.cos);
        Self { incidence, theta_i, deviation, reach: half * half, tolerance, unsettled: Cell::new(0.0) }
    }

    /// The steepest slope angle that is not cut.
    fn steepest(&self) -> f64 {
        2.0 * libm::asin(self.reach.sqrt())
    }

    /// ∫ f dδ over the normals with 0 < cos θ′.
    fn integrate(&self, tolerance: f64, index: RefractiveIndex, f: impl Fn(&Ring) -> f64) -> Integral {
        let steepest = self.steepest();
        let (first, last) = ((-self.theta_i).max(-steepest), (FRAC_PI_2 - self.theta_i).min(steepest));
        let n = index.n.get();
        let critical = if n < 1.0 { libm::asin(n) - self.theta_i } else { last };
        let mut ends =
            [first, 0.0, libm::atan(n) - self.theta_i, critical, last].map(|end| end.clamp(first, last));
        ends.sort_by(f64::total_cmp);
        ends.windows(2)
            .map(|piece| integrate_to(tolerance, piece[0], piece[1], |delta| f(&self.ring(delta))))
            .fold(Integral::ZERO, Integral::plus)
    }

    /// What the rounding of 90° − θ_i, where the normals end, can make of the mean of a reflectance.
    fn horizon_error(&self) -> f64 {
        let last = FRAC_PI_2 - self.theta_i;
        if last < self.steepest() { 8.0 * EPSILON * self.ring(last).weight } else { 0.0 }
    }

    /// The normals at θ_i + δ.
    fn ring(&self, delta: f64) -> Ring {
        let (sin, cos) = libm::sincos(delta);
        let SinCos { sin: sin_i, cos: cos_i } = self.incidence;
        let local =
            SinCos { sin: (sin_i * cos + cos_i * sin).max(0.0), cos: (cos_i * cos - sin_i * sin).max(0.0) };
        let terms = sin_i * cos.abs() + cos_i * sin.abs();
        let (around, around_error) = self.around(delta, local.sin, terms);
        let scale = 1.0 / (2.0 * PI) / self.deviation / self.deviation;
        let lost = LOCAL_UNITS * EPSILON * terms;
        Ring {
            local,
            weight: scale * (local.sin * around),
            weight_error: scale * (local.sin * around_error + lost * (around + around_error)),
        }
    }

    /// ∫ exp(−tan²α/2s²)/cos³α dψ around the source, and the bound of its rounding: dp dq = dω/cos³α. `terms` is what sin θ′ is
    /// the sum of.
    ///
    /// The trapezoidal rule from ψ = 0 to where the integrand is cut or to π; it is even about both ends, so the
    /// rule converges faster than any power of its step.
    fn around(&self, delta: f64, sin_local: f64, terms: f64) -> (f64, f64) {
        let half = libm::sin(0.5 * delta);
        let nearest = half * half;
        let across = sin_local * self.incidence.sin;
        let reach = self.reach_beyond(nearest);
        let end = if reach < across { 2.0 * libm::asin((reach / across).max(0.0).sqrt()) } else { PI };
        let off = LOCAL_UNITS * EPSILON * terms * self.incidence.sin;
        // sin²(α/2) = sin²(δ/2) + sin θ′ sin θ_i sin²(ψ/2)
        let at = |psi: f64| {
            let half = libm::sin(0.5 * psi);
            let square = half * half;
            self.density(nearest + across * square, off * square)
        };
        let mut points = 8;
        let mut sum = at(0.0).plus(at(end)).times(0.5);
        sum = (1..points).fold(sum, |sum, i| sum.plus(at(end * (f64::from(i) / f64::from(points)))));
        let mut value = sum.value * end / f64::from(points);
        let mut change = 1.0;
        while points < MOST_POINTS {
            let between = |i: i32| end * ((f64::from(i) + 0.5) / f64::from(points));
            sum = (0..points).fold(sum, |sum, i| sum.plus(at(between(i))));
            points *= 2;
            let finer = sum.value * end / f64::from(points);
            change = (finer - value).abs() / finer;
            value = finer;
            // Of nothing nothing is left.
            if change <= self.tolerance || finer == 0.0 {
                break;
            }
        }
        self.unsettled.set(self.unsettled.get().max(change));
        let rounding = sum.error * end / f64::from(points) + EPSILON * f64::from(points) * value;
        (2.0 * value, 2.0 * rounding)
    }

    /// How much larger sin²(α/2) can be on a ring than the least there is on it.
    fn reach_beyond(&self, nearest: f64) -> f64 {
        let cos = 1.0 - 2.0 * nearest;
        let tan = 2.0 * (nearest * (1.0 - nearest)).sqrt() / cos;
        let ratio = tan / self.deviation;
        let steepest = self.deviation * (ratio * ratio + 2.0 * RING_CUT).sqrt();
        // sin²(α/2) − sin²(α₀/2) by the sine of half the sum and of half the difference of both angles.
        let (least, most) = (libm::atan(tan), libm::atan(steepest));
        libm::sin(0.5 * (most + least)) * libm::sin(0.5 * (most - least))
    }

    /// exp(−tan²α/2s²)/cos³α from sin²(α/2), which is off by a few ε and another `off`; 0 at and below the horizon.
    fn density(&self, half_sin_squared: f64, off: f64) -> Density {
        let cos = 1.0 - 2.0 * half_sin_squared;
        if cos <= 0.0 {
            return Density { value: 0.0, error: 0.0 };
        }
        let slope_squared = 4.0 * half_sin_squared * (1.0 - half_sin_squared) / (cos * cos);
        let exponent = 0.5 * slope_squared / self.deviation / self.deviation;
        let value = libm::exp(-exponent) / (cos * cos * cos);
        // d exponent/d sin²(α/2) = 2/s² cos³α
        let by_off = off * (2.0 / self.deviation / self.deviation / (cos * cos * cos) + 6.0 / cos);
        let relative = EPSILON * (FACTOR_UNITS + SLOPE_UNITS * (exponent + 1.0) / cos) + by_off;
        Density { value, error: value * relative }
    }
}

/// A weight and the bound of its error.
#[derive(Clone, Copy)]
struct Density {
    value: f64,
    error: f64,
}

impl Density {
    fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }

    fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, error: self.error * factor }
    }
}

/// The trapezoidal rule stops here; 64 points suffice up to σ_h/T = 0.5.
const MOST_POINTS: i32 = 1024;

#[cfg(test)]
mod tests;
