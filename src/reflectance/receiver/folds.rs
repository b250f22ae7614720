//! Where a lobe is not smooth among the viewers of a receiver.

/// Points at which a ray is looked at.
const LOOKS: usize = 12;

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

/// What G of (65) is.
#[derive(Clone, Copy, PartialEq)]
enum Branch {
    Seen,
    Masked,
    Shadowed,
}

impl Folds {
    /// Whether there may be any.
    pub(super) const fn are_there(self) -> bool {
        self.grooves || self.critical.is_some()
    }

    /// Whether there is one on a ray between two coordinates.
    pub(super) fn are_on(self, [from, to]: [f64; 2], at: impl Fn(f64) -> Cosines) -> bool {
        let sides = |look: usize| {
            let cosines = at(from + (to - from) * (look as f64 / LOOKS as f64));
            let beyond = self.critical.map(|square| 0.5 * (1.0 + cosines.between) > square);
            (self.grooves.then(|| Branch::of(cosines)), beyond)
        };
        let first = sides(0);
        (1..=LOOKS).any(|look| sides(look) != first)
    }
}

impl Branch {
    fn of(Cosines { i, r, between }: Cosines) -> Self {
        // 2 cos α/cos θ′ = (cos θ_i + cos θ_r)/cos² θ′, times the smaller cosine, against 1.
        if 2.0 * (i + r) * i.min(r) >= 1.0 + between {
            Self::Seen
        } else if r < i {
            Self::Masked
        } else {
            Self::Shadowed
        }
    }
}
