//! Every patch against the sum, and that the patches of a tier leave no gap.

use super::{ALL, FIRST_KEY, KEY_SHIFT, KEYS, MOST_PATCHES, Patch, Tier};
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::lobe_series::series::{deviance, stirling_remainder};

/// R as the sum relative to its leading term: its exponents vanish at the saddle, so nothing cancels.
fn ratio(mu: f64, w: f64) -> f64 {
    let deviation = (mu / w).sqrt();
    let first = (mu - 10.0 * deviation).floor().max(1.0);
    let last = (mu + 12.0 * deviation + 12.0).ceil();
    let (mut m, mut sum) = (first, 0.0);
    while m <= last {
        let exponent = deviance(m, mu) + (w - 1.0) * (m - mu) * (m - mu) / (2.0 * m) + stirling_remainder(m);
        sum += libm::exp(-exponent) * (mu / m) * (mu / m).sqrt();
        m += 1.0;
    }
    sum * (w / (2.0 * core::f64::consts::PI * mu)).sqrt()
}

/// What doubles make of a patch.
fn horner(patch: &Patch, mu: f64, w: f64) -> f64 {
    let p = patch.p_scale / mu + patch.p_shift;
    let q = patch.q_scale / (w + patch.w_shift) + patch.q_shift;
    patch
        .rows
        .iter()
        .rev()
        .fold(0.0, |sum, row| sum * p + row.iter().rev().fold(0.0, |sum, coefficient| sum * q + coefficient))
}

/// Of the polynomial, 5 ε measured, and of the sum: the mean exponent is a half, so a term is good to about 4 ε, and
/// each addition rounds while the sum is near its value, for some 5 standard deviations.
fn rounding(mu: f64, w: f64) -> f64 {
    (16.0 + 5.0 * (mu / w).sqrt()) * EPSILON
}

fn patches(tier: &Tier) -> impl Iterator<Item = (usize, &'static Patch)> {
    (0..MOST_PATCHES).filter_map(|number| Some((number, tier.patch(number)?)))
}

/// Points of a patch, its edges and corners among them; μ up to 2000, beyond which the sum is long.
fn points(patch: &'static Patch) -> impl Iterator<Item = (f64, f64)> {
    const STEPS: u32 = 24;
    let part = |from: f64, to: f64, step: u32| from + (to - from) * f64::from(step) / f64::from(STEPS);
    let most = patch.mu_to.min((2.0 * patch.mu_from).max(2000.0));
    (0..=STEPS).flat_map(move |i| {
        let mu = 1.0 / part(1.0 / patch.mu_from, 1.0 / most, i);
        let widest = patch.w_to.min(mu / patch.variance_from).max(patch.w_from);
        (0..=STEPS).map(move |k| (mu, 1.0 / part(1.0 / patch.w_from, 1.0 / widest, k)))
    })
}

#[test]
fn every_patch_is_within_its_error() {
    for tier in ALL {
        for (_, patch) in patches(tier) {
            for (mu, w) in points(patch) {
                let error = (horner(patch, mu, w) / ratio(mu, w) - 1.0).abs();
                assert!(
                    error <= patch.error + rounding(mu, w),
                    "mu {mu}, w {w}: {error:e} of {:e}",
                    patch.error
                );
            }
        }
    }
}

#[test]
fn a_patch_is_found_at_its_points_and_no_other() {
    for tier in ALL {
        for (number, patch) in patches(tier) {
            // Off the edges, where the neighbour serves as well.
            for (mu, w) in points(patch) {
                let (mu, w) =
                    (mu * 0.999 + 0.001 * (1.5 * patch.mu_from).min(patch.mu_to), w.max(patch.w_from + 1e-9));
                let inside = mu < patch.mu_to && w < patch.w_to && mu >= patch.variance_from * w;
                if inside && mu > patch.mu_from {
                    assert_eq!(tier.number_at(mu, w), Some(number), "mu {mu}, w {w}");
                }
            }
            assert_ne!(tier.number_at(patch.mu_from.next_down(), patch.w_from), Some(number));
        }
    }
}

#[test]
fn bands_join_up_to_infinity() {
    for tier in ALL {
        let least = patches(tier).map(|(_, patch)| patch.mu_from).fold(f64::INFINITY, f64::min);
        let edges = (FIRST_KEY..).take(KEYS).map(|key| f64::from_bits(key << KEY_SHIFT));
        for edge in edges.chain([1e6, 1e12, 1e300]) {
            for mu in [edge.next_down(), edge, edge.next_up(), 1.1 * edge] {
                assert_eq!(tier.number_at(mu, 1.0).is_some(), mu >= least, "mu {mu}");
            }
        }
        for outside in [(f64::NAN, 1.0), (least, f64::NAN), (0.0, 1.0), (1e9, 1e10)] {
            assert_eq!(tier.number_at(outside.0, outside.1), None, "{outside:?}");
        }
    }
}
