//! Scenes of the right form through the planner, and the evaluation it plans.
#![no_main]

use reflectance_fuzz::scenes::Scene;

libfuzzer_sys::fuzz_target!(|scene: Scene| {
    reflectance_fuzz::planner::plan(&scene);
});
