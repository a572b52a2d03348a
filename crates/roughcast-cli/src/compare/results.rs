//! The numbers of a comparison, as `results.json` holds them.

use roughcast::shading::Shading;
use roughcast_scene::{Filter, View};
use serde_json::{Value, json};

/// How far one method with one filter is from the truth of its base lobe.
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
    /// Relative error of the energy of the highlight, as a part of the truth's; negative where it is too dark.
    pub energy: f64,
    /// Temporal variance in excess of the truth's, in radiance squared; `None` if it was not measured.
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
