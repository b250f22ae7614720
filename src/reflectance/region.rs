//! A set of directions by the extremes of its angles, and what lies between them: every quantity of [`Geometry`] that
//! the bounds of a component need, from below and from above. A single direction is the narrowest region.
//!
//! Roundings are not part of a span: those who take logarithms of it allow for them.

use super::degrees::SinCos;
use super::directions::Extents;
use super::geometry::Geometry;
use super::numeric::EPSILON;

/// From the least to the largest, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Span {
    const fn new(least: f64, most: f64) -> Self {
        Self { least, most }
    }

    /// Of sums.
    pub(super) fn plus(self, other: Self) -> Self {
        Self::new(self.least + other.least, self.most + other.most)
    }

    /// Of products with a span that is not negative.
    fn times(self, factor: Self) -> Self {
        let below = if self.least < 0.0 { factor.most } else { factor.least };
        let above = if self.most < 0.0 { factor.least } else { factor.most };
        Self::new(self.least * below, self.most * above)
    }

    /// Of magnitudes.
    fn magnitude(self) -> Self {
        let most = self.least.abs().max(self.most.abs());
        let least =
            if self.least <= 0.0 && self.most >= 0.0 { 0.0 } else { self.least.abs().min(self.most.abs()) };
        Self::new(least, most)
    }

    /// Of squares of what is not negative.
    pub(super) fn squared(self) -> Self {
        Self::new(self.least * self.least, self.most * self.most)
    }

    /// Of logarithms.
    pub(super) fn ln(self) -> Self {
        Self::new(libm::log(self.least), libm::log(self.most))
    }
}

/// What a set of directions spans.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// cos θ_i
    pub(super) cos_i: Span,
    /// cos θ_r
    pub(super) cos_r: Span,
    /// q = cos θ_i + cos θ_r
    pub(super) cos_sum: Span,
    /// v_xy/k
    pub(super) horizontal: Span,
    /// |v_x|/k
    pub(super) along: Span,
    /// |v_y|/k
    pub(super) across: Span,
    /// The direction itself, if there is only one.
    pub(super) direction: Option<Geometry>,
}

impl Region {
    /// From the extents of the directions, and the direction if it is the only one.
    pub(super) fn new(extents: &Extents, direction: Option<Geometry>) -> Self {
        let &Extents { theta_i, theta_r, zenith, difference, phi_r } = extents;
        let (half_azimuth, sin_azimuth) = azimuth(theta_r, phi_r);
        let [low_i, high_i] = theta_i.map(SinCos::of_degrees);
        let [low_r, high_r] = zenith.map(SinCos::of_degrees);
        // sin θ_i − sin θ_r = 2 cos((θ_i + θ_r)/2) sin((θ_i − θ_r)/2), the cosine as the sine of what is left
        // of 90°: a sum of two angles next to 90° would round away what the cosine is made of.
        let half_sum = [0, 1].map(|end| (90.0 - theta_i[end]) + (90.0 - zenith[end]));
        let half_sum = half_sum.map(|left| 2.0 * SinCos::of_degrees(left / 2.0).sin);
        let half_difference = difference.map(|difference| SinCos::of_degrees(difference / 2.0).sin);
        let difference = Span::new(half_difference[0], half_difference[1])
            .times(Span::new(half_sum[1].max(0.0), half_sum[0]));
        let sin_r = Span::new(low_r.sin, high_r.sin);
        let sines = Span::new(low_i.sin, high_i.sin).times(sin_r).times(half_azimuth);
        let (straight, aside) = (difference.magnitude().squared(), sines);
        let horizontal = Span::new(
            (straight.least + 4.0 * aside.least).sqrt(),
            (straight.most + 4.0 * aside.most).sqrt().min(2.0),
        );
        let back = sin_r.times(half_azimuth);
        let along = difference.plus(Span::new(2.0 * back.least, 2.0 * back.most));
        // The two terms may cancel; each is known to a few ε of the largest.
        let slack = 16.0 * EPSILON * (difference.magnitude().most + 2.0 * back.most);
        let along = Span::new(along.least - slack, along.most + slack).magnitude();
        let (cos_i, cos_r) = (Span::new(high_i.cos, low_i.cos), Span::new(high_r.cos, low_r.cos));
        Self {
            cos_i,
            cos_r,
            cos_sum: cos_i.plus(cos_r),
            horizontal,
            along,
            across: sin_r.times(sin_azimuth),
            direction,
        }
    }

    /// 4 cos² θ′ = q² + v_xy²/k²
    fn length_squared(&self) -> Span {
        self.cos_sum.squared().plus(self.horizontal.squared())
    }

