//! JSON bodies of diagrams.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| reflectance_fuzz::targets::json_diagrams(data));
