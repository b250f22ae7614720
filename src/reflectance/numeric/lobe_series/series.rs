//! The sum itself, around its largest term.
//!
//! The terms are log-concave in m, so there is one peak, near the saddle μ, and the terms fall
//! faster than geometrically on both sides. While their standard deviation is below 8 all that
//! matter are summed; above it, every h-th one (the trapezoidal rule, whose error is that of a
//! Gaussian sampled at 2.5 points a standard deviation or more, below e^{-120}): cost does not
//! grow with g.

use super::between::Enclosure;
use super::saddle::Saddle;
use super::uniform;
use super::{LobeSeries, Method, rounding};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::numeric::scaled::Scaled;

/// Terms below this share of the sum end it; the rest of a side is then below 2^-54 of it.
const NEGLIGIBLE: f64 = 1.0 / (1u64 << 58) as f64;
/// The same for a sum that need only be near.
const LARGER: f64 = 1.0 / 64.0;
/// A share of the sum that may be missing without a change of its conditions by 1.
const LITTLE: f64 = 1e-3;
/// From this variance of the terms on, every h-th term is enough: the first terms are below e^{-60}.
const STRIDED_FROM_VARIANCE: f64 = 64.0;
/// From this μ w on, which is the size of the exponents, their rounding leaves the terms no digits to
/// be summed with; μ is then above 1e10 and c₅/μ⁵ below 1e-47.
const CONTINUOUS_FROM: f64 = 1e14;
/// The authors' number of terms.
const PAPER_TERMS: f64 = 100.0;

/// Σ t_m/t_c with its first moments.
#[derive(Clone, Copy)]
struct Moments {
    g: f64,
    sum: f64,
    /// Σ (m − g) t
    first: f64,
    /// Σ t/m
    inverse: f64,
}

impl Moments {
    fn around(g: f64) -> Self {
        Self { g, sum: 0.0, first: 0.0, inverse: 0.0 }
    }

    fn add(&mut self, m: f64, t: f64) {
        self.sum += t;
        self.first += (m - self.g) * t;
        self.inverse += t / m;
    }

    /// |∂ ln/∂ ln g| and |∂ ln/∂ ln x| of the sum.
    fn conditions(&self, x: f64) -> (f64, f64) {
        ((self.first / self.sum).abs(), x * (self.inverse / self.sum))
    }

    /// The sum times the term it is relative to.
    fn series(self, x: f64, reference: Scaled) -> LobeSeries {
        let (condition_g, condition_x) = self.conditions(x);
        LobeSeries::converged(reference * self.sum, 0.0, condition_g, condition_x, Method::Series)
    }
}

/// S to full precision.
pub(super) fn converged(g: f64, x: f64, saddle: &Saddle) -> LobeSeries {
    if saddle.mu * saddle.w >= CONTINUOUS_FROM {
        LobeSeries { method: Method::Series, ..uniform::order_four(g, x, saddle) }
    } else if saddle.variance() >= STRIDED_FROM_VARIANCE {
        strided(g, x, saddle)
    } else {
        let centre = saddle.mu.round().max(1.0);
        let (moments, _) = neighbours(g, x, centre, f64::INFINITY, NEGLIGIBLE);
        moments.series(x, term(centre, g, x))
    }
}

/// S between the sum of its larger terms and that sum with geometric tails.
pub(super) fn enclose(g: f64, x: f64, saddle: &Saddle) -> Enclosure {
    let centre = saddle.mu.round().max(1.0);
    let (moments, rest) = neighbours(g, x, centre, f64::INFINITY, LARGER);
    let (condition_g, condition_x) = moments.conditions(x);
    let largest = term(centre, g, x);
    let (low, high) = (largest * moments.sum, largest * (moments.sum + rest));
    // The mean of m may move by as much as its tails weigh.
    Enclosure::rounded(low, high, condition_g + 0.5, condition_x * (1.0 + rest / moments.sum))
}

