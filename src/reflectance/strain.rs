//! Which assumptions of the models a scene strains, each with the number behind it.

use super::directions::Directions;
use super::findings::{Omitted, Warning, WarningCode};
use super::requirement;
use super::scene::Scene;

/// What a caller should know of a scene in these directions before any of its numbers.
pub(super) fn warnings(
    scene: &Scene,
    needed: &Scene,
    directions: &Directions,
    omitted: &[Omitted],
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if requirement::lacks_sensor(scene) {
        let share = omitted.last().and_then(|spike| spike.bound);
        if share.is_none_or(|share| share > scene.parameters().accuracy.relative_tolerance.get()) {
            warnings.push(Warning::of_scene(WarningCode::SpikeWithoutSensor, share, None));
        }
    }
    let unused = scene.unused().into_iter();
    warnings.extend(unused.map(|name| Warning::of_scene(WarningCode::ParameterNotUsed, None, Some(name))));
    warnings
}
