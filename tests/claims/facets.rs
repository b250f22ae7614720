//! Section 4.2: Torrance and Sparrow's facets, figures 19 to 21, and (60).

use crate::claim::{Claim, Verdict, statements};
use crate::service::{ANGLES, Over, diagram, facets, figure, numbers, peak, point, post, shadowed_facets};
use serde_json::json;
use std::f64::consts::PI;

statements! {
    attenuation_is_one_over_an_appreciable_range;
    attenuation_makes_the_radiance_zero_at_grazing;
    attenuation_does_not_matter_away_from_grazing;
    both_models_resemble_each_other;
    the_slope_density_is_a_density_per_solid_angle;
    the_arcsine_gives_the_slope;
}

const LOBE: &str = "specular_lobe";

fn attenuation_is_one_over_an_appreciable_range() -> Claim {
    let mut claim = Claim::new(
        "4.2.4, figure 19",
        "G equals unity over an appreciable range of θ_r, for θ_i not near grazing",
        Verdict::Holds,
        "The exact ends, 60° + θ_i/3 forwards, lie on points of the diagram, where the last digit decides whether G is 1: \
         they are held to one step of 0.5°. G counts as 1 from 1 − 1e-12.",
    );
    let figure = figure("19").remove(0);
    let expected = [
        (0.0, "-59.5", "59.5"),
        (30.0, "-50", "69.5"),
        (45.0, "-44.5", "74.5"),
        (60.0, "0.5", "80"),
        (75.0, "45.5", "84.5"),
    ];
    for (at, first, last) in expected {
        let values = figure.curve(at).column("geometrical_attenuation");
        let ones: Vec<_> = figure
            .axis
            .iter()
            .zip(values)
            .filter(|(_, g)| *g >= 1.0 - 1e-12)
            .map(|(angle, _)| *angle)
            .collect();
        let (low, high) = (ones[0], ones[ones.len() - 1]);
        // One step of the diagram, in units of the last digit quoted.
        let step = |quoted: &str| if quoted.contains('.') { 5.0 } else { 0.5 };
        claim.number_within(format!("θ_i = {at}°: first angle, degrees"), first, low, step(first));
        claim.number_within(format!("θ_i = {at}°: last angle, degrees"), last, high, step(last));
        claim.fact(
            format!("θ_i = {at}°: without a gap"),
            "true",
            (ones.len() as f64 == 2.0 * (high - low) + 1.0).to_string(),
        );
        claim.case(format!("θ_i = {at}°, at least 35° wide"), high - low >= 35.0);
    }
    claim
}

fn attenuation_makes_the_radiance_zero_at_grazing() -> Claim {
    let mut claim = Claim::new(
        "4.2.4",
        "G approaches zero faster than the radiance approaches infinity: the radiance is zero at θ_r = 90°",
        Verdict::Fails,
        "At the same rate: G/cos θ_r tends to 2 cos α/cos θ′ (errata E38).",
    );
    let ratio = |at: f64| {
        let scene = shadowed_facets(13.0);
        point(&scene, LOBE, at, 90.0) / point(&scene, LOBE, at, at)
    };
    claim.number("σ_α = 13°, θ_i = 60°: L(90°)/L(specular)", "1.918", ratio(60.0));
    let value = point(&shadowed_facets(13.0), LOBE, 10.0, 90.0);
    claim.number("σ_α = 13°, θ_i = 10°: L(90°) for c·a_f = 1", "5.2e-3", value);
    claim.case("θ_i = 10°", value == 0.0);
    claim.case("θ_i = 60°", ratio(60.0) == 0.0);
    claim
}

fn attenuation_does_not_matter_away_from_grazing() -> Claim {
    let mut claim = Claim::new(
        "4.2.4, figure 21d",
        "With G = 1 the curves keep their shape",
        Verdict::Partly,
        "With G the peak for σ_α = 13° moves to the kink of G where there was none below it (errata E50).",
    );
    for (at, quoted) in [(45.0, "75.0"), (60.0, "80.0")] {
        let found = peak(&shadowed_facets(13.0), Over::Viewer, at).expect("a peak");
        claim.number(format!("θ_i = {at}°: peak with G, degrees"), quoted, found);
    }
    for at in ANGLES {
        let (with, without) =
            (peak(&shadowed_facets(13.0), Over::Viewer, at), peak(&facets(13.0), Over::Viewer, at));
        claim.case(format!("θ_i = {at}°: the same peak"), with == without);
    }
    claim
}

fn both_models_resemble_each_other() -> Claim {
    let mut claim = Claim::new(
        "4.2.4, figure 21d",
        "The resemblance of the Torrance-Sparrow and the Beckmann-Spizzichino diagrams is remarkable",
        Verdict::Partly,
        "σ_α = 13°, each scaled to its specular value, θ_r ≤ 80°: alike in shape only.",
    );
    let panels = figure("21d");
    for (at, quoted) in ANGLES.into_iter().zip(["12", "25", "36", "17"]) {
        let scaled = |panel: usize| {
            let curve = panels[panel].curve(at);
            let specular = curve.specular(LOBE);
            curve.column(LOBE).into_iter().map(move |value| value / specular).collect::<Vec<_>>()
        };
        let pairs = scaled(0).into_iter().zip(scaled(1)).zip(&panels[0].axis);
        let off =
            pairs.filter(|(_, angle)| **angle <= 80.0).map(|((a, b), _)| (a - b).abs()).fold(0.0, f64::max);
        claim.number(
            format!("θ_i = {at}°: largest difference, % of the specular value"),
            quoted,
            100.0 * off,
        );
        claim.case(format!("θ_i = {at}°, to 20 % of the specular value"), off < 0.2);
    }
    claim
}

