//! What the oracle's tables leave out: the condition of Fresnel's laws with respect to the cosine
//! and the sine of the angle of incidence, taken as independent numbers, for n − ik.

use crate::fresnel::{index, polarization};
use num_complex::Complex64;
use reflectance::reflectance::degrees::SinCos;

/// |∂ ln F/∂ ln cos| + |∂ ln F/∂ ln sin| of the fields (24), (25) and of their energies (62).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fresnel {
    pub(crate) field_parallel: f64,
    pub(crate) field_perpendicular: f64,
    pub(crate) energy_parallel: f64,
    pub(crate) energy_perpendicular: f64,
}

impl Fresnel {
    /// F_perp = (1 − Y²)/(c + root)² and F_para = (Y² − 1)(Y²c² − s²)/(Y²c + root)², root = √(Y² − s²),
    /// differentiated.
    pub(crate) fn of(n: f64, k: f64, cos: f64, sin: f64) -> Self {
        let y2 = Complex64::new((n - k) * (n + k), -2.0 * n * k);
        let root2 = Complex64::new((n - sin) * (n + sin) - k * k, -2.0 * n * k);
        // At the critical angle, and at Brewster's, what rounding leaves of a difference limits the field, not 0.
        let least = f64::EPSILON * n * n;
        let root = if root2.norm() < least { Complex64::from(least) } else { root2 }.sqrt();
        let brewster =
            Complex64::new((n * cos - sin) * (n * cos + sin) - k * k * cos * cos, -2.0 * n * k * cos * cos);
        let least = f64::EPSILON * sin * sin;
        let brewster = if brewster.norm() < least { Complex64::from(least) } else { brewster };
        // d root/d ln s = −s²/root.
        let root_slope = -sin * sin / root;
        let perpendicular = [-2.0 * cos / (cos + root), -2.0 * root_slope / (cos + root)];
        let below = y2 * cos + root;
        let parallel = [
            2.0 * y2 * cos * cos / brewster - 2.0 * y2 * cos / below,
            -2.0 * sin * sin / brewster - 2.0 * root_slope / below,
        ];
        // An energy is the square of a modulus: twice the real part of the logarithmic derivative.
        let field = |d: [Complex64; 2]| d[0].norm() + d[1].norm();
        let energy = |d: [Complex64; 2]| 2.0 * (d[0].re.abs() + d[1].re.abs());
        Self {
            field_parallel: field(parallel),
            field_perpendicular: field(perpendicular),
            energy_parallel: energy(parallel),
            energy_perpendicular: energy(perpendicular),
        }
    }
}

/// The condition of h F′_para + v F′_perp: each energy's, weighted by its share.
pub(crate) fn mixed(n: f64, k: f64, incidence: SinCos, h: f64, v: f64) -> f64 {
    let condition = Fresnel::of(n, k, incidence.cos, incidence.sin);
    let energies = index(n, k).energies(incidence);
    let (parallel, perpendicular) = (h * energies.parallel.value, v * energies.perpendicular.value);
    let sum = index(n, k).reflectance(incidence, polarization(h, v)).value;
    (parallel * condition.energy_parallel + perpendicular * condition.energy_perpendicular) / sum
}
