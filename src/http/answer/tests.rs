//! A streamed answer is the answer made at once.

use super::output::begin;
use super::{Over, Subject, Work, json, table};
use crate::config::Cli;
use crate::http::api::light::{Light, Line};
use crate::http::app::App;
use crate::http::edge::Deadline;
use crate::http::encode::rows::RowFormat;
use crate::reflectance::diagram::{Division, SweepAxis, SweepParts};
use crate::reflectance::directions::{Angles, Directions};
use crate::reflectance::evaluate::{Output, Quantity};
use crate::reflectance::figures;
use crate::reflectance::linear_image::{LinearKind, LinearScene, SpikeShape};
use crate::reflectance::quantity::{
    Azimuth, FacetSlope, Quantity as _, SourceZenith, Strength, SweepAngle, ViewerZenith, Wavelength,
};
use axum::body::to_bytes;
use clap::Parser as _;
use std::sync::Arc;
use std::time::Duration;

/// Enough for several pieces, grazing directions among them.
const POINTS: usize = 20_000;

fn subjects() -> Vec<Subject> {
    let panels = figures::find("22").unwrap().evaluate(false).unwrap();
    let scene = panels[0].scene.clone().unwrap();
    let line = |wavelength| Line { wavelength: Wavelength::new(wavelength).unwrap(), lookup: None };
    let spectrum = Light::Spectrum(vec![line(0.4), line(0.7)]);
    let scenes = [
        (Light::One(None), Output::default()),
        (Light::One(None), Output { log10: true, per_direction: true }),
        (spectrum, Output { log10: false, per_direction: true }),
    ];
    let scenes = scenes.map(|(light, output)| Subject::Scene {
        scene: Box::new(scene.clone()),
        light,
        quantity: Quantity::Radiance,
        output,
    });
    let strength = |value| Strength::new(value).unwrap();
    let linear = LinearScene {
        kind: LinearKind::FixedSource,
        diffuse_lobe: strength(1.0),
        specular_lobe: strength(2.0),
        specular_spike: strength(3.0),
        facet_slope: FacetSlope::new(10.0).unwrap(),
        spike: SpikeShape::Delta,
    };
    scenes.into_iter().chain([Subject::Linear { scene: Arc::new(linear), log10: true }]).collect()
}

fn overs(points: usize) -> [Over; 2] {
    let viewer = |index: usize| ViewerZenith::new(index as f64 / points as f64 * 180.0 - 90.0).unwrap();
    let directions = Directions::new(
        Angles::One(SourceZenith::new(45.0).unwrap()),
        Angles::Each((0..=points).map(viewer).collect()),
        Angles::One(Azimuth::new(0.0).unwrap()),
    );
    let sweep = SweepParts {
        axis: Some(SweepAxis::ThetaI),
        from: SweepAngle::new(-90.0).ok(),
        to: SweepAngle::new(90.0).ok(),
        division: Some(Division::Points(points)),
        at: Some([45.0, 90.0].map(|at| ViewerZenith::new(at).ok()).to_vec()),
        phi_r: Azimuth::new(0.0).ok(),
    };
    [Over::Directions(Box::new(directions.unwrap())), Over::Sweep(Box::new(sweep.complete().unwrap()))]
}

async fn streamed(app: &App, work: &Work, format: Option<RowFormat>) -> Vec<u8> {
    let limit = Duration::from_mins(10);
    let deadline = Deadline { at: tokio::time::Instant::now() + limit, limit };
    let turn = app.admission().turn().await.unwrap();
    let work = Arc::new(work.clone());
    let response = match format {
        None => begin(app, deadline, turn, "a/b", |output| json::stream(work, output)).await,
        Some(format) => {
            begin(app, deadline, turn, "a/b", move |output| table::stream(work, format, output)).await
        }
    };
    to_bytes(response.unwrap().into_body(), usize::MAX).await.unwrap().to_vec()
}

#[test]
fn parts_add_up_to_the_answer_made_at_once() {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
    let app = App::new(&Cli::parse_from(["reflectance"]).config);
    let check = |work: &Work| {
        let at_once = json::whole(work).unwrap();
        assert!(serde_json::from_slice::<serde_json::Value>(&at_once).is_ok());
        assert!(runtime.block_on(streamed(&app, work, None)) == at_once, "{work:?}");
        // Batches of Arrow are as long as the pieces: their numbers are compared over HTTP.
        for format in [RowFormat::Csv, RowFormat::Npy] {
            let at_once = table::whole(work, format).unwrap();
            assert!(runtime.block_on(streamed(&app, work, Some(format))) == at_once, "{work:?}");
        }
    };
    for subject in subjects() {
        for over in overs(POINTS) {
            let work = Work::new(subject.clone(), over);
            assert!(work.pieces_of_a_column().count() > 1 && work.groups(None).is_none());
            check(&work);
        }
        for over in overs(5) {
            let work = Work::new(subject.clone(), over);
            assert_eq!(work.groups(None).is_some(), work.curves() > 1);
            check(&work);
        }
    }
}
