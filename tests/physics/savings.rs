//! `docs/plan.md` commits the share of component evaluations that the report's figures and six realistic scenes do without.
//! `UPDATE_PLAN=1 cargo test --test physics` rewrites it.

use crate::realistic::{SCENES, in_range};
use reflectance::reflectance::diagram::SweepAxis;
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Output, Quantity, evaluate};
use reflectance::reflectance::figures::FIGURES;
use reflectance::reflectance::scene::{Components, Scene};
use std::fmt::Write as _;
use std::path::PathBuf;

const BEGIN: &str = "<!-- savings: begin -->\n";
const END: &str = "<!-- savings: end -->\n";
const TOLERANCES: [f64; 2] = [1e-9, 1e-3];

/// Evaluations of components: those there are, those that were left out, and those that could have been by their values.
#[derive(Clone, Copy, Default)]
struct Count {
    all: usize,
    saved: usize,
    possible: usize,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.all += other.all;
        self.saved += other.saved;
        self.possible += other.possible;
    }

    fn percent(self) -> String {
        let percent = |part: usize| 100.0 * part as f64 / self.all as f64;
        format!("{:.0} of {:.0} %", percent(self.saved), percent(self.possible))
    }
}

/// What one request leaves out of a scene, and what it could leave out.
fn count(scene: &Scene, directions: &Directions) -> Count {
    let omitted = evaluate(scene, directions, Quantity::Radiance, Output::default()).omitted.len();
    let mut named = scene.parameters().clone();
    named.components = Components::Named(scene.evaluated().to_vec());
    let output = Output { log10: true, per_direction: false };
    let named = Scene::new(named).expect("the same scene");
    let whole = evaluate(&named, directions, Quantity::Radiance, output);
    let budget = 0.25 * scene.parameters().accuracy.relative_tolerance.get();
    // The larger of two components, or two of three, is never left out: each on its own, then.
    let negligible = |logarithms: &[f64]| {
        logarithms
            .iter()
            .zip(whole.log10_total.as_deref().expect("logarithms"))
            .all(|(component, total)| component - total <= budget.log10())
    };
    let possible = whole
        .components
        .iter()
        .filter(|column| negligible(column.log10.as_deref().expect("logarithms")))
        .count();
    let (count, components) = (directions.count(), scene.evaluated().len());
    Count { all: count * components, saved: count * omitted, possible: count * possible }
}

/// The scene with its components left to the tolerance.
fn by_tolerance(scene: &Scene, tolerance: f64) -> Scene {
    let mut parameters = scene.parameters().clone();
    parameters.components = Components::Auto;
    parameters.accuracy.relative_tolerance = in_range(tolerance);
    Scene::new(parameters).expect("a preset fits together")
}

/// The curves of the figures: a viewer or a source from −89.5 to 89.5° at four fixed angles, a request each.
fn curves(scene: &Scene, axis: SweepAxis) -> Count {
    let mut whole = Count::default();
    for fixed in [10.0, 30.0, 45.0, 60.0] {
        let swept = || (-179..=179).map(|step| 0.5 * f64::from(step));
        let directions = match axis {
            SweepAxis::ThetaR => Directions::new(
                Angles::One(in_range(fixed)),
                Angles::Each(swept().map(in_range).collect()),
                Angles::One(in_range(0.0)),
            ),
            // A source at −θ sees the viewer at −θ_r.
            SweepAxis::ThetaI => Directions::new(
                Angles::Each(swept().map(|source: f64| in_range(source.abs())).collect()),
                Angles::Each(swept().map(|source| in_range(fixed.copysign(source))).collect()),
                Angles::One(in_range(0.0)),
            ),
        };
        whole.add(count(scene, &directions.expect("one length")));
    }
    whole
}

/// Mirror directions from 0 to 80°, in one request.
fn mirror(scene: &Scene) -> Count {
    let zeniths = 0..=80;
    let directions = Directions::new(
        Angles::Each(zeniths.clone().map(|zenith| in_range(f64::from(zenith))).collect()),
        Angles::Each(zeniths.map(|zenith| in_range(f64::from(zenith))).collect()),
        Angles::One(in_range(0.0)),
    )
    .expect("one length");
    count(scene, &directions)
}

/// Within 5° of the mirror direction of 30°, in steps of 0.05° along the plane of incidence, in one request.
fn highlight(scene: &Scene) -> Count {
    let zeniths = (0..=200).map(|step| in_range(25.0 + 0.05 * f64::from(step))).collect();
    let directions =
        Directions::new(Angles::One(in_range(30.0)), Angles::Each(zeniths), Angles::One(in_range(0.0)))
            .expect("one length");
    count(scene, &directions)
}

/// One row: a name and a cell for each kind of request and tolerance.
fn row(text: &mut String, name: &str, requests: &[&dyn Fn(f64) -> Count], whole: &mut [Count]) {
    write!(text, "| {name} |").expect("string");
    let cells = requests.iter().flat_map(|request| TOLERANCES.map(request));
    for (cell, whole) in cells.zip(whole) {
        whole.add(cell);
        write!(text, " {} |", cell.percent()).expect("string");
    }
    text.push('\n');
}

fn tables() -> String {
    let mut text = String::from("| figure | curves at 1e-9 | at 1e-3 |\n| --- | --- | --- |\n");
    let mut whole = [Count::default(); 2];
    for figure in FIGURES {
        let panels = figure.evaluate(false).expect("a preset");
        for panel in panels {
            // Fresnel and G have no components, and a panel by (49) is about that method.
            let Some(scene) = panel.scene.filter(|_| !panel.label.contains("rough")) else { continue };
            let axis = if panel.table.axis.name == SweepAxis::ThetaR.name() {
                SweepAxis::ThetaR
            } else {
                SweepAxis::ThetaI
            };
            let auto = |tolerance| curves(&by_tolerance(&scene, tolerance), axis);
            row(&mut text, figure.id, &[&auto], &mut whole);
        }
    }
    writeln!(text, "| all | {} | {} |\n", whole[0].percent(), whole[1].percent()).expect("string");
    text.push_str(
        "| scene | curves at 1e-9 | at 1e-3 | highlight at 1e-9 | at 1e-3 | mirror directions at 1e-9 | at 1e-3 |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut whole = [Count::default(); 6];
    for realistic in &SCENES {
        let of_curves = |tolerance| curves(&realistic.scene(tolerance), SweepAxis::ThetaR);
        let of_highlight = |tolerance| highlight(&realistic.scene(tolerance));
        let of_mirror = |tolerance| mirror(&realistic.scene(tolerance));
        row(&mut text, realistic.name, &[&of_curves, &of_highlight, &of_mirror], &mut whole);
    }
    text.push_str("| all |");
    for count in whole {
        write!(text, " {} |", count.percent()).expect("string");
    }
    text.push('\n');
    text
}

#[test]
fn the_share_of_the_work_saved_is_what_the_page_says() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/plan.md");
    let document = std::fs::read_to_string(&path).expect("docs/plan.md");
    let (before, rest) = document.split_once(BEGIN).expect("begin mark");
    let (committed, after) = rest.split_once(END).expect("end mark");
    let measured = tables();
    if std::env::var_os("UPDATE_PLAN").is_some() {
        std::fs::write(&path, [before, BEGIN, &measured, END, after].concat()).expect("docs/plan.md");
        return;
    }
    assert_eq!(measured, committed, "docs/plan.md is out of date: UPDATE_PLAN=1 rewrites it");
}
