//! Section 4.1.5 on the specular spike: figures 11 and 12.

use crate::claim::{Claim, Verdict, statements};
use crate::service::{ANGLES, Curve, crossing, figure, full_width, heights, point};

statements! {
    the_specular_radiance_of_a_smooth_surface_is_constant;
    below_a_fortieth_of_a_wavelength_a_surface_is_a_mirror;
    above_it_the_spike_decreases_but_stays_strong_at_large_angles;
    the_spike_fades_and_the_lobe_dominates;
    above_one_and_a_half_wavelengths_the_spike_is_gone;
    the_correlation_length_leaves_the_spike_alone;
    spike_and_lobe_are_comparable_in_a_small_range;
    a_small_patch_makes_a_sharp_spike;
}

const SPIKE: &str = "specular_spike";
const LOBE: &str = "specular_lobe";

/// (47) makes e^{−g} of the spike at the specular angle: the rest of it is the footprint over λ².
fn share(spike: f64, lambda: f64) -> f64 {
    spike * lambda * lambda / 400.0
}

/// e^{−g} of a surface of this σ_h/λ at this specular angle.
fn share_of(ratio: f64, theta: f64) -> f64 {
    share(point(&heights([ratio, 10.0 * ratio, 1.0]), SPIKE, theta, theta), 1.0)
}

/// log10 of spike over lobe at this specular angle for the captions' σ_h and T and this σ_h/λ.
fn spike_over_lobe(ratio: f64, theta: f64) -> f64 {
    let scene = heights([0.001, 0.01, 0.001 / ratio]);
    point(&scene, "log10_specular_spike", theta, theta) - point(&scene, "log10_specular_lobe", theta, theta)
}

fn lobe_over_spike(curve: &Curve) -> f64 {
    curve.specular(LOBE) / curve.specular(SPIKE)
}

fn the_specular_radiance_of_a_smooth_surface_is_constant() -> Claim {
    let mut claim = Claim::new(
        "4.1.5, figure 11a",
        "The radiance in the specular direction is constant for different θ_i",
        Verdict::Holds,
        "",
    );
    let shares: Vec<_> =
        figure("11a")[0].curves.iter().map(|curve| share(curve.specular(SPIKE), 0.5)).collect();
    let grazing = share_of(0.002, 89.0);
    claim.number("e^{−g} at θ = 10°, the least of the figure", "0.9994", shares[0]);
    claim.number("e^{−g} at θ = 89°", "1.0000", grazing);
    claim.case("to 0.1 % from 10° to grazing", shares.iter().all(|s| (s / grazing - 1.0).abs() < 1e-3));
    claim
}

fn below_a_fortieth_of_a_wavelength_a_surface_is_a_mirror() -> Claim {
    let mut claim = Claim::new(
        "4.1.5",
        "Mirror-like behaviour for σ_h/λ < 0.025",
        Verdict::Holds,
        "The report does not say how much of the light a mirror may lose: 0.025 is a criterion of 10 %.",
    );
    let at_normal = share_of(0.025, 0.0);
    claim.number("e^{−g} at 0.025, normal incidence", "0.906", at_normal);
    let ratio = |share: f64| crossing(0.001, 0.1, |ratio| share - share_of(ratio, 0.0));
    claim.number("σ_h/λ that leaves 0.9", "0.0258", ratio(0.9));
    claim.number("σ_h/λ that leaves 0.99", "0.0080", ratio(0.99));
    claim.case("nine tenths of the light stay in the spike at every angle", at_normal > 0.9);
    claim
}

fn above_it_the_spike_decreases_but_stays_strong_at_large_angles() -> Claim {
    let mut claim = Claim::new(
        "4.1.5, figures 11c, 11d",
        "Above 0.025 the spike decreases rapidly but stays strong for large θ_i",
        Verdict::Holds,
        "",
    );
    for (id, ratio, at_normal, at_75) in [("11c", 0.05, "0.674", "0.974"), ("11d", 0.1, "0.206", "0.900")] {
        let curves = &figure(id)[0].curves;
        let (normal, large) = (share_of(ratio, 0.0), share_of(ratio, 75.0));
        claim.number(format!("{id}: e^{{−g}} at normal incidence"), at_normal, normal);
        claim.number(format!("{id}: e^{{−g}} at 75°"), at_75, large);
        let worst = curves.iter().map(lobe_over_spike).fold(0.0, f64::max);
        claim.at_most(format!("{id}: lobe over spike in the specular direction"), "2e-6", worst);
        let rising = curves.windows(2).all(|pair| pair[0].specular(SPIKE) < pair[1].specular(SPIKE));
        claim.case(
            format!("{id}: weaker at normal incidence, most of it left at 75°"),
            normal < 0.7 && large > 0.85,
        );
        claim.case(format!("{id}: rises with θ_i"), rising);
    }
    claim
}

