//! The sweep of a diagram as requests carry it.

use crate::http::input::object::{Checked, object};
use crate::http::input::reader::Reader;
use crate::http::input::values::List;
use crate::http::input::wire::{Count, is_given, named};
use crate::http::problem::Code;
use crate::reflectance::bounds::{MAX_CURVES, MAX_ROWS, MAX_SWEEP_POINTS};
use crate::reflectance::diagram::{DiagramError, Division, Sweep, SweepAxis, SweepParts};
use crate::reflectance::quantity::{Azimuth, Quantity as _, SweepAngle, SweepStep, ViewerZenith};

named! {
    SweepAxis, "an angle to sweep", [SweepAxis::ThetaR, SweepAxis::ThetaI];
}

/// The step, in degrees, where neither it nor the number of points is given.
const DEFAULT_STEP: f64 = 1.0;

object! {
    partial
    /// One zenith angle swept, the other fixed.
    SweepWire as "Sweep" {
        /// Which angle runs: `theta_r_deg` for a fixed source, `theta_i_deg` for a fixed view.
        sweep: SweepAxis,
        /// Where it starts, degrees. A negative θ_i stands for the same zenith on the viewer's side.
        from_deg: SweepAngle,
        /// Where it ends, degrees; not before it starts.
        to_deg: SweepAngle,
        /// The step, degrees; 1 when neither it nor `points` is given.
        step_deg: Option<SweepStep>,
        /// Instead of a step: how many points, both ends among them.
        points: Option<Count<1, MAX_SWEEP_POINTS>>,
        /// The fixed angles, degrees, one series each: θ_i in 0 to 90 or θ_r in -90 to 90.
        at_deg: List<ViewerZenith, MAX_CURVES>,
        /// φ_r, degrees; 0 when absent or null.
        phi_r_deg: Option<Azimuth>,
    }
}

/// A sweep whose parts fit together.
#[derive(Clone, Debug)]
pub(crate) struct CheckedSweep(pub(crate) Sweep);

impl Checked for CheckedSweep {
    type Fields = SweepWire;

    fn check(wire: SweepWire, reader: &mut Reader) -> Option<Self> {
        let by_points = is_given(&wire.points);
        let division = if by_points && is_given(&wire.step_deg) {
            let detail = "give step_deg or points, not both";
            reader.within("points", |reader| reader.fail(Code::Inconsistent, detail))
        } else if by_points {
            wire.points.flatten().map(|Count(points)| Division::Points(points))
        } else {
            let step = wire.step_deg.map(|step| step.or_else(|| SweepStep::new(DEFAULT_STEP).ok()));
            step.flatten().map(Division::Step)
        };
        let parts = SweepParts {
            axis: wire.sweep,
            from: wire.from_deg,
            to: wire.to_deg,
            division,
            at: wire.at_deg.map(|List(at)| at),
            phi_r: wire.phi_r_deg.and_then(|phi_r| phi_r.or_else(|| Azimuth::new(0.0).ok())),
        };
        // What the number of points follows from.
        let points = if by_points { "points" } else { "step_deg" };
        for error in parts.errors() {
            note(&error, points, reader);
        }
        parts.complete().map(Self)
    }
}

/// Notes what the core found at the field that a client knows.
fn note(error: &DiagramError, points_field: &'static str, reader: &mut Reader) {
    let (field, code, detail) = match error {
        DiagramError::EndsBeforeStart => {
            ("to_deg", Code::Inconsistent, "the sweep ends before it starts".into())
        }
        DiagramError::Points { points } => {
            let detail = format!(
                "a sweep of {points} points: expected from 1 to {MAX_SWEEP_POINTS}, and at least 2 unless it has no length"
            );
            let code = if *points > MAX_SWEEP_POINTS { Code::TooMany } else { Code::OutOfRange };
            (points_field, code, detail)
        }
        DiagramError::At { position, error } => {
            return reader.within("at_deg", |reader| {
                reader.at(*position, |reader| reader.error(Code::OutOfRange, error.to_string()));
            });
        }
        DiagramError::Curves { curves } => {
            ("at_deg", Code::TooMany, format!("{curves} fixed angles: expected from 1 to {MAX_CURVES}"))
        }
        DiagramError::TooManyRows { rows } => {
            let detail =
                format!("points times fixed angles is {rows}: at most {MAX_ROWS} are answered at once");
            (points_field, Code::TooMany, detail)
        }
    };
    reader.within(field, |reader| reader.error(code, detail));
}
