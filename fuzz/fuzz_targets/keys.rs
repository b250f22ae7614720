//! Files of keys.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| reflectance_fuzz::targets::keys(data));
