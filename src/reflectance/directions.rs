//! The directions of one request: three angles, each one number for all or one number for each.

use super::bounds;
use super::geometry::Geometry;
use super::geometry::lanes::{AngleLanes, DirectionLanes};
use super::numeric::lobe_series::lanes::LANES;
use super::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};
use core::ops::Range;

/// One angle for all directions, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Angles<A> {
    /// Broadcast.
    One(A),
    /// One for each direction.
    Each(Vec<A>),
}

impl<A: Copy> Angles<A> {
    fn len(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Each(angles) => Some(angles.len()),
        }
    }

    /// One angle where all are the same: however it was said, it is worked out once, and to the same bits.
    fn folded(self, get: impl Fn(A) -> f64) -> Self {
        match self {
            Self::Each(angles)
                if angles.windows(2).all(|pair| get(pair[0]).to_bits() == get(pair[1]).to_bits()) =>
            {
                Self::One(angles[0])
            }
            other => other,
        }
    }

    /// Least and largest of some of them.
    fn extent(&self, range: Range<usize>, get: impl Fn(A) -> f64) -> [f64; 2] {
        match self {
            Self::One(angle) => [get(*angle); 2],
            Self::Each(angles) => {
                // Eight extents side by side become vector instructions.
                let mut extents = [[f64::INFINITY; 8], [f64::NEG_INFINITY; 8]];
                let [least, most] = &mut extents;
                let chunks = angles[range].chunks_exact(8);
                let rest = chunks.remainder();
                for chunk in chunks {
                    for (lane, &angle) in chunk.iter().enumerate() {
                        let angle = get(angle);
                        least[lane] = if angle < least[lane] { angle } else { least[lane] };
                        most[lane] = if angle > most[lane] { angle } else { most[lane] };
                    }
                }
                let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
                let ends = extents.into_iter().flatten().filter(|end| end.is_finite());
                ends.chain(rest.iter().map(|&angle| get(angle))).for_each(|angle| widen(&mut extent, angle));
                extent
            }
        }
    }

    fn column(&self, range: Range<usize>, get: impl Fn(A) -> f64) -> AngleColumn {
        match self {
            Self::One(angle) => AngleColumn::One(get(*angle)),
            Self::Each(angles) => AngleColumn::Each(angles[range].iter().map(|&angle| get(angle)).collect()),
        }
    }

    fn select(&self, indices: &[usize]) -> Self {
        match self {
            Self::One(angle) => Self::One(*angle),
            Self::Each(angles) => Self::Each(indices.iter().map(|&index| angles[index]).collect()),
        }
    }

    fn at(&self, index: usize) -> A {
        match self {
            Self::One(angle) => *angle,
            Self::Each(angles) => angles[index],
        }
    }

    /// Those of the directions from `first` on.
    fn lanes(&self, first: usize, lanes: &mut AngleLanes)
    where
        A: Quantity,
    {
        match self {
            Self::One(angle) => {
                if !lanes.is_one {
                    lanes.degrees = [angle.get(); LANES];
                    lanes.is_one = true;
                }
            }
            Self::Each(angles) => {
                for (lane, angle) in lanes.degrees.iter_mut().zip(&angles[first..]) {
                    *lane = angle.get();
                }
            }
        }
    }
}

/// One of the angles of some directions, degrees.
#[derive(Clone, Debug, PartialEq)]
pub enum AngleColumn {
    /// The same in all.
    One(f64),
    /// One for each.
    Each(Vec<f64>),
}

/// Which of the three angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the report's symbols")]
pub enum DirectionAngle {
    ThetaI,
    ThetaR,
    PhiR,
}

/// Why three sets of angles are not directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DirectionsError {
    /// An array without elements.
    Empty {
        /// Which.
        angle: DirectionAngle,
    },
    /// An array whose length is not that of the first array.
    UnequalLength {
        /// Which.
        angle: DirectionAngle,
        /// Its length.
        length: usize,
        /// The length of the first array.
        expected: usize,
    },
    /// More directions than one request may have.
    TooMany {
        /// Which array.
        angle: DirectionAngle,
        /// Its length.
        length: usize,
    },
}

