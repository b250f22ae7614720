//! JSON bodies of images.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| reflectance_fuzz::targets::json_image_irradiance(data));
