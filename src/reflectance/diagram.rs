//! Radiance diagrams (section 4.1.5): one zenith angle swept, the other fixed, in one plane.

use super::bounds::{self, Bounds};
use super::directions::{Angles, Directions};
use super::evaluate::{Output, Quantity, evaluate};
use super::quantity::{
    Azimuth, OutOfBounds, Quantity as _, SourceZenith, SweepAngle, SweepStep, ViewerZenith,
};
use super::scene::Scene;
use super::table::{Column, Curve, Table};
use core::hash::{Hash, Hasher};
use core::ops::Range;

/// Which zenith angle runs; the other is fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SweepAxis {
    /// θ_r for a fixed source, as in figures 11 to 21.
    ThetaR,
    /// θ_i for a fixed view, as in figure 23.
    ThetaI,
}

impl SweepAxis {
    /// The swept angle's name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ThetaR => "theta_r_deg",
            Self::ThetaI => "theta_i_deg",
        }
    }

    /// The fixed angle's name in requests and answers.
    pub const fn fixed_name(self) -> &'static str {
        match self {
            Self::ThetaR => "theta_i_deg",
            Self::ThetaI => "theta_r_deg",
        }
    }

    /// What the fixed angle may be.
    pub const fn fixed_bounds(self) -> &'static Bounds {
        match self {
            Self::ThetaR => &bounds::THETA_I,
            Self::ThetaI => &bounds::THETA_R,
        }
    }
}

/// How the sweep is divided.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub enum Division {
    /// From the start in steps of this many degrees, while the end is not passed.
    Step(SweepStep),
    /// This many points, both ends among them.
    Points(usize),
}

/// What is wrong with a sweep or its fixed angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiagramError {
    /// It ends before it starts.
    EndsBeforeStart,
    /// Fewer than one point, more than one for a sweep without length, or too many.
    Points {
        /// How many there would be.
        points: usize,
    },
    /// A fixed angle.
    At {
        /// Its position in the list.
        position: usize,
        /// What is wrong with it.
        error: OutOfBounds,
    },
    /// No fixed angle, or too many.
    Curves {
        /// How many there are.
        curves: usize,
    },
    /// Points times curves beyond what one answer may have.
    TooManyRows {
        /// How many rows there would be.
        rows: usize,
    },
}

/// A sweep with its fixed angles, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    axis: SweepAxis,
    /// What the positions follow from.
    ends: (SweepAngle, SweepAngle),
    division: Division,
    positions: Vec<f64>,
    at: Vec<f64>,
    phi_r: Azimuth,
}

/// The parts of a sweep, each None where it is not known: the rest can be checked all the same.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepParts {
    /// Which angle runs.
    pub axis: Option<SweepAxis>,
    /// Where it starts. A negative θ_i stands for the same zenith on the viewer's side, so that both angles may
    /// run from −90° to 90°.
    pub from: Option<SweepAngle>,
    /// Where it ends.
    pub to: Option<SweepAngle>,
    /// How it is divided.
    pub division: Option<Division>,
    /// The fixed angles: θ_i or θ_r.
    pub at: Option<Vec<Option<ViewerZenith>>>,
    /// φ_r.
    pub phi_r: Option<Azimuth>,
}

impl SweepParts {
    /// All that is wrong with what is known.
    pub fn errors(&self) -> Vec<DiagramError> {
        let mut errors = Vec::new();
        let curves = self.at.as_ref().map(Vec::len);
        if let Some(curves) = curves.filter(|&curves| curves == 0 || curves > bounds::MAX_CURVES) {
            errors.push(DiagramError::Curves { curves });
        }
        if let Some(axis) = self.axis {
            let bounds = axis.fixed_bounds();
            for (position, at) in self.at.iter().flatten().enumerate() {
                if let Some(value) = at.map(ViewerZenith::get).filter(|&value| !bounds.contains(value)) {
                    errors.push(DiagramError::At { position, error: OutOfBounds { value, bounds } });
                }
            }
        }
        let (Some(from), Some(to)) = (self.from.map(SweepAngle::get), self.to.map(SweepAngle::get)) else {
            return errors;
        };
        if from > to {
            errors.push(DiagramError::EndsBeforeStart);
        } else if let Some(division) = self.division {
            let points = division.points(from, to);
            let rows = points.saturating_mul(curves.unwrap_or(1));
            if points == 0 || points > bounds::MAX_SWEEP_POINTS || (points == 1 && from != to) {
                errors.push(DiagramError::Points { points });
            } else if rows > bounds::MAX_ROWS {
                errors.push(DiagramError::TooManyRows { rows });
            }
        }
        errors
    }

