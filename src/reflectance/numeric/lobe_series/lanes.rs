//! S at many points at once: each is sorted to the cheapest method that keeps the truncation asked
//! for, and each method's points are evaluated in vector lanes.
//!
//! Which method serves depends on g, x and the truncation alone, never on the neighbours, so a point has
//! one value whatever batch it comes in.

#[cfg(test)]
mod tests;

use super::patches::{self, Tier};
use super::{LobeSeries, Method, by_saddle, rough, single_term};
use crate::reflectance::numeric::dispatch::vectorized;
use crate::reflectance::numeric::elementary::exp;
use crate::reflectance::numeric::scaled::Scaled;

/// Points in one batch: what the method needs of them stays in the processor's first cache.
pub const LANES: usize = 128;

/// One number a point.
pub type Lanes = [f64; LANES];

/// S at up to [`LANES`] points: value, and what its bound is made of.
#[derive(Clone, Debug)]
pub struct Batch {
    /// S · 2^−`exponent`.
    pub significand: Lanes,
    /// A whole number.
    pub exponent: Lanes,
    /// Bound of the relative truncation error.
    pub truncation: Lanes,
    /// |∂ ln S/∂ ln g|
    pub condition_g: Lanes,
    /// |∂ ln S/∂ ln x|
    pub condition_x: Lanes,
    /// What made the value; [`Method::Auto`] where the point is outside the domain of this file and the rest says
    /// nothing.
    pub method: [Method; LANES],
}

/// One point's value with what its bound is made of.
pub(super) struct Form {
    pub(super) significand: f64,
    pub(super) exponent: f64,
    pub(super) truncation: f64,
    pub(super) condition_g: f64,
    pub(super) condition_x: f64,
}

impl Default for Batch {
    fn default() -> Self {
        Self::new()
    }
}

impl Batch {
    /// Room for a batch.
    pub const fn new() -> Self {
        let zero = [0.0; LANES];
        Self {
            significand: zero,
            exponent: zero,
            truncation: zero,
            condition_g: zero,
            condition_x: zero,
            method: [Method::Auto; LANES],
        }
    }

    /// S at one point; none outside the domain.
    pub fn get(&self, place: usize) -> Option<LobeSeries> {
        let method = self.method[place];
        let (condition_g, condition_x) = (self.condition_g[place], self.condition_x[place]);
        let value = Scaled::of_parts(self.significand[place], self.exponent[place]);
        let truncation = self.truncation[place] * (1.0 + self.truncation[place]);
        (method != Method::Auto)
            .then(|| LobeSeries::converged(value, truncation, condition_g, condition_x, method))
    }

    #[inline(always)]
    pub(super) fn set(&mut self, place: usize, form: &Form) {
        self.significand[place] = form.significand;
        self.exponent[place] = form.exponent;
        self.truncation[place] = form.truncation;
        self.condition_g[place] = form.condition_g;
        self.condition_x[place] = form.condition_x;
    }
}

/// What a batch may be evaluated by.
#[derive(Clone, Copy, Debug)]
pub struct Choice<'a> {
    pub(super) tier: &'a Tier,
    pub(super) uniform_only: bool,
}

impl<'a> Choice<'a> {
    /// The cheapest method whose truncation is `tier`'s at most.
    pub const fn auto(tier: &'a Tier) -> Self {
        Self { tier, uniform_only: false }
    }
}

impl Choice<'static> {
    /// The patches of the finest tier; other points are left.
    pub const fn uniform() -> Self {
        Self { tier: &patches::FULL, uniform_only: true }
    }
}

vectorized! {
    /// S at the points (`g`, `x`), equally many of each and at most [`LANES`].
    ///
    /// Domain of the vector path: 1e-140 ≤ g ≤ 1e140 and 2x/g² ≤ 1e250, |ln S| < 1e15.
    pub fn evaluate = sorted, (choice: Choice<'_>, g: &[f64], x: &[f64], batch: &mut Batch)
}

/// Positions of some of a batch's points.
pub(super) struct Places {
    count: usize,
    at: [u8; LANES],
}

impl Places {
    pub(super) const fn none() -> Self {
        Self { count: 0, at: [0; LANES] }
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "below LANES")]
    pub(super) fn push(&mut self, place: usize) {
        self.at[self.count] = place as u8;
        self.count += 1;
    }

    #[inline(always)]
    pub(super) fn all(&self) -> &[u8] {
        &self.at[..self.count]
    }
}

