//! The three components of section 5.1 in absolute units: how spike and lobe share the reflected energy.

use super::numeric::elementary::exp;
use core::f64::consts::PI;

/// g of (34) at the mirror direction, (4π σ_h cos θ_i/λ)², for σ_h and λ in one unit. Relative error below 8 ε and
/// twice that of the cosine.
#[inline(always)]
pub fn mirror_g(rms_height: f64, wavelength: f64, cos_i: f64) -> f64 {
    let phase = 4.0 * PI * (rms_height / wavelength) * cos_i;
    phase * phase
}

/// e^{−g}: the spike's share of the reflected energy. Relative error (1 + g) ε beside g's own.
pub fn spike_share(g: f64) -> f64 {
    libm::exp(-g)
}

/// 1 − e^{−g}: the share that the lobe carries, the total integrated scatter. Relative error below 4 ε and that of g.
#[inline(always)]
pub fn lobe_share(g: f64) -> f64 {
    // From 700 on it is 1.
    -exp(-g.min(700.0)).minus_one()
}

#[cfg(test)]
mod tests {
    use super::{lobe_share, mirror_g, spike_share};
    use crate::reflectance::numeric::EPSILON;

    #[test]
    fn the_shares_add_up_and_small_ones_keep_their_digits() {
        for g in [1e-3, 0.5, 1.0, 40.0] {
            assert!((spike_share(g) + lobe_share(g) - 1.0).abs() <= 4.0 * EPSILON);
        }
        assert_eq!(lobe_share(1e-300), 1e-300);
        assert_eq!((spike_share(0.0), lobe_share(0.0)), (1.0, 0.0));
        assert_eq!(lobe_share(1e300), 1.0);
    }

    #[test]
    fn an_eighth_of_a_wavelength_turns_the_phase_by_a_right_angle() {
        let right_angle = core::f64::consts::FRAC_PI_2;
        let g = mirror_g(0.125, 1.0, 1.0);
        assert!((g / (right_angle * right_angle) - 1.0).abs() < 8.0 * EPSILON, "{g}");
    }
}
