//! The points of a batch that need the saddle: its position by Lambert's W, then R by a polynomial
//! patch where the sum equals its integral, the sum itself where few terms matter.

use super::lanes::{Batch, Choice, Form, LANES, Lanes, Places};
use super::patches::{MOST_PATCHES, Patch, Tier};
use super::{Method, direct};
use crate::reflectance::numeric::elementary::{exp, ln_1p_roughly};
use core::ops::Range;

/// Evaluates S at the points of [`Method::Uniform`], of which it may make points of [`Method::Series`], or of
/// [`Method::Auto`] beyond what it may do; what it leaves at the other points says nothing.
#[inline(always)]
pub(super) fn evaluate(choice: Choice<'_>, g: &[f64], x: &[f64], batch: &mut Batch) {
    let Choice { tier, uniform_only } = choice;
    let count = g.len().min(x.len()).min(LANES);
    let (mut mu, mut w) = ([0.0; LANES], [0.0; LANES]);
    for place in 0..count {
        let (at_mu, at_w, form) = leading_term(g[place], x[place]);
        mu[place] = at_mu;
        w[place] = at_w;
        batch.set(place, &form);
    }
    if let Some(patch) = common_patch(tier, &mu[..count], &w[..count], &batch.exponent[..count]) {
        for start in (0..count).step_by(2 * BLOCK) {
            let end = count.min(start + 2 * BLOCK);
            correct_run(patch, start..end, &mu, &w, batch);
        }
        return;
    }
    let mut few = Places::none();
    let mut patched = Sorted::new();
    for place in 0..count {
        if batch.method[place] != Method::Uniform {
            continue;
        }
        match tier.number_at(mu[place], w[place]) {
            _ if !is_bounded(batch.exponent[place]) => batch.method[place] = Method::Auto,
            Some(number) => patched.add(place, number),
            None if uniform_only => batch.method[place] = Method::Auto,
            None => {
                few.push(place);
                batch.method[place] = Method::Series;
            }
        }
    }
    let places = patched.places();
    for (number, range) in patched.ranges() {
        let Some(patch) = tier.patch(number) else { continue };
        for places in places[range].chunks(2 * BLOCK) {
            if places.len() > BLOCK {
                correct::<{ 2 * BLOCK }>(patch, places, &mu, &w, batch);
            } else {
                correct::<BLOCK>(patch, places, &mu, &w, batch);
            }
        }
    }
    direct::evaluate(tier, &few, g, x, &mu, batch);
}

/// The rounding of the exponent, and with it the conditions, are bounded below this size only.
#[inline(always)]
fn is_bounded(exponent: f64) -> bool {
    exponent.abs() < 1e15
}

/// The patch that serves at all of the points, if one does: patches are convex in μ and w.
#[inline(always)]
fn common_patch(tier: &Tier, mu: &[f64], w: &[f64], exponent: &[f64]) -> Option<&'static Patch> {
    // Positive doubles are ordered like their bits, whose extremes are found in vector lanes.
    let (mut least, mut most) = ([u64::MAX; 2], [0; 2]);
    let mut bounded = true;
    for ((&mu, &w), &exponent) in mu.iter().zip(w).zip(exponent) {
        least = [least[0].min(mu.to_bits()), least[1].min(w.to_bits())];
        most = [most[0].max(mu.to_bits()), most[1].max(w.to_bits())];
        bounded &= is_bounded(exponent);
    }
    let (least, most) = (least.map(f64::from_bits), most.map(f64::from_bits));
    let number = tier.number_at(least[0], least[1]).filter(|_| bounded)?;
    let others = [(least[0], most[1]), (most[0], least[1]), (most[0], most[1])];
    let common = others.into_iter().all(|(mu, w)| tier.number_at(mu, w) == Some(number));
    if common { tier.patch(number) } else { None }
}

/// The least number of points that a patch is evaluated at together. Twice as many still have their
/// accumulators in registers.
const BLOCK: usize = 16;

/// Places by the number of their patch.
struct Sorted {
    numbers: [u8; LANES],
    counts: [usize; MOST_PATCHES],
}

impl Sorted {
    const fn new() -> Self {
        Self { numbers: [u8::MAX; LANES], counts: [0; MOST_PATCHES] }
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "below MOST_PATCHES")]
    fn add(&mut self, place: usize, number: usize) {
        self.numbers[place] = number as u8;
        self.counts[number] += 1;
    }

    /// Those of each patch that has some.
    #[inline(always)]
    fn ranges(&self) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        let ranges = self.counts.iter().scan(0, |end, &count| {
            let start = *end;
            *end += count;
            Some(start..*end)
        });
        ranges.enumerate().filter(|(_, range)| !range.is_empty())
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "below LANES")]
    fn places(&self) -> [u8; LANES] {
        let mut next = [0; MOST_PATCHES];
        for (number, range) in self.ranges() {
            next[number] = range.start;
        }
        let mut places = [0; LANES];
        for (place, &number) in self.numbers.iter().enumerate() {
            if let Some(next) = next.get_mut(usize::from(number)) {
                places[*next] = place as u8;
                *next += 1;
            }
        }
        places
    }
}