/// The least and the largest of some directions' angles, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extents {
    /// θ_i
    pub(super) theta_i: [f64; 2],
    /// θ_r as given
    pub(super) theta_r: [f64; 2],
    /// |θ_r|
    pub(super) zenith: [f64; 2],
    /// θ_i − |θ_r|
    pub(super) difference: [f64; 2],
    /// φ_r as given
    pub(super) phi_r: [f64; 2],
}

/// Takes an angle into an extent; none of them is NaN.
fn widen(extent: &mut [f64; 2], angle: f64) {
    let [least, largest] = *extent;
    *extent = [if angle < least { angle } else { least }, if angle > largest { angle } else { largest }];
}

/// N directions, 1 ≤ N ≤ [`bounds::MAX_DIRECTIONS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    theta_i: Angles<SourceZenith>,
    theta_r: Angles<ViewerZenith>,
    phi_r: Angles<Azimuth>,
    count: usize,
}

impl Directions {
    /// Broadcasts and checks the lengths; all that is wrong comes back at once.
    pub fn new(
        theta_i: Angles<SourceZenith>,
        theta_r: Angles<ViewerZenith>,
        phi_r: Angles<Azimuth>,
    ) -> Result<Self, Vec<DirectionsError>> {
        let lengths = [theta_i.len(), theta_r.len(), phi_r.len()];
        let errors = Self::length_errors(lengths);
        if !errors.is_empty() {
            return Err(errors);
        }
        let count = lengths.into_iter().flatten().next().unwrap_or(1);
        Ok(Self::folded(theta_i, theta_r, phi_r, count))
    }

    /// `count` directions, at least one: each angle is one, or as many.
    pub(super) fn folded(
        theta_i: Angles<SourceZenith>,
        theta_r: Angles<ViewerZenith>,
        phi_r: Angles<Azimuth>,
        count: usize,
    ) -> Self {
        Self {
            theta_i: theta_i.folded(SourceZenith::get),
            theta_r: theta_r.folded(ViewerZenith::get),
            phi_r: phi_r.folded(Azimuth::get),
            count,
        }
    }

    /// What is wrong with the lengths of the arrays of θ_i, θ_r and φ_r; None for one that is no array, or whose
    /// length is not known.
    pub fn length_errors(lengths: [Option<usize>; 3]) -> Vec<DirectionsError> {
        let angles = [DirectionAngle::ThetaI, DirectionAngle::ThetaR, DirectionAngle::PhiR];
        let expected = lengths.into_iter().flatten().next();
        let mut errors = Vec::new();
        for (angle, length) in angles.into_iter().zip(lengths) {
            let Some(length) = length else { continue };
            if length == 0 {
                errors.push(DirectionsError::Empty { angle });
            } else if length > bounds::MAX_DIRECTIONS {
                errors.push(DirectionsError::TooMany { angle, length });
            } else if let Some(expected) = expected.filter(|&e| e != length && e != 0) {
                errors.push(DirectionsError::UnequalLength { angle, length, expected });
            }
        }
        errors
    }