fn the_slope_density_is_a_density_per_solid_angle() -> Claim {
    let mut claim = Claim::new(
        "(6), (58)",
        "The density of slopes, 1/(√(2π) σ_α) at its top, serves as the facets' number per solid angle",
        Verdict::Fails,
        "Facets that tile the mean plane fix c·a_f at 1/(2πσ_α²) for small σ_α (errata E31). Measured as the radiance with \
         `specular_scale` null over that with 1.",
    );
    for (sigma_alpha, quoted) in [(13.0f64, "1.07"), (30.0, "1.42")] {
        let mut tiled = facets(sigma_alpha);
        tiled["surface"]["specular_scale"] = json!(null);
        let scale = point(&tiled, LOBE, 30.0, 30.0) / point(&facets(sigma_alpha), LOBE, 30.0, 30.0);
        let sigma = sigma_alpha.to_radians();
        claim.number(
            format!("σ_α = {sigma_alpha}°: c·a_f times 2πσ_α²"),
            quoted,
            scale * 2.0 * PI * sigma * sigma,
        );
        let printed = scale * (2.0 * PI).sqrt() * sigma;
        claim.case(format!("σ_α = {sigma_alpha}°, to 5 %"), (printed - 1.0).abs() < 0.05);
    }
    let mut tiled = facets(1.0);
    tiled["surface"]["specular_scale"] = json!(null);
    let sigma = 1f64.to_radians();
    let scale = point(&tiled, LOBE, 30.0, 30.0) / point(&facets(1.0), LOBE, 30.0, 30.0);
    claim.number("σ_α = 1°: c·a_f times 2πσ_α²", "1.000", scale * 2.0 * PI * sigma * sigma);
    claim
}

/// The slope that (60) gives, arcsine and all.
fn printed_slope(theta_i: f64, theta_r: f64, phi_r: f64) -> f64 {
    let local = 0.5 * (theta_r.cos() * theta_i.cos() - theta_r.sin() * theta_i.sin() * phi_r.cos()).acos();
    let psi = (phi_r.sin() * theta_r.sin() / (2.0 * local).sin()).asin();
    (theta_i.cos() * local.cos() + theta_i.sin() * local.sin() * psi.cos()).acos()
}

/// Share of the viewing hemisphere, %, in which (60) differs from the slope that the service's lobe shows.
fn wrong_share(theta_i: f64) -> f64 {
    // Equal solid angles: 180 steps of cos θ_r, 360 of φ_r, at their middles.
    let (mut zeniths, mut azimuths) = (Vec::new(), Vec::new());
    for z in 0..180 {
        for a in 0..360 {
            zeniths.push(((f64::from(z) + 0.5) / 180.0).acos().to_degrees());
            azimuths.push(f64::from(a) + 0.5);
        }
    }
    let mut scene = facets(30.0);
    scene["geometry"] = json!({"theta_i_deg": theta_i, "theta_r_deg": zeniths, "phi_r_deg": azimuths});
    let values = numbers(&post("/v1/radiance", &scene)[LOBE]);
    let wrong = zeniths.iter().zip(&azimuths).zip(&values).filter(|((zenith, azimuth), value)| {
        let theta_r = zenith.to_radians();
        // (70), (71) with c·a_f = F = G = 1 solved for α.
        let slope = 30f64.to_radians() * (-2.0 * (4.0 * **value * theta_r.cos()).ln()).max(0.0).sqrt();
        // Rounding leaves 1e-7 at the most, next to α = 0; the wrong branch is off by degrees nearly everywhere.
        (printed_slope(theta_i.to_radians(), theta_r, azimuth.to_radians()) - slope).abs() > 1e-6
    });
    100.0 * wrong.count() as f64 / values.len() as f64
}

fn the_arcsine_gives_the_slope() -> Claim {
    let mut claim = Claim::new(
        "(60)",
        "The slope α of the reflecting facets by the arcsine of (60)",
        Verdict::Partly,
        "Wrong where the angle at the source is obtuse, tan θ_i < −tan θ_r cos φ_r (errata E33): in (90° − θ_i)/180° of the \
         hemisphere. The expected shares were estimated from random directions and are held to 1 %.",
    );
    for (at, quoted) in [(10.0, "45"), (30.0, "33"), (45.0, "25"), (60.0, "17"), (80.0, "6")] {
        let share = wrong_share(at);
        claim.number_within(format!("θ_i = {at}°: wrong share of the hemisphere, %"), quoted, share, 1.0);
        claim.case(format!("θ_i = {at}°, in nine tenths of the hemisphere"), share < 10.0);
    }
    let example = printed_slope(30f64.to_radians(), 60f64.to_radians(), PI).to_degrees();
    claim.number("30°, 60°, φ_r = 180°: (60), degrees", "15", example);
    let scene = facets(30.0);
    let value = diagram(&scene, Over::Viewer, (-60.0, -60.0), 1, &[30.0]).curves[0].column(LOBE)[0];
    let slope = 30.0 * (-2.0 * (4.0 * value * 60f64.to_radians().cos()).ln()).sqrt();
    claim.number("the same: α of the service's lobe, degrees", "45", slope);
    claim
}