/// μ, w and e^ψ/(μ √w) with the conditions of S.
#[inline(always)]
fn leading_term(g: f64, x: f64) -> (f64, f64, Form) {
    let z = 2.0 * (x / g) / g;
    let near = halley(lambert_w_roughly(z), |w| z * exp(-w).value());
    // The last step needs no exponential of its own: e^u is wanted anyway, and follows the step to third order.
    let growth = exp(0.5 * near);
    let grown = growth.value();
    let lambert_w = halley(near, |_| z / (grown * grown));
    let u = 0.5 * lambert_w;
    let step = 0.5 * (lambert_w - near);
    let step_less_one = step + 0.5 * step * step;
    let mu = g * (grown + grown * step_less_one);
    let less_one = growth.minus_one() + grown * step_less_one;
    let w = 1.0 + 2.0 * u;
    // One quotient for both.
    let both = 1.0 / (w * mu);
    let (t, inverse_mu) = (both * mu, both * w);
    // ψ = g (e^u (1 − u) − 1) − x/μ is stationary in u.
    let steepness = x * inverse_mu;
    let psi = exp(g * (less_one * (1.0 - u) - u) - steepness);
    let form = Form {
        significand: psi.significand * inverse_mu * t.sqrt(),
        exponent: psi.exponent,
        truncation: 0.0,
        condition_g: (g * less_one - t + 2.0 * u * (t * t)).abs(),
        condition_x: steepness + u * t + u * (t * t),
    };
    (mu, w, form)
}

/// W₀(z) for 0 ≤ z ≤ 1e250, within 3 %, or 2 ε for tiny z.
#[inline(always)]
fn lambert_w_roughly(z: f64) -> f64 {
    let logarithm = ln_1p_roughly(z);
    logarithm * (1.0 - ln_1p_roughly(logarithm) / (2.0 + logarithm))
}

/// Halley's step for w − z e^{−w}, which cubes the error: after the first it is below 3e-6, relative.
#[inline(always)]
fn halley(w: f64, right_side: impl Fn(f64) -> f64) -> f64 {
    let v = right_side(w);
    let (difference, slope) = (w - v, 1.0 + v);
    w - difference * slope / (slope * slope + 0.5 * difference * v)
}

/// Multiplies by R at up to `COUNT` places.
#[inline(always)]
fn correct<const COUNT: usize>(patch: &Patch, places: &[u8], mu: &Lanes, w: &Lanes, batch: &mut Batch) {
    let (mut mu_there, mut w_there) = ([1.0; COUNT], [1.0; COUNT]);
    for ((mu_there, w_there), &place) in mu_there.iter_mut().zip(&mut w_there).zip(places) {
        *mu_there = mu[usize::from(place)];
        *w_there = w[usize::from(place)];
    }
    let r = correction(patch, &mu_there, &w_there);
    for (&r, &place) in r.iter().zip(places) {
        batch.significand[usize::from(place)] *= r;
        batch.truncation[usize::from(place)] = patch.error;
    }
}

/// Multiplies by R at a run of places.
#[inline(always)]
fn correct_run(patch: &Patch, run: Range<usize>, mu: &Lanes, w: &Lanes, batch: &mut Batch) {
    let (mut mu_there, mut w_there) = ([1.0; 2 * BLOCK], [1.0; 2 * BLOCK]);
    mu_there[..run.len()].copy_from_slice(&mu[run.clone()]);
    w_there[..run.len()].copy_from_slice(&w[run.clone()]);
    let r = correction(patch, &mu_there, &w_there);
    for (significand, &r) in batch.significand[run.clone()].iter_mut().zip(&r) {
        *significand *= r;
    }
    batch.truncation[run].fill(patch.error);
}

/// R at each point.
#[inline(always)]
fn correction<const COUNT: usize>(patch: &Patch, mu: &[f64; COUNT], w: &[f64; COUNT]) -> [f64; COUNT] {
    let (mut p, mut q) = ([0.0; COUNT], [0.0; COUNT]);
    for place in 0..COUNT {
        p[place] = patch.p_scale / mu[place] + patch.p_shift;
        q[place] = patch.q_scale / (w[place] + patch.w_shift) + patch.q_shift;
    }
    let mut r = [0.0; COUNT];
    for row in patch.rows.iter().rev() {
        let mut of_row = [0.0; COUNT];
        for &coefficient in row.iter().rev() {
            for (sum, &q) in of_row.iter_mut().zip(&q) {
                *sum = *sum * q + coefficient;
            }
        }
        for ((r, &p), &of_row) in r.iter_mut().zip(&p).zip(&of_row) {
            *r = *r * p + of_row;
        }
    }
    r
}
