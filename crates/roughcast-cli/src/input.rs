//! Loads a map, with errors that name the option to use.

use std::path::Path;

use anyhow::Result;
use roughcast_pipeline::Map;

use crate::args::SourceArgs;
use crate::refusals;

/// Reads a map and infers what the arguments do not specify. The error names the path.
pub fn read_map(path: &Path, args: &SourceArgs) -> Result<Map> {
    roughcast_pipeline::read_map(path, &args.map_options())
        .map_err(|error| refusals::of_read_map(path, error))
}
