//! (24), (25) and (62) for a complex index, in forms in which nothing cancels but at Brewster's angle.

use super::{Complex, Energies, Energy, Fields, TimeFactor};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::quantity::{IndexK, IndexN};

/// Relative error that the sine and the cosine of the angle of incidence are allowed, 14 ε: of the sine counting
/// roundings gives 10 ε and a search for the worst found 8.4 ε; those of
/// [`crate::reflectance::geometry::Geometry::local_incidence`] stay below it.
pub const ANGLE_ERROR: f64 = 14.0 * EPSILON;

/// n − ik, the index of the lower medium relative to the upper one; k ≥ 0 absorbs. Energies are those of
/// n + ik as well (errata E5).
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct RefractiveIndex {
    /// n
    pub n: IndexN,
    /// k
    pub k: IndexK,
}

/// What (24) and (25) are made of, for n − ik; nothing in it cancels.
struct Parts {
    /// Y² − 1
    contrast: Complex,
    /// Y² cos²θ − sin²θ, zero at Brewster's angle
    brewster: Complex,
    /// cos θ + √(Y² − sin²θ)
    perpendicular: Complex,
    /// Y² cos θ + √(Y² − sin²θ)
    parallel: Complex,
    /// √(Y² − sin²θ)
    root: Complex,
}

impl RefractiveIndex {
    /// Whether both media are the same, so that there is no surface: F = 0 at every angle.
    #[inline(always)]
    fn is_no_surface(self) -> bool {
        self.n.get() == 1.0 && self.k.get() == 0.0
    }

    #[inline(always)]
    fn parts(self, SinCos { sin: s, cos: c }: SinCos) -> Parts {
        let (n, k) = (self.n.get(), self.k.get());
        let absorption = -2.0 * n * k;
        let contrast = Complex { re: (n - 1.0) * (n + 1.0) - k * k, im: absorption };
        let (nc, kc) = (n * c, k * c);
        let brewster = Complex { re: (nc - s) * (nc + s) - kc * kc, im: absorption * c * c };
        let root = Complex { re: (n - s) * (n + s) - k * k, im: absorption }.root_of_lower_half_plane();
        let optical_cos = Complex { re: (n - k) * (n + k), im: absorption }.scaled(c);
        Parts {
            contrast,
            brewster,
            perpendicular: Complex { re: c + root.re, im: root.im },
            parallel: Complex { re: optical_cos.re + root.re, im: optical_cos.im + root.im },
            root,
        }
    }

    /// The energies (62) as |Y² − 1|² |Y² c² − s²|²/|Y² c + root|⁴ and |Y² − 1|²/|c + root|⁴.
    ///
    /// Domain: sine s and cosine c in [0, 1], each known to [`ANGLE_ERROR`]. Beyond the critical angle of a medium
    /// without absorption both are exactly 1. Without branches: lanes call it as well.
    #[inline(always)]
    pub fn energies(self, incidence: SinCos) -> Energies {
        let SinCos { sin: s, cos: c } = incidence;
        let (n, k) = (self.n.get(), self.k.get());
        let parts = self.parts(incidence);
        let root_error = root_error(n, k, s, parts.root.norm());
        let contrast = parts.contrast.norm();

        let sum = parts.perpendicular.norm();
        let field = contrast / sum / sum;
        let e_perp = field * field;
        let perp_error = e_perp * fourth_power_error((ANGLE_ERROR * c + root_error) / sum);

        let sum = parts.parallel.norm();
        let (brewster, brewster_error) = (parts.brewster.norm(), brewster_error(n, k, s, c));
        let scale = contrast / sum / sum;
        let field = scale * brewster;
        let e_para = field * field;
        // |B + Δ|² − |B|² ≤ (2|B| + Δ)Δ: absolute, because B is zero at Brewster's angle.
        let zero_error = scale * brewster_error * (scale * (2.0 * brewster + brewster_error));
        let relative =
            fourth_power_error((ANGLE_ERROR + 5.0 * EPSILON) * (n * n + k * k) * c / sum + root_error / sum);
        let para_error = zero_error * (1.0 + relative) + e_para * relative;

        let (is_none, is_total) = (self.is_no_surface(), (k == 0.0) & (n < s * (1.0 - 2.0 * ANGLE_ERROR)));
        let known = if is_total { 1.0 } else { 0.0 };
        let energy = |value: f64, error: f64| {
            let Energy { value, error } = Energy::new(value, error);
            Energy {
                value: if is_none | is_total { known } else { value },
                error: if is_none | is_total { 0.0 } else { error },
            }
        };
        Energies { parallel: energy(e_para, para_error), perpendicular: energy(e_perp, perp_error) }
    }

    /// The field coefficients (24), (25) for n − ik or n + ik by the sign of the time factor.
    ///
    /// Domain as [`Self::energies`]. The error is measured as a distance in the complex plane.
    pub fn fields(self, incidence: SinCos, time_factor: TimeFactor) -> Fields {
        if self.is_no_surface() {
            let zero = Complex { re: 0.0, im: 0.0 };
            return Fields { parallel: zero, perpendicular: zero };
        }
        let parts = self.parts(incidence);
        let over_square = |numerator: Complex, sum: Complex| {
            let size = sum.norm();
            let conjugate = Complex { re: sum.re / size, im: -sum.im / size };
            numerator.scaled(1.0 / size).times(conjugate).times(conjugate).scaled(1.0 / size)
        };
        let contrast = parts.contrast;
        let perpendicular = over_square(Complex { re: -contrast.re, im: -contrast.im }, parts.perpendicular);
        let parallel = over_square(contrast.times(parts.brewster), parts.parallel);
        let sign = match time_factor {
            TimeFactor::Positive => 1.0,
            TimeFactor::Negative => -1.0,
        };
        let turned = |f: Complex| Complex { re: f.re, im: sign * f.im };
        Fields { parallel: turned(parallel), perpendicular: turned(perpendicular) }
    }
}

