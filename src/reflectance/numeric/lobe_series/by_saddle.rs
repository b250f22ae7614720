//! The points of a batch that need the saddle: its position by Lambert's W, then R by a polynomial
//! patch where the sum equals its integral, the sum itself where few terms matter.

use super::direct;
use super::lanes::{Batch, Form, Forms, LANES, Lanes, Places};
use super::patches::{Patch, Tier};
use super::Method;
use crate::reflectance::numeric::elementary::{exp, ln_1p_roughly};

/// The saddles of a batch's points.
struct Saddles {
    /// 1/μ
    inverse_mu: Lanes,
    mu: Lanes,
    /// 1/w
    t: Lanes,
    form: Forms,
}

/// Evaluates S at some of the points.
#[inline(always)]
pub(super) fn evaluate(tier: &Tier, places: &Places, g: &[f64], x: &[f64], batch: &mut Batch) {
    let (mut g_there, mut x_there) = ([0.0; LANES], [0.0; LANES]);
    let (g, x) = (places.gather(g, &mut g_there), places.gather(x, &mut x_there));
    let mut saddles =
        Saddles { inverse_mu: [0.0; LANES], mu: [0.0; LANES], t: [0.0; LANES], form: Forms::new() };
    for (place, (&g, &x)) in g.iter().zip(x).enumerate() {
        let (mu, t, form) = leading_term(g, x);
        saddles.mu[place] = mu;
        saddles.inverse_mu[place] = 1.0 / mu;
        saddles.t[place] = t;
        saddles.form.set(place, &form);
    }
    let mut few = Places::none();
    let mut patched = [const { Places::none() }; MOST_PATCHES];
    for place in 0..g.len() {
        let mu = saddles.mu[place];
        let number = tier.patches.iter().filter(|patch| mu >= patch.mu_from).count();
        if number == 0 || mu * saddles.t[place] < tier.variance_from {
            few.push(place);
        } else {
            patched[number - 1].push(place);
        }
    }
    for (patch, of_patch) in tier.patches.iter().zip(&patched) {
        if of_patch.count > 0 {
            correct(patch, of_patch, &mut saddles);
        }
    }
    if few.count > 0 {
        direct::evaluate(tier, &few, g, x, &saddles.mu, &mut saddles.form);
    }
    saddles.form.scatter(places, Method::Uniform, batch);
    for &place in few.all() {
        batch.method[usize::from(places.all()[usize::from(place)])] = Method::Series;
    }
    for (place, &there) in places.all().iter().enumerate() {
        // The exponent's own rounding, and with it the conditions, are bounded below this size only.
        if !(saddles.form.exponent[place].abs() < 1e15) {
            batch.method[usize::from(there)] = Method::Auto;
        }
    }
}

/// Patches of one tier at most.
pub(super) const MOST_PATCHES: usize = 10;

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
fn correct(patch: &Patch, places: &Places, saddles: &mut Saddles) {
    /// Points whose accumulators stay in registers.
    const BLOCK: usize = 32;
    for places in places.all().chunks(BLOCK) {
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
            saddles.form.significand[usize::from(place)] *= r;
            saddles.form.truncation[usize::from(place)] = patch.error;
        }
    }
}