    /// q (1 + tan² α) of [`Geometry::facet_factor`]; q must not be 0.
    pub(super) fn facet_factor(&self) -> Span {
        let square = self.length_squared();
        Span::new(square.least / self.cos_sum.most, square.most / self.cos_sum.least)
    }

    /// 2 cos α/cos θ′ of [`super::shadowing`].
    pub(super) fn groove(&self) -> Span {
        let square = self.length_squared();
        Span::new(4.0 * self.cos_sum.least / square.most, 4.0 * self.cos_sum.most / square.least)
    }

    /// α, radians.
    pub(super) fn alpha(&self) -> Span {
        Span::new(
            libm::atan2(self.horizontal.least, self.cos_sum.most),
            libm::atan2(self.horizontal.most, self.cos_sum.least),
        )
    }
}

/// sin²(φ/2) and |sin φ|: a negative zenith is the same one at φ + 180°.
fn azimuth(theta_r: [f64; 2], phi: [f64; 2]) -> (Span, Span) {
    let half = [phi[0] / 2.0, phi[1] / 2.0];
    let sine = sin_magnitude(phi);
    if theta_r[0] >= 0.0 {
        (sin_magnitude(half).squared(), sine)
    } else if theta_r[1] < 0.0 {
        (cos_magnitude(half, [half[0] + 90.0, half[1] + 90.0]).squared(), sine)
    } else {
        (Span::new(0.0, 1.0), sine)
    }
}

/// |sin| between two angles.
fn sin_magnitude([from, to]: [f64; 2]) -> Span {
    extremes([from, to], [from, to].map(|angle| SinCos::of_degrees(angle).sin.abs()))
}

/// |cos| between two angles; `turned` is 90° on.
fn cos_magnitude(angles: [f64; 2], turned: [f64; 2]) -> Span {
    extremes(turned, angles.map(|angle| SinCos::of_degrees(angle).cos.abs()))
}

/// |sin| between two angles from its values at both: 0 at multiples of 180°, 1 halfway between.
fn extremes([from, to]: [f64; 2], [a, b]: [f64; 2]) -> Span {
    let contains = |offset: f64| ((to - offset) / 180.0).floor() >= ((from - offset) / 180.0).ceil();
    Span::new(if contains(0.0) { 0.0 } else { a.min(b) }, if contains(90.0) { 1.0 } else { a.max(b) })
}

#[cfg(test)]
mod tests {
    use super::{Region, Span};
    use crate::reflectance::directions::{Angles, Directions};
    use crate::reflectance::numeric::EPSILON;
    use crate::reflectance::quantity::{Azimuth, Quantity as _, SourceZenith, ViewerZenith};

    /// Up to rounding.
    fn holds(span: Span, value: f64) -> bool {
        let room = 32.0 * EPSILON * value.abs();
        span.least <= value + room && value - room <= span.most
    }

    #[test]
    fn a_region_holds_its_directions() {
        let mut state = 11u64;
        let mut uniform = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / 9007199254740992.0
        };
        for round in 0..20_000 {
            // Zeniths from 90° − 90° down to 90° − 1e-14°: the last doubles before 90° among them.
            let mut zenith = || 90.0 - 90.0 * 10f64.powf(-16.0 * uniform());
            let (theta_i, theta_r) = (zenith(), zenith());
            let other = [zenith(), zenith()];
            let sign = if round % 3 == 0 { -1.0 } else { 1.0 };
            let phi = if round % 2 == 0 { 0.0 } else { 720.0 * uniform() - 360.0 };
            let near = if round % 5 == 0 { other } else { [theta_i, theta_r] };
            let directions = Directions::new(
                Angles::Each([theta_i, near[0]].map(|angle| SourceZenith::new(angle).unwrap()).to_vec()),
                Angles::Each(
                    [theta_r, near[1]].map(|angle| ViewerZenith::new(sign * angle).unwrap()).to_vec(),
                ),
                Angles::One(Azimuth::new(phi).unwrap()),
            )
            .unwrap();
            let region = Region::new(&directions.extents(0..2), None);
            for geometry in directions.geometries() {
                let at = format!("{theta_i} {theta_r} {near:?} {sign} {phi}");
                assert!(holds(region.horizontal, geometry.horizontal), "{at}");
                assert!(holds(region.cos_sum, geometry.cos_sum), "{at}");
                assert!(holds(region.across, geometry.across().abs()), "{at}");
                // Its terms may cancel, which the region allows for.
                assert!(region.along.least <= geometry.along().abs(), "{at}");
                assert!(region.along.most >= geometry.along().abs(), "{at}");
            }
        }
    }
}
