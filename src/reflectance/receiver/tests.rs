use super::Receiver;
use super::cone::Cone;
use crate::reflectance::degrees::SinCos;
use crate::reflectance::directions::{Angles, Directions};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::evaluate::Quantity as Asked;
use crate::reflectance::fresnel::{Medium, RefractiveIndex};
use crate::reflectance::fresnel_average::table::SlopeAverages;
use crate::reflectance::kernel::Kernel;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::scaled::Scaled;
use crate::reflectance::quantity::{
    Azimuth, IndexK, IndexN, Quantity, ReceiverHalfAngle, SourceZenith, Tolerance, ViewerZenith,
};
use crate::reflectance::samples::conductor;
use crate::reflectance::scene::{Accuracy, Component, Components, Model, Scene, SceneParameters};
use crate::reflectance::shadowing::Shadowing;
use core::f64::consts::PI;

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / 9007199254740992.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        values[(self.unit() * values.len() as f64) as usize]
    }
}

fn scene(
    model: Model,
    lengths: [f64; 2],
    shadowing: Shadowing,
    half_angle: f64,
    tolerance: f64,
) -> SceneParameters {
    let mut p = conductor(model, lengths, tolerance);
    p.surface.shadowing = Some(shadowing);
    p.receiver = Some(ReceiverHalfAngle::new(half_angle).unwrap());
    p.components = Components::Named(vec![Component::SpecularLobe]);
    p
}

fn angles(theta_i: f64, theta_r: f64, phi_r: f64) -> (SourceZenith, ViewerZenith, Azimuth) {
    (SourceZenith::new(theta_i).unwrap(), ViewerZenith::new(theta_r).unwrap(), Azimuth::new(phi_r).unwrap())
}

fn mean(parameters: &SceneParameters, at: (SourceZenith, ViewerZenith, Azimuth)) -> Estimate {
    let scene = Scene::new(parameters.clone()).unwrap();
    let receiver = Receiver::of(&scene, 0.0).unwrap();
    let averages = SlopeAverages::default();
    let kernel = Kernel::new(receiver.scene(), Asked::Brdf, 0.0, &averages);
    let directions = Directions::new(Angles::One(at.0), Angles::One(at.1), Angles::One(at.2)).unwrap();
    receiver.mean(&kernel, &directions, 0, || false).unwrap().total
}

/// ∫ of the lobe in the frame that belongs to a lobe of this slope, whatever the scene's is.
fn in_frame(
    parameters: &SceneParameters,
    at: (SourceZenith, ViewerZenith, Azimuth),
    slope: f64,
) -> (Estimate, f64) {
    let scene = Scene::new(parameters.clone()).unwrap();
    let receiver = Receiver::of(&scene, 0.0).unwrap();
    let averages = SlopeAverages::default();
    let kernel = Kernel::new(receiver.scene(), Asked::Brdf, 0.0, &averages);
    let cone = Cone::new(at, parameters.receiver.unwrap(), slope);
    let all = receiver.integral(
        &kernel,
        &cone,
        receiver.slope(SinCos::of_degrees(at.0.get())),
        Scaled::ZERO,
        3000,
        || false,
    );
    (all.unwrap(), cone.projected().0.to_f64())
}

#[test]
fn projected_solid_angles_are_those_of_their_closed_forms() {
    // π sin²β cos θ_r where all is seen; where the axis grazes, half the cone: β − sin β cos β; and the horizon cuts
    // acos(cos β/sin θ) + sin²β cos θ acos(−cot β cot θ) − cos β √(sin²β − cos²θ) out of the others.
    for theta in [0.0f64, 20.0, 60.0, 80.0, 89.9, 90.0] {
        for beta in [1e-3f64, 0.5, 5.0, 29.9, 60.0, 89.0, 90.0] {
            let cone = Cone::new(angles(30.0, theta, 40.0), ReceiverHalfAngle::new(beta).unwrap(), 0.1);
            let (t, b) = (theta.to_radians(), beta.to_radians());
            let expected = if theta + beta <= 90.0 {
                PI * b.sin().powi(2) * t.cos()
            } else {
                (b.cos() / t.sin()).min(1.0).acos()
                    + b.sin().powi(2)
                        * t.cos()
                        * (-t.cos() * b.cos() / (t.sin() * b.sin())).clamp(-1.0, 1.0).acos()
                    - b.cos() * (b.sin().powi(2) - t.cos().powi(2)).max(0.0).sqrt()
            };
            // The closed form cancels: an arc cosine near 1 is known to ε/β.
            let off = (cone.projected().0.to_f64() - expected).abs();
            assert!(off < 4.0 * EPSILON / b + 1e-12 * expected, "{theta} {beta}: {off:e} of {expected:e}");
        }
    }
}

