//! One number over the wavelength: samples between which it is linear, or a dispersion formula.

/// n or k over the wavelength.
#[derive(Debug)]
pub(super) enum Curve {
    /// By wavelength, which does not decrease, and at least one.
    Samples { wavelengths: Vec<f64>, values: Vec<f64> },
    /// n by a formula.
    Formula { formula: Formula, range: [f64; 2], coefficients: Vec<f64> },
}

/// The formulas of the refractiveindex.info database by their numbers there, C their coefficients, λ in micrometres.
#[derive(Clone, Copy, Debug)]
pub(super) enum Formula {
    /// 1, Sellmeier: n² = 1 + C₁ + Σ C₂ λ²/(λ² − C₃²).
    Sellmeier,
    /// 2, Sellmeier with squares for coefficients: n² = 1 + C₁ + Σ C₂ λ²/(λ² − C₃).
    SellmeierSquares,
    /// 3, polynomial: n² = C₁ + Σ C₂ λ^C₃.
    Polynomial,
    /// 4: n² = C₁ + C₂ λ^C₃/(λ² − C₄^C₅) + C₆ λ^C₇/(λ² − C₈^C₉) + Σ C₁₀ λ^C₁₁.
    General,
    /// 5, Cauchy: n = C₁ + Σ C₂ λ^C₃.
    Cauchy,
}

impl Formula {
    /// By its number in the database.
    pub(super) fn numbered(number: &str) -> Option<Self> {
        match number {
            "1" => Some(Self::Sellmeier),
            "2" => Some(Self::SellmeierSquares),
            "3" => Some(Self::Polynomial),
            "4" => Some(Self::General),
            "5" => Some(Self::Cauchy),
            _ => None,
        }
    }

    /// n at λ.
    fn index(self, coefficients: &[f64], wavelength: f64) -> f64 {
        let square = wavelength * wavelength;
        let (first, rest) = coefficients.split_first().map_or((0.0, &[][..]), |(first, rest)| (*first, rest));
        let powers = |from: f64, terms: &[f64]| {
            terms.chunks_exact(2).fold(from, |sum, term| sum + term[0] * power(wavelength, term[1]))
        };
        let poles = |terms: &[f64], pole: fn(f64) -> f64| {
            terms
                .chunks_exact(2)
                .fold(1.0 + first, |sum, term| sum + term[0] * square / (square - pole(term[1])))
        };
        match self {
            Self::Sellmeier => poles(rest, |c| c * c).sqrt(),
            Self::SellmeierSquares => poles(rest, |c| c).sqrt(),
            Self::Polynomial => powers(first, rest).sqrt(),
            Self::General => {
                let (resonances, others) = rest.split_at(rest.len().min(8));
                let resonant = resonances.chunks_exact(4).fold(first, |sum, term| {
                    sum + term[0] * power(wavelength, term[1]) / (square - power(term[2], term[3]))
                });
                powers(resonant, others).sqrt()
            }
            Self::Cauchy => powers(first, rest),
        }
    }
}

/// A whole power by multiplication, the same on every machine. The exponents of `tables.txt` are whole, from −8 to 4:
/// a fraction would be cut off, and the test below says that there is none.
fn power(base: f64, exponent: f64) -> f64 {
    let mut product = 1.0;
    let mut counted = 0.0;
    while counted < exponent.abs() {
        product *= base;
        counted += 1.0;
    }
    if exponent < 0.0 { 1.0 / product } else { product }
}

impl Curve {
    /// The least and the largest wavelength.
    pub(super) fn range(&self) -> [f64; 2] {
        match self {
            Self::Samples { wavelengths, .. } => {
                [wavelengths.first(), wavelengths.last()].map(|end| end.copied().unwrap_or_default())
            }
            Self::Formula { range, .. } => *range,
        }
    }

    /// The value at a wavelength of the range; of two samples at one wavelength the later is meant.
    pub(super) fn at(&self, wavelength: f64) -> Option<f64> {
        match self {
            Self::Formula { formula, coefficients, .. } => Some(formula.index(coefficients, wavelength)),
            Self::Samples { wavelengths, values } => {
                let above = wavelengths.partition_point(|&sample| sample <= wavelength);
                let below = above.checked_sub(1)?;
                let (Some(&right), Some(&high)) = (wavelengths.get(above), values.get(above)) else {
                    return values.last().copied();
                };
                let (left, low) = (wavelengths[below], values[below]);
                let between = (high - low) / (right - left) * (wavelength - left) + low;
                // Rounding can put it outside its neighbours, and k below 0.
                Some(between.clamp(low.min(high), low.max(high)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, Formula, power};

    #[test]
    fn samples_are_met_and_lines_between_them() {
        let curve =
            Curve::Samples { wavelengths: vec![0.5, 1.0, 1.0, 2.0], values: vec![1.0, 3.0, 4.0, 0.0] };
        for (wavelength, value) in [(0.5, 1.0), (0.75, 2.0), (1.0, 4.0), (1.5, 2.0), (2.0, 0.0)] {
            assert_eq!(curve.at(wavelength), Some(value));
        }
        assert_eq!(curve.at(0.4), None);
    }

    #[test]
    fn formulas_are_what_they_say() {
        let index = |number: &str, coefficients: &[f64], wavelength: f64| {
            Formula::numbered(number).unwrap().index(coefficients, wavelength)
        };
        // By hand: λ² = 4.
        assert_eq!(index("1", &[1.0, 1.5, 1.0], 2.0), 4f64.sqrt());
        assert_eq!(index("2", &[1.0, 1.5, 1.0, 3.0, -2.0], 2.0), 6f64.sqrt());
        assert_eq!(index("3", &[1.0, 2.0, 2.0, 4.0, -1.0], 2.0), 11f64.sqrt());
        let general = [1.0, 3.0, 0.0, 1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 0.5, 2.0];
        assert!((index("4", &general, 2.0) - (1.0 + 1.0 + 4.0 / 3.0 + 2.0f64).sqrt()).abs() < 1e-15);
        assert_eq!(index("5", &[1.5, 0.5, -2.0], 2.0), 1.625);
        assert!(Formula::numbered("6").is_none());
        assert_eq!(
            [power(2.0, 3.0), power(2.0, -2.0), power(0.0, 0.0), power(0.0, 1.0)],
            [8.0, 0.25, 1.0, 0.0]
        );
    }
}
