//! Where a lobe is not smooth along a ray of viewers: a rule is not to reach over such a place.

/// Points at which a ray is looked at for a change of sign; what turns twice between two of them is left to the rule.
const LOOKS: usize = 12;
/// Halvings of what lies between two of them: to a rounding.
const HALVINGS: usize = 50;
/// Folds that there may be.
const MOST: usize = 4;

/// What folds a lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Folds {
    /// The branches of G (65).
    pub(super) grooves: bool,
    /// cos² of the critical angle, where F′ has a square root.
    pub(super) critical: Option<f64>,
}

/// A source and a viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cosines {
    /// cos θ_i
    pub(super) i: f64,
    /// cos θ_r
    pub(super) r: f64,
    /// Of the angle between them, cos 2θ′.
    pub(super) between: f64,
}

impl Folds {
    /// How many there may be on a ray.
    pub(super) const fn count(self) -> usize {
        (if self.grooves { 3 } else { 0 }) + self.critical.is_some() as usize
    }

    /// Their places along a ray between two coordinates, ascending; the end where there is none.
    pub(super) fn along(self, [from, to]: [f64; 2], at: impl Fn(f64) -> Cosines) -> [f64; MOST] {
        let mut places = [to; MOST];
        if from >= to {
            return places;
        }
        // With 2 cos α/cos θ′ = (cos θ_i + cos θ_r)/cos² θ′: 1 less that times either cosine, and the two compared.
        let masked = |c: Cosines| 2.0 * (c.i + c.r) * c.r - (1.0 + c.between);
        let shadowed = |c: Cosines| 2.0 * (c.i + c.r) * c.i - (1.0 + c.between);
        let equal = |c: Cosines| c.r - c.i;
        let mut count = 0;
        let mut note = |fold: &dyn Fn(Cosines) -> f64| {
            places[count] = turn([from, to], |coordinate| fold(at(coordinate)));
            count += 1;
        };
        if self.grooves {
            note(&masked);
            note(&shadowed);
            note(&equal);
        }
        if let Some(square) = self.critical {
            note(&|c: Cosines| 0.5 * (1.0 + c.between) - square);
        }
        places[..count].sort_by(f64::total_cmp);
        places
    }
}

/// The first place at which a function changes its sign, or the end.
fn turn([from, to]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let place = |look: usize| from + (to - from) * (look as f64 / LOOKS as f64);
    let is_positive = f(from) > 0.0;
    let Some(after) = (1..=LOOKS).find(|&look| (f(place(look)) > 0.0) != is_positive) else { return to };
    let (mut low, mut high) = (place(after - 1), place(after));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == is_positive { low = middle } else { high = middle }
    }
    high
}
