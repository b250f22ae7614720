//! What little complex arithmetic (24) and (25) need.

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    pub(super) fn norm(self) -> f64 {
        libm::hypot(self.re, self.im)
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    /// The root in the right half plane for an imaginary part that is not positive; the negative real axis goes to −i√,
    /// the limit from below.
    pub(super) fn root_of_lower_half_plane(self) -> Self {
        let size = self.norm();
        if size == 0.0 {
            return Self { re: 0.0, im: 0.0 };
        }
        // Of |re root| and |im root| the larger is formed without cancellation.
        let larger = (0.5 * (size + self.re.abs())).sqrt();
        let smaller = -0.5 * self.im / larger;
        if self.re >= 0.0 { Self { re: larger, im: -smaller } } else { Self { re: smaller, im: -larger } }
    }
}
