//! What little complex arithmetic (24) and (25) need.

use crate::reflectance::numeric::elementary::hypotenuse;

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// Parts up to 1e150.
    #[inline(always)]
    pub(super) fn norm(self) -> f64 {
        hypotenuse(self.re, self.im)
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    #[inline(always)]
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    /// The root in the right half plane for an imaginary part that is not positive; the negative real axis goes to −i√,
    /// the limit from below.
    #[inline(always)]
    pub(super) fn root_of_lower_half_plane(self) -> Self {
        let size = self.norm();
        // Of |re root| and |im root| the larger is formed without cancellation; of 0 both are.
        let larger = (0.5 * (size + self.re.abs())).sqrt();
        let smaller = -0.5 * self.im / larger.max(f64::MIN_POSITIVE);
        let is_right = self.re >= 0.0;
        let (re, minus_im) =
            (if is_right { larger } else { smaller }, if is_right { smaller } else { larger });
        Self { re, im: -minus_im }
    }
}
