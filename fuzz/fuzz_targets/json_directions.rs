//! JSON bodies of radiance, BRDF, plan and trade.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| reflectance_fuzz::targets::json_directions(data));
