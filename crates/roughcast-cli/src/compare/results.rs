//! The numbers of a comparison, as in `results.json`.

use roughcast::shading::Shading;
use roughcast_scene::{Filter, View};
use serde_json::{Value, json};

/// The error of one method with one filter against the ground truth of its reference.
#[derive(Clone, Debug)]
pub struct Row {
    pub map: String,
    pub scene: String,
    pub view: View,
    pub method: Shading,
    pub filter: Filter,
    /// Root mean square error, in linear radiance.
    pub rmse: f64,
    /// Mean error of HDR-FLIP, 0 to 1.
    pub flip: f64,
    /// Relative error of the highlight's energy, as a fraction of the ground truth's; negative if it is too dark.
    pub energy: f64,
    /// Temporal variance in excess of the ground truth's, in radiance squared; `None` if it was not measured.
    pub flicker: Option<f64>,
}

impl Row {
    pub fn json(&self) -> Value {
        json!({
            "map": self.map,
            "scene": self.scene,
            "view": self.view.name(),
            "method": self.method.name(),
            "filter": self.filter.name(),
            "rmse": self.rmse,
            "flip": self.flip,
            "energy": self.energy,
            "flicker": self.flicker,
        })
    }
}
