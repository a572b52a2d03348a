//! The target `image` for cargo-fuzz.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| roughcast_fuzz::image(data));
