//! Laws of the shading models, and their accuracy against formulas in f64.

mod accuracy;
mod energy;
mod footprint;
mod likeness;
mod oracle;
mod physical;
mod reflectance;
mod sturdy;
mod support;
