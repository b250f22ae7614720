//! R(1/μ, 1/w) = S μ √w e^{−ψ}, what the leading saddle-point term lacks, as polynomials in two variables.
//!
//! A tier is a truncation error, and the polynomials of the fewest coefficients that keep it, each on a
//! patch of the plane. They are fitted to the sum itself: they hold its difference from the integral, which
//! near w = 1 is of the size e^{−μ} and elsewhere sets how small a variance of the terms may be.
//! `scripts/coefficients/lobe_series.py` makes the tables and says how they were measured.

use crate::reflectance::numeric::EPSILON;

mod e1;
mod e12_1;
mod e12_2;
mod e3;
mod e6;
mod e9_1;
mod e9_2;
mod full_1;
mod full_2;
mod full_3;
#[cfg(test)]
mod tests;

/// A polynomial Σⱼ pʲ Σᵢ rows\[j\]\[i\] qⁱ in p = `p_scale`/μ + `p_shift` and q = `q_scale`/(w + `w_shift`) +
/// `q_shift`, and where it is R: `mu_from` ≤ μ ≤ `mu_to`, `w_from` ≤ w ≤ `w_to` and μ/w ≥ `variance_from`.
#[derive(Debug)]
pub struct Patch {
    /// Least μ.
    pub mu_from: f64,
    /// Largest μ; may be infinite.
    pub mu_to: f64,
    /// Least w.
    pub w_from: f64,
    /// Largest w; may be infinite.
    pub w_to: f64,
    /// Least variance of the terms, μ/w; 0 where `w_to` is enough.
    pub variance_from: f64,
    /// p per 1/μ.
    pub p_scale: f64,
    /// p at 1/μ = 0.
    pub p_shift: f64,
    /// Its negative is the pole of q, below w = 1.
    pub w_shift: f64,
    /// q per 1/(w + `w_shift`).
    pub q_scale: f64,
    /// q at infinite w.
    pub q_shift: f64,
    /// Bound of the relative error, without the rounding of the evaluation.
    pub error: f64,
    /// Powers of q, lowest first, for every power of p, lowest first.
    pub rows: &'static [&'static [f64]],
}

/// Patches of one tier at most.
pub const MOST_PATCHES: usize = 32;
/// No patch.
const NONE: u8 = u8::MAX;
/// The bands of μ begin at numbers of two binary digits after the first: all that the search looks at.
const KEY_SHIFT: u32 = 50;
const LEAST_MU: f64 = 1.0;
const FIRST_KEY: u64 = LEAST_MU.to_bits() >> KEY_SHIFT;
const KEYS: usize = 64;

/// The patches of one truncation error.
#[derive(Debug)]
pub struct Tier {
    /// No patch's error is larger.
    pub truncation: f64,
    patches: [Option<&'static Patch>; MOST_PATCHES],
    /// By μ, with steps of at most a quarter: the patch that begins at w = 1, and the one after it.
    numbers: [[u8; 2]; KEYS],
}

impl Tier {
    /// Of patches in ascending order of μ, then w.
    const fn new(truncation: f64, parts: &[&'static [Patch]]) -> Self {
        let mut patches = [None; MOST_PATCHES];
        let mut numbers = [[NONE; 2]; KEYS];
        let (mut number, mut part) = (0, 0);
        while part < parts.len() {
            let mut place = 0;
            while place < parts[part].len() {
                let patch: &'static Patch = &parts[part][place];
                assert!(patch.error <= truncation);
                assert!(patch.mu_from >= LEAST_MU);
                assert!((patch.mu_from.to_bits() >> KEY_SHIFT) << KEY_SHIFT == patch.mu_from.to_bits());
                patches[number as usize] = Some(patch);
                let side = if patch.w_from == 1.0 { 0 } else { 1 };
                let mut key = 0;
                while key < KEYS {
                    let mu = f64::from_bits((FIRST_KEY + key as u64) << KEY_SHIFT);
                    if patch.mu_from <= mu && mu < patch.mu_to {
                        numbers[key][side] = number;
                    }
                    key += 1;
                }
                number += 1;
                place += 1;
            }
            part += 1;
        }
        Self { truncation, patches, numbers }
    }

    /// The patch that serves at μ and w; none where the sum has to.
    #[inline(always)]
    pub fn number_at(&self, mu: f64, w: f64) -> Option<usize> {
        if mu.is_nan() || mu < LEAST_MU {
            return None;
        }
        let key = ((mu.to_bits() >> KEY_SHIFT) - FIRST_KEY).min(KEYS as u64 - 1);
        #[expect(clippy::cast_possible_truncation, reason = "below KEYS")]
        let [near, far] = self.numbers[key as usize];
        let serves = |number: u8| {
            let patch = self.patch(usize::from(number))?;
            (w <= patch.w_to && mu >= patch.variance_from * w).then_some(usize::from(number))
        };
        serves(near).or_else(|| serves(far))
    }

    /// A patch by its number.
    #[inline(always)]
    pub fn patch(&self, number: usize) -> Option<&'static Patch> {
        self.patches.get(number).copied().flatten()
    }

    /// Whether it is the finest tier.
    pub fn is_full(&self) -> bool {
        self.truncation <= FULL.truncation
    }
}

/// 4 ε: what disappears in the rounding.
pub static FULL: Tier = Tier::new(4.0 * EPSILON, &[full_1::PATCHES, full_2::PATCHES, full_3::PATCHES]);
static E12: Tier = Tier::new(2.5e-13, &[e12_1::PATCHES, e12_2::PATCHES]);
static E9: Tier = Tier::new(2.5e-10, &[e9_1::PATCHES, e9_2::PATCHES]);
static E6: Tier = Tier::new(2.5e-7, &[e6::PATCHES]);
static E3: Tier = Tier::new(2.5e-4, &[e3::PATCHES]);
static E1: Tier = Tier::new(2.5e-2, &[e1::PATCHES]);

/// All tiers, from the loosest to the finest.
pub static ALL: [&Tier; 6] = [&E1, &E3, &E6, &E9, &E12, &FULL];

/// The cheapest tier whose truncation is at most a quarter of the tolerance; the finest if none is.
pub fn within(tolerance: f64) -> &'static Tier {
    ALL.into_iter().find(|tier| tier.truncation <= 0.25 * tolerance).unwrap_or(&FULL)
}
