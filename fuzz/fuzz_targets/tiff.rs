//! The target `tiff` for cargo-fuzz.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| roughcast_fuzz::tiff(data));