    /// The sweep, if every part is known and nothing is wrong.
    pub fn complete(self) -> Option<Sweep> {
        let at = self.at?.into_iter().collect::<Option<_>>()?;
        Sweep::new(self.axis?, (self.from?, self.to?), self.division?, at, self.phi_r?).ok()
    }
}

/// By what it was made of, which is less than its positions.
impl Hash for Sweep {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.axis, self.ends, self.division, self.phi_r).hash(state);
        for at in &self.at {
            state.write_u64(at.to_bits());
        }
    }
}

impl Sweep {
    /// Checks the parts against each other; all that is wrong comes back at once.
    pub fn new(
        axis: SweepAxis,
        (from, to): (SweepAngle, SweepAngle),
        division: Division,
        at: Vec<ViewerZenith>,
        phi_r: Azimuth,
    ) -> Result<Self, Vec<DiagramError>> {
        let fixed = at.iter().map(|at| at.get()).collect();
        let errors = SweepParts {
            axis: Some(axis),
            from: Some(from),
            to: Some(to),
            division: Some(division),
            at: Some(at.into_iter().map(Some).collect()),
            phi_r: Some(phi_r),
        }
        .errors();
        if errors.is_empty() {
            Ok(Self::divided(axis, (from, to), division, fixed, phi_r))
        } else {
            Err(errors)
        }
    }

    /// A sweep whose parts fit together.
    pub(super) fn divided(
        axis: SweepAxis,
        (from, to): (SweepAngle, SweepAngle),
        division: Division,
        at: Vec<f64>,
        phi_r: Azimuth,
    ) -> Self {
        let ends = (from, to);
        let (from, to) = (from.get(), to.get());
        let points = division.points(from, to);
        Self { axis, ends, division, positions: division.positions(from, to, points), at, phi_r }
    }

    /// Rows of the table: points times fixed angles.
    pub fn rows(&self) -> usize {
        self.positions.len() * self.at.len()
    }

    /// Which angle runs.
    pub fn axis(&self) -> SweepAxis {
        self.axis
    }

    /// Where it starts and ends.
    pub fn ends(&self) -> (SweepAngle, SweepAngle) {
        self.ends
    }

    /// How it is divided.
    pub fn division(&self) -> Division {
        self.division
    }

    /// Where it stops, degrees.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// The fixed angles, degrees: one curve each.
    pub fn at(&self) -> &[f64] {
        &self.at
    }

    /// Zeniths of the source, over all curves.
    pub fn sources(&self) -> usize {
        match self.axis {
            SweepAxis::ThetaR => self.at.len(),
            SweepAxis::ThetaI => self.rows(),
        }
    }

    /// φ_r, degrees.
    pub fn phi_r(&self) -> f64 {
        self.phi_r.get()
    }

    /// Some of the directions of the curve at one of the fixed angles: those of a range of the positions.
    pub fn directions(&self, fixed: f64, range: Range<usize>) -> Result<Directions, OutOfBounds> {
        let positions = &self.positions[range];
        let (theta_i, theta_r) = match self.axis {
            SweepAxis::ThetaR => {
                let viewers = positions.iter().map(|&position| ViewerZenith::new(position));
                (Angles::One(SourceZenith::new(fixed)?), Angles::Each(viewers.collect::<Result<_, _>>()?))
            }
            SweepAxis::ThetaI => {
                let sources = positions.iter().map(|&position| SourceZenith::new(position.abs()));
                // A source at −θ_i sees the viewer at −θ_r as the source at θ_i sees it at θ_r.
                let mirrored =
                    |&position: &f64| ViewerZenith::new(if position < 0.0 { -fixed } else { fixed });
                let viewers = positions.iter().map(mirrored);
                (
                    Angles::Each(sources.collect::<Result<_, _>>()?),
                    Angles::Each(viewers.collect::<Result<_, _>>()?),
                )
            }
        };
        Ok(Directions::folded(theta_i, theta_r, Angles::One(self.phi_r), positions.len()))
    }

