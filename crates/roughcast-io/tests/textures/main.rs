//! Tests KTX2, DDS and block compression with real files and independent readers.

mod blocks;
mod broken;
mod foreign_files;
mod ktx2_reader;
mod round_trip;
mod same_picture;
mod support;
