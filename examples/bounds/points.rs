//! Points (g, x) over the plane, most of them where a method ends or hands over to another.

use reflectance::reflectance::numeric::lobe_series::patches::{self, MOST_PATCHES};

/// `SplitMix64`: the points of a seed are the same everywhere.
pub(crate) struct Random(u64);

impl Random {
    /// A sequence of its own for every seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.share()
    }

    /// 10^exponent, the exponent uniform.
    fn decades(&mut self, from: f64, to: f64) -> f64 {
        10f64.powf(self.uniform(from, to))
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to below the length")]
    fn index(&mut self, length: usize) -> usize {
        (self.share() * length as f64) as usize
    }

    fn one_of(&mut self, values: &[f64]) -> f64 {
        values[self.index(values.len())]
    }

    /// One of `values`, or near it: as near as 1e-9, as far as a quarter.
    fn near(&mut self, values: &[f64]) -> f64 {
        let distance = self.decades(-9.0, -0.6);
        let side = if self.share() < 0.5 { 1.0 } else { -1.0 };
        self.one_of(values) * (1.0 + side * distance)
    }
}

/// Where the largest term moves from one way of summing to another.
const MU: [f64; 12] = [1.0, 4.0, 6.0, 8.0, 16.0, 32.0, 64.0, 128.0, 512.0, 4096.0, 16384.0, 1e10];
/// The same for the variance of the terms.
const VARIANCE: [f64; 8] = [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 8.0, 64.0];
/// Truncations that a tolerance allows.
const TRUNCATION: [f64; 8] = [4.4e-16, 2.5e-13, 2.5e-10, 2.5e-7, 2.5e-4, 2.5e-2, 0.1, 0.5];

/// One point of the domain, g and x from 0 or subnormal to 1e250.
pub(crate) fn point(random: &mut Random) -> (f64, f64) {
    loop {
        let (g, x) = candidate(random);
        if (0.0..=1e250).contains(&g) && (0.0..=1e250).contains(&x) {
            return (g, x);
        }
    }
}

fn candidate(random: &mut Random) -> (f64, f64) {
    match random.bits() % 14 {
        // The whole domain, and what surfaces are like.
        0 => (random.decades(-324.0, 250.0), random.decades(-324.0, 250.0)),
        1 | 2 => (random.decades(-6.0, 8.0), random.decades(-6.0, 10.0)),
        3 => (random.decades(-12.0, 12.0), random.one_of(&[0.0, 5e-324, 1e-300, 1e-16, 1e-8])),
        4 => at_saddle(random.near(&MU), width(random)),
        5 => {
            let variance = random.near(&VARIANCE);
            let mu = variance * (1.0 + random.decades(-6.0, 3.0));
            at_saddle(mu, mu / variance)
        }
        // The exponents leave the terms no digits from μ w = 1e14 on.
        6 => {
            let w = width(random);
            at_saddle(random.near(&[1e14]) / w, w)
        }
        // e^{-y}/g, and where y²/2g, the size of its error, is that of a tolerance.
        7 => {
            let g = random.decades(0.0, 10.0);
            let y = random.near(&[0.586, 1.0, 2.0, 3.414]);
            (g, g * y)
        }
        8 => {
            let y = random.decades(-3.0, 4.0);
            let g = (1.0 + y * (0.5 * y - 2.0)).abs() / random.near(&TRUNCATION);
            (g, g * y)
        }
        // The second term over the first.
        9 => {
            let g = random.decades(-300.0, 0.3);
            (g, 2.0 * (4.0 * random.near(&TRUNCATION) / g).ln())
        }
        // The end of 100 terms.
        10 | 11 => at_patch(random),
        12 => (random.uniform(40.0, 100.0), random.one_of(&[0.0, 1.0, 1e3]) * random.share()),
        _ => at_saddle(random.uniform(60.0, 130.0), width(random)),
    }
}

/// In one of the polynomials' patches or next to its edges.
fn at_patch(random: &mut Random) -> (f64, f64) {
    loop {
        let tier = patches::ALL[random.index(patches::ALL.len())];
        let Some(patch) = tier.patch(random.index(MOST_PATCHES)) else { continue };
        let far = patch.mu_to.min(1e6 * patch.mu_from);
        let inside = patch.mu_from * (far / patch.mu_from).powf(random.share());
        let mu = if random.share() < 0.5 { inside } else { random.near(&[patch.mu_from, far]) };
        let widest = patch.w_to.min(mu / patch.variance_from);
        let inside = patch.w_from + (widest - patch.w_from) * random.share();
        let w = if random.share() < 0.5 { inside } else { random.near(&[patch.w_from, widest]) };
        return at_saddle(mu, w.max(1.0));
    }
}

/// w = 1 + 2u: near 1, in the middle, large.
fn width(random: &mut Random) -> f64 {
    1.0 + random.decades(-12.0, 3.0)
}

/// g and x whose terms are largest at `mu`, with the variance `mu`/`w`.
fn at_saddle(mu: f64, w: f64) -> (f64, f64) {
    let u = 0.5 * (w - 1.0);
    (mu * (-u).exp(), mu * mu * u)
}