    /// Evaluates a scene along the sweep at each fixed angle.
    pub fn evaluate(
        &self,
        scene: &Scene,
        quantity: Quantity,
        output: Output,
        label: &str,
    ) -> Result<Table, OutOfBounds> {
        let mut curves = Vec::with_capacity(self.at.len());
        for &at in &self.at {
            let evaluation =
                evaluate(scene, &self.directions(at, 0..self.positions.len())?, quantity, output);
            curves.push(Curve::of(evaluation, label.to_owned(), at, quantity.unit()));
        }
        Ok(Table {
            quantity: quantity.name(),
            unit: quantity.unit(),
            axis: Column { name: self.axis.name(), unit: "degrees", values: self.positions.clone() },
            fixed: Some(self.axis.fixed_name()),
            phi_r_deg: self.phi_r.get(),
            curves,
        })
    }
}

impl Division {
    /// How many points lie between `from` and `to`, both checked; saturates far above any limit.
    fn points(self, from: f64, to: f64) -> usize {
        match self {
            Self::Points(points) => points,
            Self::Step(step) => {
                // 1e-9 of a step forgives a step that is a decimal fraction, such as 0.1.
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "0 to 1.8e8: the step is at least 1e-6 of 180 degrees"
                )]
                let steps = ((to - from) / step.get() + 1e-9).floor() as usize;
                steps + 1
            }
        }
    }

    fn positions(self, from: f64, to: f64, points: usize) -> Vec<f64> {
        let at = |index: usize| match self {
            Self::Step(step) => (from + index as f64 * step.get()).min(to),
            Self::Points(_) if index + 1 == points => to,
            Self::Points(_) => from + (to - from) * index as f64 / (points - 1) as f64,
        };
        (0..points).map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{DiagramError, Division, Sweep, SweepAxis, SweepParts};
    use crate::reflectance::quantity::{Azimuth, Quantity, SweepAngle, SweepStep, ViewerZenith};

    fn step(degrees: f64) -> Division {
        Division::Step(SweepStep::new(degrees).unwrap())
    }

    fn parts(from: f64, to: f64, division: Division, at: &[f64]) -> SweepParts {
        SweepParts {
            axis: Some(SweepAxis::ThetaR),
            from: SweepAngle::new(from).ok(),
            to: SweepAngle::new(to).ok(),
            division: Some(division),
            at: Some(at.iter().map(|&at| ViewerZenith::new(at).ok()).collect()),
            phi_r: Azimuth::new(0.0).ok(),
        }
    }

    fn sweep(from: f64, to: f64, division: Division, at: f64) -> Sweep {
        parts(from, to, division, &[at]).complete().unwrap()
    }

    #[test]
    fn steps_hit_both_ends_and_the_angles_between() {
        let by_step = sweep(-89.5, 89.5, step(0.5), 30.0);
        assert_eq!(by_step.positions.len(), 359);
        assert_eq!(by_step.positions[358], 89.5);
        assert_eq!(by_step.positions[239], 30.0);
        let decimal = sweep(0.0, 90.0, step(0.1), 30.0);
        assert_eq!((decimal.positions.len(), decimal.positions[900]), (901, 90.0));
        let by_points = sweep(-90.0, 90.0, Division::Points(3), 30.0);
        assert_eq!(by_points.positions, [-90.0, 0.0, 90.0]);
        assert_eq!(sweep(5.0, 5.0, Division::Points(1), 0.0).positions, [5.0]);
    }

    #[test]
    fn everything_wrong_is_told_at_once() {
        assert_eq!(parts(3.0, 2.0, step(1.0), &[]).errors().len(), 2);
        assert_eq!(
            parts(0.0, 90.0, step(1e-6), &[1.0]).errors(),
            [DiagramError::Points { points: 90_000_001 }]
        );
        assert_eq!(
            parts(0.0, 90.0, Division::Points(1_000_000), &[1.0; 11]).errors(),
            [DiagramError::TooManyRows { rows: 11_000_000 }]
        );
        assert_eq!(
            parts(0.0, 90.0, Division::Points(1), &[1.0]).errors(),
            [DiagramError::Points { points: 1 }]
        );
    }

    #[test]
    fn nothing_is_concluded_from_what_is_not_known() {
        let unknown_end = parts(0.0, 91.0, step(1e-6), &[f64::NAN, -1.0]);
        let [DiagramError::At { position: 1, .. }] = unknown_end.errors()[..] else {
            panic!("{:?}", unknown_end.errors())
        };
        let unknown_axis = SweepParts { axis: None, ..parts(0.0, 90.0, step(1.0), &[-1.0]) };
        assert!(unknown_axis.errors().is_empty());
        assert_eq!(unknown_axis.complete(), None);
    }
}
