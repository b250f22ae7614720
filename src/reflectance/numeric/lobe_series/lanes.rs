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

/// Exponents from here on are left to the sum, which knows what their rounding does.
const LARGEST_EXPONENT: f64 = 1e14;

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
    /// Domain of the vector path: 1e-140 ≤ g ≤ 1e140, 2x/g² ≤ 1e250 and |log₂ S| < 1e15, by (49) x/g < 1e14.
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

/// What evaluates a point, as a lane holds it.
mod kind {
    /// The saddle, or the sum.
    pub(super) const SADDLE: f64 = 0.0;
    /// (49)
    pub(super) const ROUGH: f64 = 1.0;
    /// (48)
    pub(super) const FIRST: f64 = 2.0;
    /// Nothing of this file.
    pub(super) const LEFT: f64 = 3.0;
}

#[inline(always)]
fn sorted(choice: Choice<'_>, g: &[f64], x: &[f64], batch: &mut Batch) {
    let Choice { tier, uniform_only } = choice;
    // Without other methods no truncation is enough for them.
    let enough = if uniform_only { -1.0 } else { tier.truncation };
    let count = g.len().min(x.len()).min(LANES);
    let (g, x) = (&g[..count], &x[..count]);
    let mut kinds = [kind::SADDLE; LANES];
    for place in 0..count {
        kinds[place] = kind_of(enough, g[place], x[place]);
    }
    let mut is_smooth = false;
    for &g in g {
        // The second term is above g/4 of the first.
        is_smooth |= 0.25 * g <= enough;
    }
    if is_smooth {
        for place in 0..count {
            kinds[place] = or_first(kinds[place], enough, g[place], x[place]);
        }
    }
    let has = |kind: f64| {
        let mut has = false;
        for &of_place in &kinds[..count] {
            has |= of_place == kind;
        }
        has
    };
    let (has_rough, has_first) = (has(kind::ROUGH), has(kind::FIRST));
    batch.method[..count].fill(Method::Uniform);
    if has_rough || has_first || has(kind::LEFT) {
        for place in 0..count {
            batch.method[place] = match kinds[place] {
                kind::SADDLE => Method::Uniform,
                kind::ROUGH => Method::Rough,
                kind::FIRST => Method::Smooth,
                _ => Method::Auto,
            };
        }
    }
    if has(kind::SADDLE) {
        by_saddle::evaluate(choice, g, x, batch);
    }
    if has_rough {
        select(kind::ROUGH, rough_form, &kinds, g, x, batch);
    }
    if has_first {
        select(kind::FIRST, first_term, &kinds, g, x, batch);
    }
}

/// One of the kinds but the first term.
#[inline(always)]
fn kind_of(enough: f64, g: f64, x: f64) -> f64 {
    // No branches: every part is cheap, and a lane cannot skip any.
    let y = x / g;
    let is_inside = (1e-140..=1e140).contains(&g) & (2.0 * y / g <= 1e250);
    let is_rough = (rough::bound(g, x) <= enough) & (y < LARGEST_EXPONENT);
    let kind = if is_rough { kind::ROUGH } else { kind::SADDLE };
    if is_inside { kind } else { kind::LEFT }
}

/// The first term where it is enough.
#[inline(always)]
fn or_first(kind: f64, enough: f64, g: f64, x: f64) -> f64 {
    // An x so large leaves a second term that is not negligible for any g inside.
    let ratio = g * (0.25 * exp(0.5 * x.min(1400.0)).value());
    let is_first = (x < 1400.0) & (single_term::rest_to_first(ratio) <= enough) & (kind < kind::LEFT);
    if is_first { kind::FIRST } else { kind }
}

/// Evaluates `form` at the points of one kind.
#[inline(always)]
fn select(
    kind: f64,
    form: impl Fn(f64, f64) -> Form,
    kinds: &Lanes,
    g: &[f64],
    x: &[f64],
    batch: &mut Batch,
) {
    for place in 0..g.len().min(x.len()).min(LANES) {
        let form = form(g[place], x[place]);
        let is_meant = kinds[place] == kind;
        let selected = Form {
            significand: if is_meant { form.significand } else { batch.significand[place] },
            exponent: if is_meant { form.exponent } else { batch.exponent[place] },
            truncation: if is_meant { form.truncation } else { batch.truncation[place] },
            condition_g: if is_meant { form.condition_g } else { batch.condition_g[place] },
            condition_x: if is_meant { form.condition_x } else { batch.condition_x[place] },
        };
        batch.set(place, &selected);
    }
}

/// g e^{−(g + x)}, (48), where the second term is negligible.
#[inline(always)]
fn first_term(g: f64, x: f64) -> Form {
    let e = exp(-(g + x));
    let ratio = g * (0.25 * exp(0.5 * x.min(1400.0)).value());
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
