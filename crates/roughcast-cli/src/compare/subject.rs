//! The maps that are compared: the given one, and two that a single Gaussian cannot describe.

use anyhow::{Context, Result};
use roughcast::{Gradient, HeightSense, Image, Kind, SourceOptions};
use roughcast_io::{ReadOptions, read_image};
use roughcast_pipeline::Map;
use roughcast_scene::View;
use roughcast_scene::pattern::v_grooves;

/// A map and its views.
pub struct Subject {
    /// Its name in the rows of the results.
    pub name: String,
    pub image: Image,
    pub options: SourceOptions,
    pub views: Vec<View>,
    /// What kind of map it is, for the report.
    pub about: String,
}

/// Texels along each side of the grooves.
const GROOVED_TEXELS: usize = 512;
/// Sixteen texels each: a pixel of the far view covers one and a half grooves.
const GROOVES: usize = 32;
/// Both of their highlights are in the picture of a plane, and separate for exponents above 100.
const GROOVE_SLOPE: f64 = 0.15;

/// A quarter of the texels of a height map from Godot's demonstration projects; its licence is stored next to it.
const WOOL: &[u8] = include_bytes!("../../assets/wool_depth.png");

/// The views in which individual bumps are too small to be visible, but still within the range of the textures' levels.
const LIMIT_VIEWS: [View; 2] = [View::Mid, View::Far];

impl Subject {
    /// The user's map.
    pub fn given(name: String, map: Map, views: Vec<View>) -> Self {
        let (width, height) = (map.image.width(), map.image.height());
        let about = format!("{} map of {width}x{height} texels ({})", map.options.kind, map.info.format);
        Self { name, image: map.image, options: map.options, views, about }
    }

    /// The maps on which LEAN reaches its limit (LEAN, section 6: sharp V grooves, woven cloth).
    pub fn limits() -> Result<[Self; 2]> {
        Ok([v_groove(), wool()?])
    }
}

fn v_groove() -> Subject {
    let pattern = v_grooves(GROOVED_TEXELS, GROOVES, GROOVE_SLOPE);
    // Differences between neighbours keep the grooves sharp; wider filters would round their edges.
    let options = pattern.source_options().with_gradient(Gradient::Forward);
    Subject {
        name: "v-groove".to_owned(),
        image: pattern.heights,
        options,
        views: LIMIT_VIEWS.to_vec(),
        about: format!(
            "{GROOVES} sharp V grooves over {GROOVED_TEXELS}x{GROOVED_TEXELS} texels, computed by formula: slopes of \
             {GROOVE_SLOPE} to one side and to the other, and nothing between"
        ),
    }
}

fn wool() -> Result<Subject> {
    let image =
        read_image(WOOL, Some("png"), &ReadOptions::default()).context("the wool map of the program")?.image;
    let (width, height) = (image.width(), image.height());
    Ok(Subject {
        name: "wool".to_owned(),
        image,
        options: SourceOptions::default().with_kind(Kind::Height).with_height_sense(HeightSense::WhiteDeep),
        views: LIMIT_VIEWS.to_vec(),
        about: format!(
            "a woven cloth, height map of {width}x{height} texels in 8 bits, from Godot's demonstration projects (MIT licence): \
             threads in two directions"
        ),
    })
}

#[cfg(test)]
mod tests {
    use roughcast::Bake;

    use super::*;

    #[test]
    fn the_grooves_have_two_slopes_and_little_between() {
        let subject = v_groove();
        let levels = Bake::of(&subject.image).source(subject.options).moments().expect("a map");
        let slopes = levels[0].moments().iter().map(|moments| f64::from(moments.mean.x));
        let steep = slopes.filter(|x| (x.abs() - GROOVE_SLOPE).abs() < 1e-3).count();
        // All except the two texels of each groove whose gradient spans both of its sides.
        assert_eq!(steep, GROOVED_TEXELS * (GROOVED_TEXELS - 2 * GROOVES));
    }

    #[test]
    fn the_wool_is_included() {
        let wool = wool().expect("a picture");
        assert_eq!((wool.image.width(), wool.image.height(), wool.image.channels()), (512, 512, 1));
    }
}
