//! The target `ktx2` for cargo-fuzz.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| roughcast_fuzz::ktx2(data));