/// The first 100 terms, each to full precision: what is missing is the rest of the series.
///
/// With the ratio of neighbours falling, the rest is at most t₁₀₁/(1 − ratio), and S itself is known
/// from both sides.
pub(super) fn first_hundred(g: f64, x: f64) -> LobeSeries {
    let saddle = Saddle::of(g, x);
    let centre = saddle.mu.round().clamp(1.0, PAPER_TERMS);
    let (moments, _) = neighbours(g, x, centre, PAPER_TERMS, NEGLIGIBLE);
    let value = term(centre, g, x) * moments.sum;
    let (condition_g, condition_x) = moments.conditions(x);
    let own = rounding(condition_g, condition_x);

    let next = PAPER_TERMS + 1.0;
    let ratio = ratio_up(next, g, x);
    let first_missing = term(next, g, x);
    let next_rounding = rounding((next - g).abs(), x / next);
    let rest = if ratio < 1.0 {
        let tail = first_missing * (1.0 / (1.0 - ratio));
        tail + tail.spread(next_rounding)
    } else {
        Scaled::INFINITY
    };
    let of_rest = rest + value.spread(own);
    let least = value.lowered(own) + first_missing.lowered(next_rounding);
    if (rest / value).to_f64() < LITTLE {
        // Whatever is missing, the mean of m and of 1/m hardly move.
        let estimate = Estimate { value, error: of_rest, least };
        let (condition_g, condition_x) = (condition_g + 1.0, condition_x + 1.0);
        return LobeSeries { estimate, condition_g, condition_x, method: Method::Paper };
    }
    let judged = Enclosure::at(g, x, &saddle).judge(value, own, Method::Paper);
    let Estimate { error, least: low, .. } = judged.estimate;
    let estimate = Estimate { value, error: error.smaller(of_rest), least: low.larger(least) };
    LobeSeries { estimate, ..judged }
}

/// t_{m+1}/t_m.
fn ratio_up(m: f64, g: f64, x: f64) -> f64 {
    let next = m + 1.0;
    m / (next * next) * tilted(g, x / (m * next))
}

/// g e^`tilt`, where a g near the end of f64's range meets a tilt that makes up for it.
fn tilted(g: f64, tilt: f64) -> f64 {
    if tilt < 300.0 { g * libm::exp(tilt) } else { libm::exp(tilt + libm::log(g)) }
}

/// All terms above `share` of the sum on both sides of `centre`, up to `last`, relative to the one at
/// `centre`, and a bound of the rest: the terms beyond fall faster than geometrically.
fn neighbours(g: f64, x: f64, centre: f64, last: f64, share: f64) -> (Moments, f64) {
    let mut moments = Moments::around(g);
    moments.add(centre, 1.0);
    let (mut m, mut t, mut ratio) = (centre, 1.0, 0.0);
    let mut matters = true;
    while matters && m < last {
        ratio = ratio_up(m, g, x);
        t *= ratio;
        m += 1.0;
        moments.add(m, t);
        matters = ratio >= 1.0 || t >= share * moments.sum;
    }
    let mut rest = t * ratio / (1.0 - ratio);
    (m, t, ratio) = (centre, 1.0, 0.0);
    matters = true;
    while matters && m > 1.0 {
        m -= 1.0;
        ratio = 1.0 / ratio_up(m, g, x);
        t *= ratio;
        moments.add(m, t);
        matters = ratio >= 1.0 || t >= share * moments.sum;
    }
    if m > 1.0 {
        rest += t * ratio / (1.0 - ratio);
    }
    (moments, rest)
}

/// Every h-th term around the saddle times h. The nodes are multiples of a power of two: exact.
fn strided(g: f64, x: f64, saddle: &Saddle) -> LobeSeries {
    let deviation = saddle.variance().sqrt();
    let stride = libm::exp2((deviation / 2.5).log2().floor());
    let centre = (saddle.mu / stride).round() * stride;
    let exponent_at_centre = exponent(centre, g, x);
    let weight = |m: f64| libm::exp(exponent_at_centre - exponent(m, g, x)) / (m * m.sqrt());
    let mut moments = Moments::around(g);
    moments.add(centre, weight(centre));
    let mut m = centre;
    let mut matters = true;
    while matters {
        m += stride;
        let t = weight(m);
        moments.add(m, t);
        matters = t >= NEGLIGIBLE * moments.sum;
    }
    m = centre;
    matters = true;
    while matters && m > stride {
        m -= stride;
        let t = weight(m);
        moments.add(m, t);
        matters = t >= NEGLIGIBLE * moments.sum;
    }
    let scale = stride / (2.0 * core::f64::consts::PI).sqrt();
    moments.series(x, Scaled::exp(-exponent_at_centre) * scale)
}