#[test]
fn both_frames_say_the_same() {
    let mut random = Random(7);
    let cases = std::env::var("RECEIVER_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(40);
    let mut worst = 0.0f64;
    for case in 0..cases {
        let model = random.one_of(&[Model::BeckmannSpizzichino, Model::TorranceSparrow, Model::Unified]);
        let height = 10f64.powf(random.between(-3.0, 1.0));
        let length = height * 10f64.powf(random.between(0.0, 2.0));
        let shadowing = random.one_of(&[Shadowing::None, Shadowing::VGroove, Shadowing::Smith]);
        let any = [random.between(-1.0, 1.9), random.between(0.0, 89.0), random.between(-30.0, 30.0)];
        let beta = random.one_of(&[10f64.powf(any[0]), 5.0, 90.0]);
        let theta_i = random.one_of(&[any[1], 0.0, 30.0, 75.0]);
        let apart = beta * random.one_of(&[0.0, 0.5, 0.999, 1.0, 1.001, 1.2, 1.45]) + 1e-9;
        let theta_r = (theta_i + random.one_of(&[-1.0, 1.0]) * apart).clamp(-89.9, 90.0);
        let phi = random.one_of(&[0.0, 0.0, any[2], 180.0]);
        let tolerance = random.one_of(&[1e-2, 1e-3, 1e-5]);
        let mut p = scene(model, [height, length], shadowing, beta, tolerance);
        if random.unit() < 0.5 {
            p.surface.medium = Medium::Index(RefractiveIndex {
                n: IndexN::new(random.between(0.3, 3.0)).unwrap(),
                k: IndexK::new(random.one_of(&[0.0, 4.0])).unwrap(),
            });
        }
        let at = angles(theta_i, theta_r, phi);
        let fine = SceneParameters {
            accuracy: Accuracy { relative_tolerance: Tolerance::new(1e-7).unwrap(), ..p.accuracy },
            ..p.clone()
        };
        // A narrow lobe in polar coordinates about the mirror direction, a wide one about the axis.
        let own = mean(&p, at);
        let (one, projected) = in_frame(&p, at, 1e9);
        let (other, _) = in_frame(&fine, at, 1e-3);
        let [own, one, other] = [own.scaled_by(Scaled::new(projected)), one, other];
        for (name, one) in [("its own", own), ("the axis'", one)] {
            let off = one.value.distance(other.value);
            let bound = one.error + other.error;
            let share = (off / bound).to_f64();
            worst = worst.max(share);
            assert!(
                off.to_f64() <= bound.to_f64() || off.is_zero(),
                "case {case}, {name}: {p:?}\nat {at:?}: {one:?} against {other:?}"
            );
        }
    }
    println!("the worst error is {worst:.3} of its bound");
}

#[test]
fn a_lobe_within_the_cone_sends_it_what_it_sends_the_hemisphere() {
    use crate::reflectance::albedo::AlbedoScene;
    for (length, half_angle) in [(1e3, 10.0), (1e6, 0.01), (1e9, 1e-3), (1e9, 20.0)] {
        for theta_i in [0.0, 40.0, 70.0] {
            let mut p = scene(Model::BeckmannSpizzichino, [1.0, length], Shadowing::None, half_angle, 1e-8);
            let read = mean(&p, angles(theta_i, theta_i, 0.0));
            let (_, projected) = in_frame(&p, angles(theta_i, theta_i, 0.0), 1.0);
            p.receiver = None;
            let albedo =
                AlbedoScene::new(p).unwrap().at(SourceZenith::new(theta_i).unwrap(), || false).unwrap();
            let (sent, read) = (albedo.total.value.to_f64(), read.value.to_f64() * projected);
            assert!((read / sent - 1.0).abs() < 4e-8, "{length} {half_angle} {theta_i}: {read} {sent}");
        }
    }
}

#[test]
fn a_hemisphere_reads_the_albedo() {
    use crate::reflectance::albedo::AlbedoScene;
    for model in [Model::BeckmannSpizzichino, Model::TorranceSparrow] {
        for shadowing in [Shadowing::None, Shadowing::VGroove, Shadowing::Smith] {
            for theta_i in [0.0, 30.0, 75.0] {
                let mut p = scene(model, [0.5, 3.0], shadowing, 90.0, 1e-5);
                let read = mean(&p, angles(theta_i, 0.0, 0.0)).scaled_by(Scaled::new(PI));
                p.receiver = None;
                let albedo =
                    AlbedoScene::new(p).unwrap().at(SourceZenith::new(theta_i).unwrap(), || false).unwrap();
                let bound = (read.error + albedo.total.error).to_f64();
                let off = read.value.distance(albedo.total.value).to_f64();
                assert!(off <= bound && bound < 1e-4, "{model:?} {shadowing:?} {theta_i}: {off:e} {bound:e}");
            }
        }
    }
}

#[test]
fn a_small_cone_reads_its_axis() {
    // The mean over a cone differs by (β/width)² from its middle.
    for half_angle in [1e-60, 1e-30, 1e-9] {
        for (theta_i, theta_r, phi_r) in [(30.0, 30.0, 0.0), (30.0, 40.0, 10.0), (60.0, -20.0, 5.0)] {
            let mut p = scene(Model::BeckmannSpizzichino, [1.0, 10.0], Shadowing::None, half_angle, 1e-10);
            let at = angles(theta_i, theta_r, phi_r);
            let read = mean(&p, at);
            p.receiver = None;
            let point = Scene::new(p).unwrap();
            let averages = SlopeAverages::default();
            let kernel = Kernel::new(&point, Asked::Brdf, 0.0, &averages);
            let geometry = crate::reflectance::geometry::Geometry::new(at.0, at.1, at.2);
            let point = kernel.lobe(&geometry, None).unwrap();
            let off = (read.value.distance(point.value) / point.value).to_f64();
            assert!(off < 1e-10 && read.relative_error() < 1e-10, "{half_angle} {at:?}: {off:e} {read:?}");
        }
    }
}

#[test]
fn half_a_narrow_lobe_is_within_a_rim_that_cuts_it() {
    for facet_slope in [1e-3, 1e-6, 1e-9] {
        let read = |theta_r: f64| {
            let mut p = scene(Model::TorranceSparrow, [1.0, 10.0], Shadowing::None, 1.0, 1e-6);
            p.surface.facet_slope = Some(Quantity::new(facet_slope).unwrap());
            let at = angles(75.0, theta_r, 0.0);
            let (_, projected) = in_frame(&p, at, 1.0);
            mean(&p, at).scaled_by(Scaled::new(projected))
        };
        let whole = read(75.0);
        for theta_r in [74.0, 76.0] {
            let half = read(theta_r);
            // The rim is straight, and the lobe even, but for the width.
            let off = (half.value.to_f64() / whole.value.to_f64() - 0.5).abs();
            assert!(off < facet_slope + 1e-5, "{facet_slope} {theta_r}: {off:e}");
            assert!(half.relative_error() < 1e-4, "{half:?}");
        }
    }
}

#[test]
fn what_no_point_of_the_rule_meets_is_not_nothing() {
    let mut p = scene(Model::TorranceSparrow, [1.0, 10.0], Shadowing::None, 1e-11, 1e-6);
    p.surface.facet_slope = Some(Quantity::new(1e-12).unwrap());
    let read = mean(&p, angles(75.0, 76.0, 0.0));
    assert!(read.value.is_zero() && !read.error.is_zero() && read.error.to_f64() == 0.0, "{read:?}");
}

#[test]
fn the_rim_belongs_to_the_cone() {
    for (theta_i, theta_r, half_angle, holds) in [
        (30.0, 40.0, 10.0, true),
        (30.0, 40.0, 9.999999999999998, false),
        (30.0, 30.1, 0.1, false),
        (30.0, 30.5, 0.5, true),
        (30.0, -30.0, 60.0, true),
        (30.0, -30.0, 59.99999999999999, false),
        (0.0, 1e-30, 1e-30, true),
        (90.0, 0.0, 90.0, true),
    ] {
        let phi = if theta_r < 0.0 { 180.0 } else { 0.0 };
        let (theta_r, phi) = if theta_r < 0.0 { (theta_r, 0.0) } else { (theta_r, phi) };
        let cone = Cone::new(angles(theta_i, theta_r, phi), ReceiverHalfAngle::new(half_angle).unwrap(), 0.1);
        let found = cone.holds_mirror();
        assert!(found == Some(holds) || theta_r < 0.0 && found.is_none(), "{theta_i} {theta_r}: {found:?}");
    }
}