/// Absolute error of √(Y² − s²), from that of the radicand: s² carries 2 [`ANGLE_ERROR`], the rest roundings.
#[inline(always)]
fn root_error(n: f64, k: f64, s: f64, root: f64) -> f64 {
    let radicand =
        2.0 * ANGLE_ERROR * s * s + 4.0 * EPSILON * (((n - s) * (n + s)).abs() + k * k + 2.0 * n * k);
    // Both roots lie in one quadrant, so |a − b| ≤ |a² − b²|/|a| and |a − b| ≤ √|a² − b²|.
    let (above, next_to_zero) = (radicand / root, radicand.sqrt());
    let from_radicand = if root * root > radicand { above } else { next_to_zero };
    from_radicand + 4.0 * EPSILON * root
}

/// Absolute error of Y² c² − s²: each square carries 2 [`ANGLE_ERROR`] and up to 6 roundings.
#[inline(always)]
fn brewster_error(n: f64, k: f64, s: f64, c: f64) -> f64 {
    let reach = (n + k) * c;
    (2.0 * ANGLE_ERROR + 6.0 * EPSILON) * (reach * reach + s * s)
}

/// Relative error of an energy whose denominator, a fourth power, is known to the relative `error` before it is
/// raised: (1 − d)⁻⁴ − 1 ≤ 4d/(1 − d)⁴, and the roundings of |Y² − 1|² (16 ε), of the sums and of the quotients.
#[inline(always)]
fn fourth_power_error(error: f64) -> f64 {
    let d = error + 2.0 * EPSILON;
    let rest = (1.0 - d) * (1.0 - d);
    let relative = 4.0 * d / (rest * rest) + 28.0 * EPSILON;
    // Else nothing is known; the bound of the energy is cut at 1.
    if d < 0.5 { relative } else { 1e150 }
}

#[cfg(test)]
mod tests {
    use super::{Energy, RefractiveIndex};
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::numeric::EPSILON;
    use crate::reflectance::quantity::{IndexK, IndexN, Quantity};

    fn index(n: f64, k: f64) -> RefractiveIndex {
        RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() }
    }

    fn close(energy: Energy, exact: f64) -> bool {
        (energy.value - exact).abs() <= energy.error && energy.error < 160.0 * EPSILON
    }

    #[test]
    fn glass_at_normal_incidence() {
        let energies = index(1.5, 0.0).energies(SinCos::of_degrees(0.0));
        assert!(close(energies.parallel, 0.04) && close(energies.perpendicular, 0.04), "{energies:?}");
        // |(1 − Y)/(1 + Y)|² for 1 − 2i: |2i|²/|2 − 2i|² = 1/2.
        let energies = index(1.0, 2.0).energies(SinCos::of_degrees(0.0));
        assert!(close(energies.parallel, 0.5) && close(energies.perpendicular, 0.5), "{energies:?}");
    }

    #[test]
    fn sixty_degrees_on_an_index_of_root_three_is_brewsters_angle() {
        // tan 60° = √3: E_perp is cos²(2·60°) = 1/4, E_para 0.
        let energies = index(3f64.sqrt(), 0.0).energies(SinCos::of_degrees(60.0));
        assert!(energies.parallel.value <= energies.parallel.error, "{energies:?}");
        assert!(energies.parallel.error < 1e-29, "{energies:?}");
        assert!(close(energies.perpendicular, 0.25), "{energies:?}");
    }

    #[test]
    fn total_reflection_is_total() {
        for angle in [41.9, 60.0, 89.9999, 90.0] {
            let energies = index(1.0 / 1.5, 0.0).energies(SinCos::of_degrees(angle));
            assert_eq!(energies.parallel, Energy::ONE);
            assert_eq!(energies.perpendicular, Energy::ONE);
        }
        let below = index(1.0 / 1.5, 0.0).energies(SinCos::of_degrees(41.0));
        assert!(below.parallel.value < 0.5 && below.perpendicular.value < 0.9, "{below:?}");
    }

    #[test]
    fn grazing_incidence_reflects_everything() {
        for (n, k) in [(1.5, 0.0), (1e-9, 0.0), (1e9, 0.0), (0.2, 3.4), (1e-9, 1e9), (1.0, 1e-300)] {
            let energies = index(n, k).energies(SinCos::of_degrees(90.0));
            assert!((energies.parallel.value - 1.0).abs() <= energies.parallel.error, "{n} {k} {energies:?}");
            assert!((energies.perpendicular.value - 1.0).abs() <= energies.perpendicular.error, "{n} {k}");
        }
    }

    #[test]
    fn equal_media_have_no_surface() {
        for angle in [0.0, 45.0, 90.0] {
            let energies = index(1.0, 0.0).energies(SinCos::of_degrees(angle));
            assert_eq!((energies.parallel, energies.perpendicular), (Energy::ZERO, Energy::ZERO));
        }
    }
}
