//! The sum itself in vector lanes, for the points of a batch where few terms matter.

use super::lanes::{Batch, Lanes, Places};
use super::patches::Tier;
use super::series::{deviance_near, stirling_remainder};
use crate::reflectance::numeric::elementary::{exp, ln};

/// Points that walk through their terms together: as long as the one with the most terms. A few points by
/// themselves would pay for lanes without a point.
const MANY: usize = 32;
const FEW: usize = 8;

/// Σ t_m/t_c with its moments, and the walk through the terms.
struct Walk<const BLOCK: usize> {
    g: [f64; BLOCK],
    x: [f64; BLOCK],
    centre: [f64; BLOCK],
    sum: [f64; BLOCK],
    /// Σ (m − g) t
    first: [f64; BLOCK],
    /// Σ t/m
    inverse: [f64; BLOCK],
    m: [f64; BLOCK],
    term: [f64; BLOCK],
    /// Bound of what is left of the side that is being walked, over the sum.
    left: [f64; BLOCK],
    /// A side with less left is done; its lane waits for the others.
    enough: f64,
}

/// Sums around the largest term, near `mu`, until what is left out of either side is below a quarter of the
/// truncation.
#[inline(always)]
pub(super) fn evaluate(tier: &Tier, places: &Places, g: &[f64], x: &[f64], mu: &Lanes, batch: &mut Batch) {
    for places in places.all().chunks(MANY) {
        if places.len() > FEW {
            sum::<MANY>(tier, places, g, x, mu, batch);
        } else {
            sum::<FEW>(tier, places, g, x, mu, batch);
        }
    }
}

/// The same at up to `BLOCK` places.
#[inline(always)]
fn sum<const BLOCK: usize>(tier: &Tier, places: &[u8], g: &[f64], x: &[f64], mu: &Lanes, batch: &mut Batch) {
    let mut walk = Walk::<BLOCK>::new(0.25 * tier.truncation);
    for (lane, &place) in places.iter().enumerate() {
        let place = usize::from(place);
        walk.g[lane] = g[place];
        walk.x[lane] = x[place];
        walk.centre[lane] = mu[place].round().max(1.0);
    }
    walk.start();
    while walk.up() {}
    walk.turn();
    while walk.down() {}
    let mut remainder = [0.0; BLOCK];
    for (remainder, &centre) in remainder.iter_mut().zip(&walk.centre) {
        *remainder = stirling_remainder(centre);
    }
    for lane in 0..BLOCK {
        let (g, x, m) = (walk.g[lane], walk.x[lane], walk.centre[lane]);
        let largest = exp(-(deviance(m, g) + (x / m + remainder[lane])));
        let root = (2.0 * core::f64::consts::PI * m).sqrt();
        walk.term[lane] = largest.significand / (m * root) * walk.sum[lane];
        walk.m[lane] = largest.exponent;
        walk.first[lane] = (walk.first[lane] / walk.sum[lane]).abs();
        walk.inverse[lane] = x * (walk.inverse[lane] / walk.sum[lane]);
    }
    for (lane, &place) in places.iter().enumerate() {
        let place = usize::from(place);
        batch.significand[place] = walk.term[lane];
        batch.exponent[place] = walk.m[lane];
        batch.condition_g[place] = walk.first[lane];
        batch.condition_x[place] = walk.inverse[lane];
        batch.truncation[place] = 0.5 * tier.truncation;
    }
}

impl<const BLOCK: usize> Walk<BLOCK> {
    /// Lanes without a point walk through g = 1, x = 0.
    const fn new(enough: f64) -> Self {
        let (zero, one) = ([0.0; BLOCK], [1.0; BLOCK]);
        Self {
            g: one,
            x: zero,
            centre: one,
            sum: one,
            first: zero,
            inverse: zero,
            m: one,
            term: one,
            left: zero,
            enough,
        }
    }

    #[inline(always)]
    fn start(&mut self) {
        for lane in 0..BLOCK {
            let m = self.centre[lane];
            self.first[lane] = m - self.g[lane];
            self.inverse[lane] = 1.0 / m;
        }
        self.turn();
    }

    /// Back to the largest term.
    #[inline(always)]
    fn turn(&mut self) {
        self.m = self.centre;
        self.term = [1.0; BLOCK];
        self.left = [f64::MAX; BLOCK];
    }

    /// One term up in every lane that is not done; whether there is one.
    #[inline(always)]
    fn up(&mut self) -> bool {
        for lane in 0..BLOCK {
            let (g, m) = (self.g[lane], self.m[lane]);
            let inverse = 1.0 / (m * (m + 1.0));
            let next_inverse = m * inverse;
            // Next to the largest term the tilt makes up for m/g; 700 keeps what does not matter in range.
            let tilt = exp((self.x[lane] * inverse).min(700.0)).value();
            let ratio = g * tilt * (m * next_inverse * next_inverse);
            self.add(lane, m + 1.0, next_inverse, ratio);
        }
        self.goes_on()
    }

    /// One term down in every lane that has one and is not done; whether there is one.
    #[inline(always)]
    fn down(&mut self) -> bool {
        for lane in 0..BLOCK {
            let (g, m) = (self.g[lane], self.m[lane]);
            let below = (m - 1.0).max(1.0);
            let below_inverse = 1.0 / below;
            let tilt = exp((-self.x[lane] * below_inverse / m).max(-700.0)).value();
            let ratio = if m > 1.0 { m * m * below_inverse / g * tilt } else { 0.0 };
            self.add(lane, below, below_inverse, ratio);
        }
        self.goes_on()
    }

    /// The terms are log-concave: what is left of a side is below t r/(1 − r), r the last ratio.
    #[inline(always)]
    fn add(&mut self, lane: usize, m: f64, inverse: f64, ratio: f64) {
        let ratio = if self.left[lane] > self.enough { ratio } else { 0.0 };
        let term = self.term[lane] * ratio;
        self.m[lane] = m;
        self.term[lane] = term;
        self.sum[lane] += term;
        self.first[lane] += (m - self.g[lane]) * term;
        self.inverse[lane] += term * inverse;
        let left = term * ratio / (self.sum[lane] * (1.0 - ratio));
        self.left[lane] = if ratio < 1.0 { left } else { f64::MAX };
    }

    #[inline(always)]
    fn goes_on(&self) -> bool {
        let mut most = 0.0;
        for &left in &self.left {
            most = if left > most { left } else { most };
        }
        most > self.enough
    }
}

/// m ln(m/g) − m + g without cancellation or branches.
#[inline(always)]
fn deviance(m: f64, g: f64) -> f64 {
    let (difference, sum) = (m - g, m + g);
    let v = difference / sum;
    let near = deviance_near(m, difference, v);
    let far = m * ln(m / g) - difference;
    if v * v < 0.01 { near } else { far }
}
