//! Laws of the shading models, and their accuracy against formulas in f64.

mod accuracy;
mod energy;
mod likeness;
mod oracle;
mod reflectance;
mod sturdy;
mod support;