    /// Some of the directions, at least one, each index < N.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        Self {
            theta_i: self.theta_i.select(indices),
            theta_r: self.theta_r.select(indices),
            phi_r: self.phi_r.select(indices),
            count: indices.len(),
        }
    }

    /// θ_i of every direction, once where it is the same in all.
    pub(super) fn sources(&self) -> impl Iterator<Item = SourceZenith> + '_ {
        let count = if let Angles::One(_) = self.theta_i { 1 } else { self.count };
        (0..count).map(|index| self.theta_i.at(index))
    }

    /// How many zeniths the sources have.
    pub fn distinct_sources(&self) -> usize {
        let mut bits: Vec<u64> = self.sources().map(|source| source.get().to_bits()).collect();
        bits.sort_unstable();
        bits.dedup();
        bits.len()
    }

    /// N.
    pub fn count(&self) -> usize {
        self.count
    }

    /// θ_i, θ_r and φ_r of direction `index` < N.
    pub fn angles(&self, index: usize) -> (SourceZenith, ViewerZenith, Azimuth) {
        (self.theta_i.at(index), self.theta_r.at(index), self.phi_r.at(index))
    }

    /// The geometry of direction `index` < N.
    pub fn geometry(&self, index: usize) -> Geometry {
        let (theta_i, theta_r, phi_r) = self.angles(index);
        Geometry::new(theta_i, theta_r, phi_r)
    }

    /// What a range of directions that is not empty spans.
    pub(super) fn extents(&self, range: Range<usize>) -> Extents {
        let mut difference = [f64::INFINITY, f64::NEG_INFINITY];
        let apart = |index: usize| self.theta_i.at(index).get() - self.theta_r.at(index).get().abs();
        if let (Angles::Each(_), Angles::Each(_)) = (&self.theta_i, &self.theta_r) {
            range.clone().for_each(|index| widen(&mut difference, apart(index)));
        }
        let (theta_i, theta_r) = (
            self.theta_i.extent(range.clone(), SourceZenith::get),
            self.theta_r.extent(range.clone(), ViewerZenith::get),
        );
        let zenith = if theta_r[0] >= 0.0 {
            theta_r
        } else if theta_r[1] < 0.0 {
            [-theta_r[1], -theta_r[0]]
        } else {
            [0.0, theta_r[1].max(-theta_r[0])]
        };
        // One of the two is the same for all: the ends of the other say it.
        let ends = [theta_i[0] - zenith[1], theta_i[1] - zenith[0]];
        let difference = if difference[0] <= difference[1] { difference } else { ends };
        Extents { theta_i, theta_r, zenith, difference, phi_r: self.phi_r.extent(range, Azimuth::get) }
    }

    /// θ_i, θ_r and φ_r of a range of the directions, degrees.
    pub fn columns(&self, range: Range<usize>) -> [AngleColumn; 3] {
        [
            self.theta_i.column(range.clone(), SourceZenith::get),
            self.theta_r.column(range.clone(), ViewerZenith::get),
            self.phi_r.column(range, Azimuth::get),
        ]
    }

    /// All geometries in order.
    pub fn geometries(&self) -> impl Iterator<Item = Geometry> + '_ {
        (0..self.count).map(|index| self.geometry(index))
    }

    /// The `count` directions from `first` on, which are among the N and not more than a block holds.
    pub(super) fn block(&self, first: usize, count: usize, lanes: &mut DirectionLanes) {
        lanes.count = count;
        self.theta_i.lanes(first, &mut lanes.theta_i);
        self.theta_r.lanes(first, &mut lanes.theta_r);
        self.phi_r.lanes(first, &mut lanes.phi_r);
    }
}

#[cfg(test)]
mod tests {
    use super::{Angles, Directions};
    use crate::reflectance::quantity::{Azimuth, Quantity as _, SourceZenith, ViewerZenith};

    #[test]
    fn an_angle_said_often_is_the_angle_said_once() {
        let source = SourceZenith::new(43.4).unwrap();
        let viewers: Vec<_> = [-44.3, 12.0, 60.5].map(|angle| ViewerZenith::new(angle).unwrap()).to_vec();
        let azimuth = Azimuth::new(0.0).unwrap();
        let once = Directions::new(Angles::One(source), Angles::Each(viewers.clone()), Angles::One(azimuth));
        let often = Directions::new(
            Angles::Each(vec![source; 3]),
            Angles::Each(viewers.clone()),
            Angles::Each(vec![azimuth; 3]),
        );
        let curve = Directions::folded(
            Angles::Each(vec![source; 3]),
            Angles::Each(viewers.clone()),
            Angles::One(azimuth),
            3,
        );
        let (once, often) = (once.unwrap(), often.unwrap());
        assert_eq!(once.count(), 3);
        for other in [&often, &curve] {
            assert_eq!(once.extents(0..3), other.extents(0..3));
            assert_eq!(&once, other);
        }
        // 0 and −0 are not the same azimuth for all that is told of them.
        let zeros = Angles::Each([0.0, -0.0].map(|angle| Azimuth::new(angle).unwrap()).to_vec());
        let two = Directions::new(Angles::One(source), Angles::One(viewers[0]), zeros.clone()).unwrap();
        assert_eq!((two.count(), &two.phi_r), (2, &zeros));
    }
}
