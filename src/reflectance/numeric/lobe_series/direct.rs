//! The sum itself in vector lanes, for the points of a batch where few terms matter.

use super::lanes::{Batch, LANES, Lanes, Places};
use super::patches::Tier;
use super::series::stirling_remainder;
use crate::reflectance::numeric::elementary::{exp, ln};

/// Points that walk through their terms together: as long as the one with the most terms.
const BLOCK: usize = 32;
/// One number a point of the block.
type Block = [f64; BLOCK];

/// Σ t_m/t_c with its moments, and the walk through the terms.
struct Walk {
    g: Block,
    x: Block,
    centre: Block,
    sum: Block,
    /// Σ (m − g) t
    first: Block,
    /// Σ t/m
    inverse: Block,
    m: Block,
    term: Block,
}

/// Sums around the largest term, near `mu`, until what is left out of either side is below a quarter of the
/// truncation.
#[inline(always)]
pub(super) fn evaluate(tier: &Tier, places: &Places, g: &[f64], x: &[f64], mu: &Lanes, batch: &mut Batch) {
    for places in places.all().chunks(BLOCK) {
        let mut walk = Walk::new();
        for (lane, &place) in places.iter().enumerate() {
            let place = usize::from(place);
            walk.g[lane] = g[place];
            walk.x[lane] = x[place];
            walk.centre[lane] = mu[place].round().max(1.0);
        }
        let enough = 0.25 * tier.truncation;
        walk.start();
        while walk.up() > enough {}
        walk.turn();
        while walk.down() > enough {}
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
}

impl Walk {
    /// Lanes without a point walk through g = 1, x = 0.
    const fn new() -> Self {
        let (zero, one) = ([0.0; BLOCK], [1.0; BLOCK]);
        Self { g: one, x: zero, centre: one, sum: one, first: zero, inverse: zero, m: one, term: one }
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
    }

    /// One term up in every lane; the largest share of a sum that is still above its last term: the terms are
    /// log-concave, so what is left of a side is below t r/(1 − r), r the last ratio.
    #[inline(always)]
    fn up(&mut self) -> f64 {
        let mut left = [0.0; BLOCK];
        for lane in 0..BLOCK {
            let (g, m) = (self.g[lane], self.m[lane]);
            let inverse = 1.0 / (m * (m + 1.0));
            let next_inverse = m * inverse;
            // Next to the largest term the tilt makes up for m/g; 700 keeps what does not matter in range.
            let tilt = exp((self.x[lane] * inverse).min(700.0)).value();
            let ratio = g * tilt * (m * next_inverse * next_inverse);
            left[lane] = self.add(lane, m + 1.0, next_inverse, ratio);
        }
        largest(&left)
    }

    /// One term down in every lane that has one.
    #[inline(always)]
    fn down(&mut self) -> f64 {
        let mut left = [0.0; BLOCK];
        for lane in 0..BLOCK {
            let (g, m) = (self.g[lane], self.m[lane]);
            let below = (m - 1.0).max(1.0);
            let below_inverse = 1.0 / below;
            let tilt = exp((-self.x[lane] * below_inverse / m).max(-700.0)).value();
            let ratio = if m > 1.0 { m * m * below_inverse / g * tilt } else { 0.0 };
            left[lane] = self.add(lane, below, below_inverse, ratio);
        }
        largest(&left)
    }

    #[inline(always)]
    fn add(&mut self, lane: usize, m: f64, inverse: f64, ratio: f64) -> f64 {
        let term = self.term[lane] * ratio;
        self.m[lane] = m;
        self.term[lane] = term;
        self.sum[lane] += term;
        self.first[lane] += (m - self.g[lane]) * term;
        self.inverse[lane] += term * inverse;
        let left = term * ratio / (self.sum[lane] * (1.0 - ratio));
        if ratio < 1.0 { left } else { f64::MAX }
    }
}

#[inline(always)]
fn largest(of: &Block) -> f64 {
    let mut largest = 0.0;
    for &value in of {
        largest = if value > largest { value } else { largest };
    }
    largest
}

/// m ln(m/g) − m + g without cancellation: Loader's expansion in v = (m − g)/(m + g) near m = g.
#[inline(always)]
fn deviance(m: f64, g: f64) -> f64 {
    let (difference, sum) = (m - g, m + g);
    let v = difference / sum;
    let v2 = v * v;
    // |v| < 0.1: the first power left out, v^17/17, is below 1e-18 of the first.
    let tail = v2
        * (1.0 / 3.0
            + v2 * (1.0 / 5.0
                + v2 * (1.0 / 7.0
                    + v2 * (1.0 / 9.0 + v2 * (1.0 / 11.0 + v2 * (1.0 / 13.0 + v2 * (1.0 / 15.0)))))));
    let near = difference * v + 2.0 * m * v * tail;
    let far = m * ln(m / g) - difference;
    if v2 < 0.01 { near } else { far }
}

const _: () = assert!(LANES.is_multiple_of(BLOCK), "whole blocks");
