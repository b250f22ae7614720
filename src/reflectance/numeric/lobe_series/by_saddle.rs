//! The points of a batch that need the saddle: its position by Lambert's W, then R by a polynomial
//! patch where the sum equals its integral, the sum itself where few terms matter.

use super::lanes::{Batch, Form, LANES, Lanes, Places};
use super::patches::{Patch, Tier};
use super::{Method, direct};
use crate::reflectance::numeric::elementary::{exp, ln_1p_roughly};

/// The saddles of a batch's points.
struct Saddles {
    mu: Lanes,
    /// 1/μ
    inverse_mu: Lanes,
    /// 1/w
    t: Lanes,
    /// How many of a tier's patches begin below μ; 0 where none serves.
    patch: Lanes,
}

/// Points whose accumulators stay in registers.
const BLOCK: usize = 32;

/// Evaluates S at the points of [`Method::Uniform`], of which it may make points of [`Method::Series`], or of
/// [`Method::Auto`] beyond the domain; what it leaves at the other points says nothing.
#[inline(always)]
pub(super) fn evaluate(tier: &Tier, g: &[f64], x: &[f64], batch: &mut Batch) {
    let count = g.len().min(x.len()).min(LANES);
    let zero = [0.0; LANES];
    let mut saddles = Saddles { mu: zero, inverse_mu: zero, t: zero, patch: zero };
    for place in 0..count {
        let (mu, t, form) = leading_term(g[place], x[place]);
        saddles.mu[place] = mu;
        saddles.inverse_mu[place] = 1.0 / mu;
        saddles.t[place] = t;
        batch.set(place, &form);
    }
    for patch in tier.patches {
        for place in 0..count {
            saddles.patch[place] += if saddles.mu[place] >= patch.mu_from { 1.0 } else { 0.0 };
        }
    }
    for place in 0..count {
        let serves = saddles.mu[place] * saddles.t[place] >= tier.variance_from;
        saddles.patch[place] = if serves { saddles.patch[place] } else { 0.0 };
    }
    let asked = |batch: &Batch, place: usize| batch.method[place] == Method::Uniform;
    let mut few = Places::none();
    for place in 0..count {
        if saddles.patch[place] == 0.0 && asked(batch, place) {
            few.push(place);
            batch.method[place] = Method::Series;
        }
    }
    for (patch, number) in tier.patches.iter().zip(1u8..) {
        let mut places = Places::none();
        for place in 0..count {
            if saddles.patch[place] == f64::from(number) && asked(batch, place) {
                places.push(place);
            }
        }
        for places in places.all().chunks(BLOCK) {
            correct(patch, places, &saddles, batch);
        }
    }
    direct::evaluate(tier, &few, g, x, &saddles.mu, batch);
    for place in 0..count {
        // The rounding of the exponent, and with it the conditions, are bounded below this size only.
        let is_bounded = batch.exponent[place].abs() < 1e15;
        if !is_bounded {
            batch.method[place] = Method::Auto;
        }
    }
}

/// μ, 1/w and e^ψ/(μ √w) with the conditions of S.
#[inline(always)]
fn leading_term(g: f64, x: f64) -> (f64, f64, Form) {
    let u = 0.5 * lambert_w(2.0 * (x / g) / g);
    let growth = exp(u);
    let mu = g * growth.value();
    let less_one = growth.minus_one();
    let t = 1.0 / (1.0 + 2.0 * u);
    // ψ = g (e^u (1 − u) − 1) − x/μ is stationary in u: what W lacks in digits enters squared.
    let steepness = x / mu;
    let psi = exp(g * (less_one * (1.0 - u) - u) - steepness);
    let form = Form {
        significand: psi.significand / mu * t.sqrt(),
        exponent: psi.exponent,
        truncation: 0.0,
        condition_g: (g * less_one - t + 2.0 * u * (t * t)).abs(),
        condition_x: steepness + u * t + u * (t * t),
    };
    (mu, t, form)
}

/// W₀(z) for 0 ≤ z ≤ 1e250 to 1e-10, relative.
#[inline(always)]
fn lambert_w(z: f64) -> f64 {
    let logarithm = ln_1p_roughly(z);
    // Within 3 %.
    let mut w = logarithm * (1.0 - ln_1p_roughly(logarithm) / (2.0 + logarithm));
    // Halley's step for w − z e^{−w} cubes the error.
    for _ in 0..2 {
        let v = z * exp(-w).value();
        let (difference, slope) = (w - v, 1.0 + v);
        w -= difference * slope / (slope * slope + 0.5 * difference * v);
    }
    w
}

/// Multiplies by R.
#[inline(always)]
fn correct(patch: &Patch, places: &[u8], saddles: &Saddles, batch: &mut Batch) {
    let (mut p, mut q) = ([0.0; BLOCK], [0.0; BLOCK]);
    for ((p, q), &place) in p.iter_mut().zip(&mut q).zip(places) {
        *p = saddles.inverse_mu[usize::from(place)];
        *q = saddles.t[usize::from(place)];
    }
    for (p, q) in p.iter_mut().zip(&mut q) {
        *p = *p * patch.p_scale + patch.p_shift;
        *q = *q * patch.q_scale + patch.q_shift;
    }
    let mut r = [0.0; BLOCK];
    for row in patch.rows.iter().rev() {
        let mut of_row = [0.0; BLOCK];
        for &coefficient in row.iter().rev() {
            for (sum, &q) in of_row.iter_mut().zip(&q) {
                *sum = *sum * q + coefficient;
            }
        }
        for ((r, &p), &of_row) in r.iter_mut().zip(&p).zip(&of_row) {
            *r = *r * p + of_row;
        }
    }
    for (&r, &place) in r.iter().zip(places) {
        batch.significand[usize::from(place)] *= r;
        batch.truncation[usize::from(place)] = patch.error;
    }
}
