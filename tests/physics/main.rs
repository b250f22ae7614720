//! Laws that the models must obey, each to a tolerance that is derived where it stands.

mod albedo;
mod energy;
mod energy_page;
mod handover;
mod hankel;
mod invariance;
mod limits;
mod omission;
mod random;
mod realistic;
mod receiver;
mod savings;
mod tolerance;

use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::EPSILON;
use reflectance::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};

/// A pair of directions in degrees.
fn directions(theta_i: f64, theta_r: f64, phi_r: f64) -> Geometry {
    Geometry::new(
        SourceZenith::new(theta_i).unwrap(),
        ViewerZenith::new(theta_r).unwrap(),
        Azimuth::new(phi_r).unwrap(),
    )
}

/// Asserts |a − b| ≤ `units` ε of the larger.
#[track_caller]
fn assert_close(a: f64, b: f64, units: f64) {
    let slack = units * EPSILON * a.abs().max(b.abs());
    assert!(
        (a - b).abs() <= slack,
        "{a} and {b} differ by {:.1} of {units} ε",
        (a - b).abs() / EPSILON / a.abs()
    );
}
