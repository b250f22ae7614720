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
    /// sin θ_i
    pub(super) sin_i: Span,
    /// sin θ_r, not negative
    pub(super) sin_r: Span,
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
        let (cos_i, cos_r) = (Span::new(high_i.cos, low_i.cos), Span::new(high_r.cos, low_r.cos));
        let cos_sum = cos_i.plus(cos_r);
        // sin θ_i − sin θ_r = q tan((θ_i − θ_r)/2): nothing cancels.
        let [low, high] = difference.map(|difference| {
            let SinCos { sin, cos } = SinCos::of_degrees(difference / 2.0);
            sin / cos
        });
        let difference = Span::new(low, high).times(cos_sum);
        let sin_r = Span::new(low_r.sin, high_r.sin);
        let sin_i = Span::new(low_i.sin, high_i.sin);
        let sines = sin_i.times(sin_r).times(half_azimuth);
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
        let across = sin_r.times(sin_azimuth);
        Self { cos_i, cos_r, sin_i, sin_r, cos_sum, horizontal, along, across, direction }
    }

    /// 4 cos² θ′ = q² + v_xy²/k²
    fn length_squared(&self) -> Span {
        self.cos_sum.squared().plus(self.horizontal.squared())
    }

    /// cos θ′
    pub(super) fn cos_local(&self) -> Span {
        let square = self.length_squared();
        Span::new(0.5 * square.least.sqrt(), (0.5 * square.most.sqrt()).min(1.0))
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
    use crate::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};
    use crate::reflectance::shadowing::ShadowingFunction;

    #[test]
    fn every_direction_lies_within_its_region() {
        let mut state = 11u64;
        let mut between = move |from: f64, to: f64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            from + (to - from) * ((state >> 11) as f64 / 9007199254740992.0)
        };
        for round in 0..4000 {
            let width = 10f64.powf(between(-14.0, 2.0));
            let centre = [between(0.0, 90.0), between(-90.0, 90.0), between(-360.0, 360.0)];
            // Mirror directions, and corners of the angles.
            let centre = match round % 4 {
                0 => [centre[0], centre[0], 0.0],
                1 => [90.0, -90.0, 180.0],
                _ => centre,
            };
            let count = [1, 2, 9][round % 3];
            let angles: Vec<[f64; 3]> = (0..count)
                .map(|_| {
                    let shift = between(-width, width);
                    // Source and viewer together in half of the rounds.
                    let other = if round % 2 == 0 { shift } else { between(-width, width) };
                    [
                        (centre[0] + shift).clamp(0.0, 90.0),
                        (centre[1] + other).clamp(-90.0, 90.0),
                        (centre[2] + between(-width, width)).clamp(-360.0, 360.0),
                    ]
                })
                .collect();
            let directions = Directions::new(
                Angles::Each(angles.iter().map(|angle| SourceZenith::new(angle[0]).unwrap()).collect()),
                Angles::Each(angles.iter().map(|angle| ViewerZenith::new(angle[1]).unwrap()).collect()),
                Angles::Each(angles.iter().map(|angle| Azimuth::new(angle[2]).unwrap()).collect()),
            )
            .unwrap();
            let region = Region::new(&directions.extents(0..count), None);
            for geometry in directions.geometries() {
                // The roundings that callers allow for; differences of sines are known to an ε of 1.
                let holds = |span: Span, value: f64, absolute: f64| {
                    let slack = 64.0 * EPSILON;
                    span.least * (1.0 - slack) - absolute <= value
                        && value <= span.most * (1.0 + slack) + absolute
                };
                assert!(holds(region.cos_i, geometry.cos_i, 0.0), "{angles:?}");
                assert!(holds(region.cos_r, geometry.cos_r, 0.0), "{angles:?}");
                assert!(
                    holds(region.horizontal, geometry.horizontal, 0.0),
                    "{angles:?} {region:?} {geometry:?}"
                );
                assert!(
                    holds(region.along, geometry.along().abs(), 4.0 * EPSILON),
                    "{:?} {:e}",
                    region.along,
                    geometry.along()
                );
                assert!(holds(region.across, geometry.across().abs(), 0.0), "{angles:?} {region:?}");
                // The corner of a region may be both grazing, where neither has a limit.
                if geometry.cos_sum > 0.0 && region.cos_sum.least > 0.0 {
                    assert!(holds(region.facet_factor(), geometry.facet_factor(), 0.0), "{angles:?}");
                    assert!(holds(region.alpha(), geometry.alpha(), 0.0), "{angles:?}");
                    let shadowing = ShadowingFunction::VGroove.factor(&geometry);
                    let cosine = geometry.cos_i.min(geometry.cos_r);
                    assert!(
                        shadowing <= region.groove().most * cosine * (1.0 + 64.0 * EPSILON),
                        "{angles:?}"
                    );
                }
            }
        }
    }
}
