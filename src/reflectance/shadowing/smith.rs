//! Smith's masking and shadowing of a surface of Gaussian slopes.
//!
//! B. G. Smith, *Geometrical shadowing of a random rough surface*, IEEE Trans. Antennas Propag. 15 (1967) 668. A facet is seen from
//! a direction of zenith θ with probability G₁ = 1/(1 + Λ), where (1 + Λ) cos θ is the projected area of all facets that
//! face that way, over the mean plane's. Both ways of combining source and viewer are as E. Heitz names them,
//! *Understanding the masking-shadowing function in microfacet-based BRDFs*, JCGT 3 (2014) 48.
//!
//! With m and v = cot θ/m, Λ cos θ = ½ m sin θ ∫ erfc from v on: a product, in which nothing cancels and which is finite at
//! grazing, where Λ alone is not.

use crate::reflectance::degrees::SinCos;
use crate::reflectance::geometry::Geometry;
use crate::reflectance::numeric::erfc_integral::erfc_integral;
use crate::reflectance::region::Span;
use crate::reflectance::roughness::BeckmannWidth;

/// Smith's function of one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smith {
    /// Beckmann's m of the density exp(−tan²α/m²)/(π m² cos⁴α) of the facets, per solid angle.
    width: f64,
    /// Whether the heights at which source and viewer see a facet are one.
    correlated: bool,
}

impl Smith {
    /// 1/(1 + Λ_i + Λ_r): a facet that lies high is seen from everywhere.
    pub const fn correlated(width: BeckmannWidth) -> Self {
        Self { width: width.get(), correlated: true }
    }

    /// 1/((1 + Λ_i)(1 + Λ_r)): source and viewer see a facet independently of each other.
    pub const fn uncorrelated(width: BeckmannWidth) -> Self {
        Self { width: width.get(), correlated: false }
    }

    /// Whether source and viewer see one height.
    pub(in crate::reflectance) const fn is_correlated(self) -> bool {
        self.correlated
    }

    /// Λ cos θ between the ends of a zenith: it grows with it.
    pub(in crate::reflectance) fn hidden(self, sin: Span, cos: Span) -> Span {
        Span { least: hidden(sin.least, cos.most, self.width), most: hidden(sin.most, cos.least, self.width) }
    }

    /// How much larger its relative error is than that of the others, in ε, for an m that is known to 8 ε.
    pub(super) const fn units(self) -> f64 {
        if self.correlated { 20.0 } else { 40.0 }
    }

    /// G over cos θ_i cos θ_r. Finite unless both directions are grazing and it is correlated; 0 for a source behind the
    /// surface.
    ///
    /// Relative error below 23 ε and that of m if it is correlated, 36 ε and twice that of m if not: (1 + Λ) cos θ carries
    /// 4 ε and m's for cosine and slope, 9 ε for the integral and 4 ε for its own roundings.
    #[inline(always)]
    pub(super) fn over_cosines(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, sin_i, cos_r, sin_r, .. } = geometry;
        let (hidden_i, hidden_r) = (hidden(sin_i, cos_i, self.width), hidden(sin_r, cos_r, self.width));
        // (½ + Λ_i) cos θ_i cos θ_r and the same of the viewer add up to 1 + Λ_i + Λ_r.
        let correlated = cos_r * (0.5 * cos_i + hidden_i) + cos_i * (0.5 * cos_r + hidden_r);
        let uncorrelated = (cos_i + hidden_i) * (cos_r + hidden_r);
        let over = 1.0 / if self.correlated { correlated } else { uncorrelated };
        if cos_i < 0.0 { 0.0 } else { over }
    }
}

/// Λ cos θ
#[inline(always)]
fn hidden(sin: f64, cos: f64, width: f64) -> f64 {
    let slope = width * sin;
    let v = cos / slope;
    // A source behind the surface sees nothing, whatever this is.
    let v = if v > 0.0 { v } else { 0.0 };
    0.5 * slope * erfc_integral(v)
}

/// Λ: the share 1/(1 + Λ) of the facets is seen from this direction. `width` is Beckmann's m = 2σ_h/T; 0 at normal incidence,
/// infinite at grazing. Absolute error below 8 ε (1 + Λ).
pub fn smith_lambda(direction: SinCos, width: f64) -> f64 {
    hidden(direction.sin, direction.cos, width) / direction.cos
}
