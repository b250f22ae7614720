//! Blocks against one direction after the other, over random scenes of every model.

use super::super::directions::{Angles, Directions};
use super::super::fresnel::{Medium, Polarization, RefractiveIndex};
use super::super::fresnel_average::FresnelAverage;
use super::super::fresnel_average::table::SlopeAverages;
use super::super::geometry::Geometry;
use super::super::kernel::{Kernel, Quantity};
use super::super::numeric::dispatch::InstructionSet;
use super::super::numeric::lobe_series::lanes::{self, Batch};
use super::super::numeric::lobe_series::{LobeSeries, Method};
use super::super::quantity::Quantity as InRange;
use super::super::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Surface,
};
use super::super::shadowing::Shadowing;
use super::{Block, Output, Stretch};

struct Random(u64);

impl Random {
    /// Between 0 and 1 (xorshift64).
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below count")]
    fn index(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.index(choices.len())]
    }
}

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value.clamp(Q::BOUNDS.min, Q::BOUNDS.max)).unwrap()
}

fn medium(random: &mut Random) -> Medium {
    let (n, k) = match random.one_of(&[0, 1, 2, 3, 4]) {
        0 => return Medium::PerfectConductor,
        1 => (random.between(0.1, 4.0), 0.0),
        2 => (1.0 + 10f64.powf(random.between(-16.0, 0.0)), random.one_of(&[0.0, 1e-9])),
        3 => (10f64.powf(random.between(-9.0, 9.0)), 10f64.powf(random.between(-300.0, 9.0))),
        _ => (random.between(0.1, 4.0), random.between(0.0, 9.0)),
    };
    Medium::Index(RefractiveIndex { n: in_range(n), k: in_range(k) })
}

fn scene(random: &mut Random) -> Scene {
    let height = 10f64.powf(random.between(-3.0, 2.0));
    let model = random.one_of(&[
        Model::BeckmannSpizzichino,
        Model::TorranceSparrow,
        Model::Unified,
        Model::Lambertian,
    ]);
    let components: &[Component] = match model {
        Model::Lambertian => &[Component::DiffuseLobe],
        Model::BeckmannSpizzichino => &[Component::SpecularLobe],
        _ => random.one_of(&[
            &[Component::SpecularLobe] as &[_],
            &[Component::DiffuseLobe],
            &[Component::DiffuseLobe, Component::SpecularLobe],
        ]),
    };
    Scene::new(SceneParameters {
        model,
        surface: Surface {
            rms_height: Some(in_range(height)),
            correlation_length: Some(in_range(height * 10f64.powf(random.between(0.0, 3.0)))),
            facet_slope: (random.unit() < 0.5).then(|| in_range(10f64.powf(random.between(-3.0, 1.8)))),
            medium: medium(random),
            diffuse_albedo: in_range(random.one_of(&[0.0, 1.0]) * 10f64.powf(random.between(-30.0, 0.0))),
            specular_scale: random.one_of(&[None, None, Some(in_range(0.0)), Some(in_range(7.0))]),
            shadowing: Some(random.one_of(&Shadowing::ALL)),
            fresnel_average: random.one_of(&[None, Some(FresnelAverage::MeanPlane)]),
        },
        illumination: Illumination {
            wavelength: Some(in_range(1.0)),
            irradiance: in_range(10f64.powf(random.between(-3.0, 3.0))),
            polarization: random.one_of(&[
                Polarization::unpolarized(),
                Polarization::parallel(),
                Polarization::perpendicular(),
                Polarization::mix(in_range(0.3), in_range(0.7)).unwrap(),
            ]),
        },
        sensor: None,
        receiver: None,
        components: Components::Named(components.to_vec()),
        accuracy: Accuracy {
            relative_tolerance: in_range(10f64.powf(random.between(-15.0, -1.0))),
            method: Method::Auto,
        },
    })
    .unwrap()
}

/// Anywhere, about the mirror direction, at the ends of the ranges; in blocks that are whole and that are not.
fn angles(random: &mut Random) -> Vec<[f64; 3]> {
    let count = random.one_of(&[1, 7, 128, 200]);
    let kind = random.one_of(&[0, 1, 2]);
    let narrow = 10f64.powf(random.between(-14.0, 1.0));
    let direction = |_| {
        let theta = random.between(0.0, 90.0);
        match kind {
            0 => [theta, random.between(-90.0, 90.0), random.between(-360.0, 360.0)],
            1 => {
                [theta, (theta + random.between(-narrow, narrow)).min(90.0), random.between(-narrow, narrow)]
            }
            _ => [
                random.one_of(&[0.0, 90.0, theta, 90.0 - narrow]),
                random.one_of(&[0.0, 90.0, -90.0, theta, narrow - 90.0]),
                random.one_of(&[0.0, 180.0, narrow, 90.0]),
            ],
        }
    };
    (0..count).map(direction).collect()
}