/// One term, e^{-g} g^m/(m! m) e^{-x/m}.
fn term(m: f64, g: f64, x: f64) -> Scaled {
    // Few factors, or a g far below m: the product is exact where m ln(m/g) would cost digits.
    if m <= 2.0 || (m <= 32.0 && g < 0.5 * m) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 32")]
        let count = m as u32;
        let factorial: f64 = (2..=count).map(f64::from).product();
        Scaled::new(g).powi(count) * Scaled::exp(-(g + x / m)) / Scaled::new(factorial * m)
    } else {
        let root = (2.0 * core::f64::consts::PI * m).sqrt();
        Scaled::exp(-exponent(m, g, x)) / Scaled::new(m * root)
    }
}

/// −ln(t_m · m √(2πm)) = m ln(m/g) − m + g + x/m + (Stirling's remainder).
fn exponent(m: f64, g: f64, x: f64) -> f64 {
    deviance(m, g) + (x / m + stirling_remainder(m))
}

/// m ln(m/g) − m + g without cancellation.
pub(super) fn deviance(m: f64, g: f64) -> f64 {
    let (difference, sum) = (m - g, m + g);
    if difference.abs() >= 0.1 * sum {
        // m/g overflows for a subnormal g.
        let ln_ratio = if g > 1e-290 { libm::log(m / g) } else { libm::log(m) - libm::log(g) };
        return m * ln_ratio - difference;
    }
    deviance_near(m, difference, difference / sum)
}

/// The same near m = g by Loader's expansion in v = (m − g)/(m + g), |v| ≤ 0.1: m ln(m/g) = 2m (v + v³/3 + v⁵/5 + …)
/// and 2mv − (m − g) = (m − g) v.
#[inline(always)]
pub(super) fn deviance_near(m: f64, difference: f64, v: f64) -> f64 {
    let v2 = v * v;
    // The first power left out, v^17/17, is below 1e-17 of the first.
    let tail = v2
        * (1.0 / 3.0
            + v2 * (1.0 / 5.0
                + v2 * (1.0 / 7.0
                    + v2 * (1.0 / 9.0 + v2 * (1.0 / 11.0 + v2 * (1.0 / 13.0 + v2 * (1.0 / 15.0)))))));
    difference * v + 2.0 * m * v * tail
}

/// ln m! − (m + ½) ln m + m − ½ ln 2π, error below 2e-17 for m ≥ 1.
pub(super) fn stirling_remainder(m: f64) -> f64 {
    /// For m = 1 … 15: the series needs m ≥ 16.
    const SMALL: [f64; 16] = [
        0.0,
        0.081_061_466_795_327_26,
        0.041_340_695_955_409_29,
        0.027_677_925_684_998_34,
        0.020_790_672_103_765_093,
        0.016_644_691_189_821_193,
        0.013_876_128_823_070_748,
        0.011_896_709_945_891_77,
        0.010_411_265_261_972_096,
        0.009_255_462_182_712_733,
        0.008_330_563_433_362_87,
        0.007_573_675_487_951_841,
        0.006_942_840_107_209_53,
        0.006_408_994_188_004_207,
        0.005_951_370_112_758_848,
        0.005_554_733_551_962_801,
    ];
    if m < 16.0 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 15")]
        return SMALL[m as usize];
    }
    let r = 1.0 / m;
    let r2 = r * r;
    r * (1.0 / 12.0
        - r2 * (1.0 / 360.0
            - r2 * (1.0 / 1260.0 - r2 * (1.0 / 1680.0 - r2 * (1.0 / 1188.0 - r2 * (691.0 / 360360.0))))))
}
