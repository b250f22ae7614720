//! Radiance diagrams (section 4.1.5): one zenith angle swept, the other fixed, in one plane.

use super::bounds::{self, Bounds};
use super::directions::{Angles, Directions};
use super::evaluate::{Output, Quantity, evaluate};
use super::quantity::{Azimuth, OutOfBounds, Quantity as _, SourceZenith, ViewerZenith};
use super::scene::Scene;
use super::table::{Column, Curve, Table};

/// Which zenith angle runs; the other is fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Division {
    /// From the start in steps of this many degrees, while the end is not passed.
    Step(f64),
    /// This many points, both ends among them.
    Points(usize),
}

/// What is wrong with a sweep or its fixed angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiagramError {
    /// Where the sweep starts.
    From(OutOfBounds),
    /// Where it ends.
    To(OutOfBounds),
    /// It ends before it starts.
    EndsBeforeStart,
    /// The step.
    Step(OutOfBounds),
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
    positions: Vec<f64>,
    at: Vec<f64>,
    phi_r: Azimuth,
}

impl Sweep {
    /// Checks a sweep; all that is wrong comes back at once. A negative θ_i stands for the same
    /// zenith on the viewer's side, so that both angles may run from −90° to 90°.
    pub fn new(
        axis: SweepAxis,
        (from, to): (f64, f64),
        division: Division,
        at: Vec<f64>,
        phi_r: Azimuth,
    ) -> Result<Self, Vec<DiagramError>> {
        let mut errors = Vec::new();
        let outside = |value, bounds: &'static Bounds| OutOfBounds { value, bounds };
        if !bounds::SWEEP_ANGLE.contains(from) {
            errors.push(DiagramError::From(outside(from, &bounds::SWEEP_ANGLE)));
        }
        if !bounds::SWEEP_ANGLE.contains(to) {
            errors.push(DiagramError::To(outside(to, &bounds::SWEEP_ANGLE)));
        }
        if from > to {
            errors.push(DiagramError::EndsBeforeStart);
        }
        if at.is_empty() || at.len() > bounds::MAX_CURVES {
            errors.push(DiagramError::Curves { curves: at.len() });
        }
        for (position, &value) in at.iter().enumerate() {
            if !axis.fixed_bounds().contains(value) {
                errors.push(DiagramError::At { position, error: outside(value, axis.fixed_bounds()) });
            }
        }
        if let Division::Step(step) = division
            && !bounds::SWEEP_STEP.contains(step)
        {
            errors.push(DiagramError::Step(outside(step, &bounds::SWEEP_STEP)));
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let points = division.points(from, to);
        if points == 0 || points > bounds::MAX_SWEEP_POINTS || (points == 1 && from != to) {
            return Err(vec![DiagramError::Points { points }]);
        }
        let rows = points * at.len();
        if rows > bounds::MAX_DIRECTIONS {
            return Err(vec![DiagramError::TooManyRows { rows }]);
        }
        Ok(Self { axis, positions: division.positions(from, to, points), at, phi_r })
    }

    /// A sweep of this crate's own making, in range by construction.
    pub(super) fn preset(
        axis: SweepAxis,
        (from, to): (f64, f64),
        step: f64,
        at: Vec<f64>,
        phi_r: Azimuth,
    ) -> Self {
        let division = Division::Step(step);
        let points = division.points(from, to);
        Self { axis, positions: division.positions(from, to, points), at, phi_r }
    }

    /// Rows of the table: points times fixed angles.
    pub fn rows(&self) -> usize {
        self.positions.len() * self.at.len()
    }

    /// The directions of one curve.
    fn directions(&self, fixed: f64) -> Result<Directions, OutOfBounds> {
        let (mut theta_i, mut theta_r) =
            (Vec::with_capacity(self.positions.len()), Vec::with_capacity(self.positions.len()));
        for &position in &self.positions {
            let (source, viewer) = match self.axis {
                SweepAxis::ThetaR => (fixed, position),
                SweepAxis::ThetaI => (position, fixed),
            };
            // A source at −θ_i sees the viewer at −θ_r as the source at θ_i sees it at θ_r.
            let mirrored = if source < 0.0 { -viewer } else { viewer };
            theta_i.push(SourceZenith::new(source.abs())?);
            theta_r.push(ViewerZenith::new(mirrored)?);
        }
        Ok(Directions::of_curve(theta_i, theta_r, Angles::One(self.phi_r)))
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
            let evaluation = evaluate(scene, &self.directions(at)?, quantity, output);
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
                let steps = ((to - from) / step + 1e-9).floor() as usize;
                steps + 1
            }
        }
    }

    fn positions(self, from: f64, to: f64, points: usize) -> Vec<f64> {
        let at = |index: usize| match self {
            Self::Step(step) => (from + index as f64 * step).min(to),
            Self::Points(_) if index + 1 == points => to,
            Self::Points(_) => from + (to - from) * index as f64 / (points - 1) as f64,
        };
        (0..points).map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{DiagramError, Division, Sweep, SweepAxis};
    use crate::reflectance::quantity::{Azimuth, Quantity};

    fn sweep(from: f64, to: f64, division: Division, at: Vec<f64>) -> Result<Sweep, Vec<DiagramError>> {
        Sweep::new(SweepAxis::ThetaR, (from, to), division, at, Azimuth::new(0.0).unwrap())
    }

    #[test]
    fn steps_hit_both_ends_and_the_angles_between() {
        let by_step = sweep(-89.5, 89.5, Division::Step(0.5), vec![30.0]).unwrap();
        assert_eq!(by_step.positions.len(), 359);
        assert_eq!(by_step.positions[358], 89.5);
        assert_eq!(by_step.positions[239], 30.0);
        let decimal = sweep(0.0, 90.0, Division::Step(0.1), vec![30.0]).unwrap();
        assert_eq!((decimal.positions.len(), decimal.positions[900]), (901, 90.0));
        let by_points = sweep(-90.0, 90.0, Division::Points(3), vec![30.0]).unwrap();
        assert_eq!(by_points.positions, [-90.0, 0.0, 90.0]);
        assert_eq!(sweep(5.0, 5.0, Division::Points(1), vec![0.0]).unwrap().positions, [5.0]);
    }

    #[test]
    fn everything_wrong_is_told_at_once() {
        let errors = sweep(-91.0, 95.0, Division::Step(0.0), vec![10.0, -1.0, f64::NAN]).unwrap_err();
        assert_eq!(errors.len(), 5, "{errors:?}");
        assert_eq!(sweep(3.0, 2.0, Division::Step(1.0), vec![]).unwrap_err().len(), 2);
        assert_eq!(
            sweep(0.0, 90.0, Division::Step(1e-6), vec![1.0]).unwrap_err(),
            [DiagramError::Points { points: 90_000_001 }]
        );
        assert_eq!(
            sweep(0.0, 90.0, Division::Points(600_000), vec![1.0, 2.0]).unwrap_err(),
            [DiagramError::TooManyRows { rows: 1_200_000 }]
        );
        assert_eq!(
            sweep(0.0, 90.0, Division::Points(1), vec![1.0]).unwrap_err(),
            [DiagramError::Points { points: 1 }]
        );
    }
}