fn directions(angles: &[[f64; 3]]) -> Directions {
    let [i, r, p] = [0, 1, 2].map(|which| angles.iter().map(move |direction| direction[which]));
    Directions::new(
        Angles::Each(i.map(in_range).collect()),
        Angles::Each(r.map(in_range).collect()),
        Angles::Each(p.map(in_range).collect()),
    )
    .unwrap()
}

/// All numbers of each direction.
fn numbers(set: InstructionSet, scene: &Scene, kernel: &Kernel<'_>, angles: &[[f64; 3]]) -> Vec<Vec<u64>> {
    let directions = directions(angles);
    let mut answer = Stretch::new(scene, 0, angles.len(), Output::default(), 0.0);
    Block::with(set).evaluate(kernel, &directions, 0..angles.len(), &mut answer);
    let columns = answer.columns;
    (0..angles.len())
        .map(|index| {
            let parts = columns.components.iter().map(|column| column.values[index]);
            parts
                .chain([columns.relative_error_bound[index], columns.total[index]])
                .map(f64::to_bits)
                .collect()
        })
        .collect()
}

/// S by the batch's methods, for the path that takes one direction after the other.
fn in_a_batch(kernel: &Kernel<'_>, geometry: &Geometry) -> Option<LobeSeries> {
    let (roughness, choice) = kernel.series()?;
    let mut batch = Batch::new();
    let (g, x) = (roughness.g(geometry), roughness.x(geometry));
    lanes::evaluate(InstructionSet::widest(), choice, &[g], &[x], &mut batch);
    batch.get(0)
}

#[test]
fn blocks_agree_with_single_directions_within_both_bounds() {
    let mut random = Random(1989);
    let (mut in_lanes, mut all) = ([0; Model::ALL.len()], 0);
    for _ in 0..6_000 {
        let scene = scene(&mut random);
        let quantity = random.one_of(&[Quantity::Radiance, Quantity::Brdf]);
        let averages = SlopeAverages::default();
        let kernel = Kernel::new(&scene, quantity, 0.0, &averages);
        let angles = angles(&mut random);
        let together = numbers(InstructionSet::widest(), &scene, &kernel, &angles);
        for set in InstructionSet::available() {
            assert_eq!(numbers(set, &scene, &kernel, &angles), together, "{} {scene:#?}", set.name());
        }
        let place = random.index(angles.len());
        let alone = numbers(InstructionSet::widest(), &scene, &kernel, &angles[place..=place]);
        assert_eq!(alone[0], together[place], "{:?} {scene:#?}", angles[place]);

        let directions = directions(&angles);
        for (index, numbers) in together.iter().enumerate() {
            let [.., bound, total] = numbers.as_slice() else { panic!("a total and its bound") };
            let (bound, total) = (f64::from_bits(*bound), f64::from_bits(*total));
            let geometry = directions.geometry(index);
            let reflection = kernel.reflect(&geometry, None, false);
            let exact = reflection.total;
            let (other, known) = (exact.value.to_f64(), exact.relative_error());
            let room = (bound + known + 1e-16) * total / (1.0 - bound);
            let is_lost = total < f64::MIN_POSITIVE || !total.is_finite() || bound >= 0.5;
            assert!(
                if is_lost {
                    total.to_bits() == other.to_bits() || other < 1e-307 || bound >= 0.5
                } else {
                    (total - other).abs() <= room
                },
                "{total:e} {bound:e} {other:e} {known:e} {:?} {scene:#?}",
                angles[index]
            );
            for (part, component) in numbers.iter().zip(scene.evaluated()) {
                let (part, exact) =
                    (f64::from_bits(*part), reflection.components[component.index()].unwrap());
                // A component's own bound is not answered; it is wider by less than 3 times than the other path's.
                let room = 4.0 * exact.relative_error() * part + 1e-307;
                let agrees =
                    (part - exact.value.to_f64()).abs() <= room || is_lost || scene.evaluated().len() == 1;
                assert!(agrees, "{component:?} {part:e} {:?} {scene:#?}", angles[index]);
            }
            // The bounds of other paths are made otherwise.
            let by_batch =
                kernel.reflect(&geometry, in_a_batch(&kernel, &geometry), false).total.relative_error();
            in_lanes[scene.parameters().model as usize] +=
                usize::from(!is_lost && bound != known && bound != by_batch);
            all += 1;
        }
    }
    assert!(all > 400_000, "{all}");
    assert!(in_lanes.into_iter().all(|count| count > all / 10), "{in_lanes:?} of {all}");
}