fn the_spike_fades_and_the_lobe_dominates() -> Claim {
    let mut claim = Claim::new(
        "4.1.5, figures 11e, 11f",
        "The spike fades and the lobe comes to dominate",
        Verdict::Partly,
        "It depends on the footprint over T², 4e6 here, of which the captions say nothing.",
    );
    let expected = [("11e", ["1.2", "0.03", "5e-4", "9e-6"]), ("11f", ["9e8", "2e5", "11", "9e-4"])];
    for (id, ratios) in expected {
        for (curve, quoted) in figure(id)[0].curves.iter().zip(ratios) {
            let ratio = lobe_over_spike(curve);
            claim.number(format!("{id}: lobe over spike at {}°", curve.at), quoted, ratio);
            claim.case(format!("{id} at {}°", curve.at), ratio > 1.0);
        }
    }
    let last = figure("11f")[0].curve(60.0).specular(SPIKE) / figure("11f")[0].curve(60.0).specular(LOBE);
    claim.number("11f: spike over lobe at 60°", "1.1e3", last);
    claim
}

fn above_one_and_a_half_wavelengths_the_spike_is_gone() -> Claim {
    let mut claim = Claim::new(
        "4.1.5",
        "The spike disappears for σ_h/λ > 1.5",
        Verdict::Partly,
        "At normal incidence 0.33 is enough; near grazing incidence every surface is a mirror.",
    );
    let at_limit =
        [(0.0, "2e-146"), (60.0, "6e-31"), (70.0, "1e-10"), (75.0, "0.005"), (80.0, "1.6e3"), (85.0, "2e6")];
    for (theta, quoted) in at_limit {
        let ratio = 10f64.powf(spike_over_lobe(1.5, theta));
        claim.number(format!("spike over lobe at σ_h/λ = 1.5, {theta}°"), quoted, ratio);
        claim.case(format!("{theta}°"), ratio < 0.01);
    }
    let equal =
        [(0.0, "0.33"), (45.0, "0.47"), (60.0, "0.67"), (75.0, "1.31"), (80.0, "1.98"), (85.0, "4.0")];
    for (theta, quoted) in equal {
        let ratio = crossing(0.1, 8.0, |ratio| -spike_over_lobe(ratio, theta));
        claim.number(format!("σ_h/λ at which spike and lobe are equal, {theta}°"), quoted, ratio);
    }
    let theta = crossing(60.0, 85.0, |theta| spike_over_lobe(1.5, theta));
    // Quoted as "about": one degree, not half.
    claim.number_within("θ up to which the lobe wins at σ_h/λ = 1.5, degrees", "76", theta, 1.0);
    claim
}

fn the_correlation_length_leaves_the_spike_alone() -> Claim {
    let mut claim =
        Claim::new("4.1.5, figure 12", "The spike is unaffected by changes of T", Verdict::Holds, "");
    let panels = ["12a", "12b", "12c", "12d"].map(|id| figure(id).remove(0));
    let mut differ = 0;
    for at in ANGLES {
        let first = panels[0].curve(at).column(SPIKE);
        differ += panels.iter().filter(|panel| panel.curve(at).column(SPIKE) != first).count();
    }
    claim.fact("curves of 12a-12d whose spike differs from 12a's in any bit", "0", differ.to_string());
    claim.case("every curve", differ == 0);
    claim
}

fn spike_and_lobe_are_comparable_in_a_small_range() -> Claim {
    let mut claim = Claim::new(
        "5.1",
        "Spike and lobe are comparable only for a small range of roughness",
        Verdict::Holds,
        "Normal incidence, footprint/T² = 4e6.",
    );
    let ratio = |log10: f64| crossing(0.1, 1.0, |ratio| log10 - spike_over_lobe(ratio, 0.0));
    let (first, last) = (ratio(2.0), ratio(-2.0));
    let g = |ratio: f64| (4.0 * std::f64::consts::PI * ratio).powi(2);
    claim.number("σ_h/λ at which the spike is 100 times the lobe", "0.274", first);
    claim.number("σ_h/λ at which it is a hundredth", "0.371", last);
    claim.number("g at the first", "11.8", g(first));
    claim.number("g at the second", "21.7", g(last));
    claim.case("four decades pass within a factor of 1.5 in σ_h/λ", last / first < 1.5);
    claim
}

fn a_small_patch_makes_a_sharp_spike() -> Claim {
    let mut claim = Claim::new(
        "after (35)",
        "When the surface dimensions are small, ρ_o becomes a very sharp function",
        Verdict::Fails,
        "The width is 2.783/(k X cos θ_r): the larger the patch, the sharper (errata E17).",
    );
    let width = |half_x: f64, lambda: f64| {
        let mut scene = heights([1e-9, 1e-8, lambda]);
        scene["sensor"]["patch_half_x_um"] = half_x.into();
        full_width(&scene, SPIKE, 0.0, 2.0 * lambda * 10.0 / half_x)
    };
    let (coarse, fine) = (width(10.0, 0.5), width(10.0, 1e-4));
    claim.number("width at half maximum, X = 10, λ = 0.5, degrees", "1.27", coarse);
    claim.number("width at half maximum, X = 10, λ = 1e-4, degrees", "2.5e-4", fine);
    let smaller = width(5.0, 0.5);
    claim.number("width for X = 5 over that for X = 10", "2.00", smaller / coarse);
    claim.case("halving X makes the spike sharper", smaller < coarse);
    claim
}