#[inline(always)]
fn sorted(choice: Choice<'_>, g: &[f64], x: &[f64], batch: &mut Batch) {
    let Choice { tier, uniform_only } = choice;
    // Without other methods no truncation is enough for them.
    let others = if uniform_only { -1.0 } else { tier.truncation };
    let count = g.len().min(x.len()).min(LANES);
    let (g, x) = (&g[..count], &x[..count]);
    // Whether a point may be something else than one for the saddle; most batches have none.
    let mut special = 0.0;
    for place in 0..count {
        let (g, x) = (g[place], x[place]);
        let ordinary = (1e-140..=1e140).contains(&g)
            && 2.0 * (x / g) / g <= 1e250
            && 0.25 * g > others
            && rough::bound(g, x) > others;
        special = if ordinary { special } else { 1.0 };
    }
    batch.method[..count].fill(Method::Uniform);
    if special == 0.0 {
        by_saddle::evaluate(choice, g, x, batch);
        return;
    }
    let (mut first_places, mut rough_places, mut rest) = (Places::none(), Places::none(), Places::none());
    for place in 0..count {
        let (g, x) = (g[place], x[place]);
        if !(1e-140..=1e140).contains(&g) || 2.0 * (x / g) / g > 1e250 {
            batch.method[place] = Method::Auto;
        } else if 0.25 * g <= others
            && single_term::rest_to_first(single_term::second_to_first(g, x)) <= others
        {
            first_places.push(place);
        } else if rough::bound(g, x) <= others {
            rough_places.push(place);
        } else {
            rest.push(place);
        }
    }
    let forms = |form: fn(f64, f64) -> Form, method: Method| {
        move |g: &[f64], x: &[f64], batch: &mut Batch| {
            for place in 0..g.len().min(x.len()).min(LANES) {
                batch.set(place, &form(g[place], x[place]));
                batch.method[place] = method;
            }
        }
    };
    elsewhere(&first_places, g, x, batch, forms(first_term, Method::Smooth));
    elsewhere(&rough_places, g, x, batch, forms(rough_form, Method::Rough));
    elsewhere(&rest, g, x, batch, |g, x, batch| {
        batch.method[..g.len()].fill(Method::Uniform);
        by_saddle::evaluate(choice, g, x, batch);
    });
}

/// Evaluates some of a batch's points in a batch of their own.
#[inline(always)]
fn elsewhere(
    places: &Places,
    g: &[f64],
    x: &[f64],
    batch: &mut Batch,
    evaluate: impl Fn(&[f64], &[f64], &mut Batch),
) {
    if places.count == 0 {
        return;
    }
    let (mut g_there, mut x_there) = ([0.0; LANES], [0.0; LANES]);
    for ((g_there, x_there), &place) in g_there.iter_mut().zip(&mut x_there).zip(places.all()) {
        *g_there = g[usize::from(place)];
        *x_there = x[usize::from(place)];
    }
    let mut there = Batch::new();
    evaluate(&g_there[..places.count], &x_there[..places.count], &mut there);
    for (from, &to) in places.all().iter().enumerate() {
        let to = usize::from(to);
        batch.significand[to] = there.significand[from];
        batch.exponent[to] = there.exponent[from];
        batch.truncation[to] = there.truncation[from];
        batch.condition_g[to] = there.condition_g[from];
        batch.condition_x[to] = there.condition_x[from];
        batch.method[to] = there.method[from];
    }
}

/// g e^{−(g + x)}, (48), where the second term is negligible.
#[inline(always)]
fn first_term(g: f64, x: f64) -> Form {
    let e = exp(-(g + x));
    // The second term is below 4 times the truncation asked for, so x is below 2 ln(4/g): no overflow.
    let ratio = 0.25 * g * exp(0.5 * x).value();
    Form {
        significand: e.significand * g,
        exponent: e.exponent,
        truncation: single_term::rest_to_first(ratio),
        condition_g: 2.0 + g,
        condition_x: x,
    }
}

/// e^{−y}/g, (49), y = x/g.
#[inline(always)]
fn rough_form(g: f64, x: f64) -> Form {
    let y = x / g;
    let e = exp(-y);
    Form {
        significand: e.significand / g,
        exponent: e.exponent,
        truncation: rough::bound(g, x),
        condition_g: 1.0 + y,
        condition_x: y,
    }
}
