//! Slopes from pixels, in f64, computed directly from the documented rules.

use roughcast::{
    Gradient, Green, HeightSense, Image, Kind, NormalChannels, NormalRange, Red, Samples, SourceCounts,
    SourceOptions, Wrap,
};

/// Level 0 of a map.
pub struct Slopes {
    pub width: usize,
    pub height: usize,
    /// (b.x, b.y), row by row from the top.
    pub texels: Vec<[f64; 2]>,
    pub counts: SourceCounts,
}

/// A sample as a number: unsigned types as 0 ..= 1, floats unchanged.
pub fn sample(image: &Image, x: usize, y: usize, channel: usize) -> f64 {
    let index = (y * image.width() + x) * image.channels() + channel;
    match image.samples() {
        Samples::U8(v) => f64::from(v[index]) / 255.0,
        Samples::U16(v) => f64::from(v[index]) / 65535.0,
        Samples::F16(v) => v[index].to_f64(),
        Samples::F32(v) => f64::from(v[index]),
    }
}

pub fn slopes(image: &Image, options: &SourceOptions) -> Slopes {
    let mut counts = SourceCounts::default();
    let mut read = Vec::new();
    for y in 0..image.height() {
        for x in 0..image.width() {
            read.push(match options.kind {
                Kind::Normal => slope_of_normal(image, options, x, y, &mut counts),
                Kind::Height => slope_of_height(image, options, x, y, &mut counts),
            });
        }
    }
    let (width, height) = (image.width(), image.height());
    let texel = |i: usize| match (read[i], options.kind) {
        (Some(slope), _) => slope,
        (None, Kind::Normal) => mean_around(&read, (width, height), i, options.wrap),
        (None, Kind::Height) => [0.0, 0.0],
    };
    Slopes { width, height, texels: (0..read.len()).map(texel).collect(), counts }
}

/// The mean slope of those of a texel's eight neighbours that have one.
fn mean_around(
    slopes: &[Option<[f64; 2]>],
    (width, height): (usize, usize),
    index: usize,
    wrap: Wrap,
) -> [f64; 2] {
    let (x, y) = ((index % width) as i64, (index / width) as i64);
    let mut found = Vec::new();
    for row in y - 1..=y + 1 {
        for column in x - 1..=x + 1 {
            if (column, row) != (x, y) {
                found.extend(slopes[inside(row, height, wrap) * width + inside(column, width, wrap)]);
            }
        }
    }
    let mean = |axis: usize| found.iter().map(|slope| slope[axis]).sum::<f64>() / found.len().max(1) as f64;
    [mean(0), mean(1)]
}

fn slope_of_normal(
    image: &Image,
    options: &SourceOptions,
    x: usize,
    y: usize,
    counts: &mut SourceCounts,
) -> Option<[f64; 2]> {
    let is_unsigned = matches!(image.samples(), Samples::U8(_) | Samples::U16(_));
    let component = |channel: usize| {
        let value = sample(image, x, y, channel);
        if is_unsigned || options.range == NormalRange::Unorm { 2.0 * value - 1.0 } else { value }
    };
    let (x_channel, y_channel) = match options.normal_channels {
        NormalChannels::Xyz | NormalChannels::Xy => (0, 1),
        NormalChannels::Yx => (1, 0),
        NormalChannels::Ag => (3, 1),
        NormalChannels::Ra => (0, 3),
        other => panic!("say where {other} has its components"),
    };
    let (nx, ny) = (component(x_channel), component(y_channel));
    let nz = if options.normal_channels == NormalChannels::Xyz {
        component(2)
    } else {
        if !(nx.is_finite() && ny.is_finite()) {
            counts.non_finite += 1;
            return None;
        }
        // Farther outside the unit disc than rounding and compression can move a normal: an empty background.
        if nx * nx + ny * ny > 1.2 {
            counts.invalid += 1;
            return None;
        }
        (1.0 - nx * nx - ny * ny).max(0.0).sqrt()
    };
    let scale = f64::from(options.normal_scale);
    let right = if options.red == Red::Left { -scale } else { scale };
    let up = if options.green == Green::Down { -scale } else { scale };
    repaired(right * nx, up * ny, nz, options, counts)
}

/// The slope of a normal, clamped to the length that the options allow; `None` if no surface can have the normal.
fn repaired(x: f64, y: f64, z: f64, options: &SourceOptions, counts: &mut SourceCounts) -> Option<[f64; 2]> {
    let longest = f64::from(options.max_slope.before_survey());
    let across = x.hypot(y);
    if !(x.is_finite() && y.is_finite() && z.is_finite()) {
        counts.non_finite += 1;
        None
    } else if z <= 0.0 {
        if across == 0.0 {
            counts.invalid += 1;
        } else {
            counts.behind += 1;
        }
        None
    } else if across / z <= longest {
        Some([x / z, y / z])
    } else {
        counts.clamped += 1;
        Some([x / across * longest, y / across * longest])
    }
}

/// The source index of a row or column next to the map's edge.
fn inside(index: i64, size: usize, wrap: Wrap) -> usize {
    let size = size as i64;
    let inside = match wrap {
        Wrap::Repeat => (index + size) % size,
        Wrap::Clamp if index < 0 => 0,
        Wrap::Clamp if index >= size => size - 1,
        // The edge is the line between two texels, so the first texel beyond it mirrors the edge texel.
        Wrap::Mirror if index < 0 => -1 - index,
        Wrap::Mirror if index >= size => 2 * size - 1 - index,
        _ => index,
    };
    inside as usize
}

fn slope_of_height(
    image: &Image,
    options: &SourceOptions,
    x: usize,
    y: usize,
    counts: &mut SourceCounts,
) -> Option<[f64; 2]> {
    let sense = if options.height_sense == HeightSense::WhiteDeep { -1.0 } else { 1.0 };
    let unit = sense * f64::from(options.height_scale) * image.width() as f64;
    // Columns go right, rows go up.
    let h = |right: i64, up: i64| {
        let column = inside(x as i64 + right, image.width(), options.wrap);
        let row = inside(y as i64 - up, image.height(), options.wrap);
        unit * sample(image, column, row, 0)
    };
    let (slope_right, slope_up) = match options.gradient {
        Gradient::Central => ((h(1, 0) - h(-1, 0)) / 2.0, (h(0, 1) - h(0, -1)) / 2.0),
        Gradient::Forward => (h(1, 0) - h(0, 0), h(0, 1) - h(0, 0)),
        Gradient::Sobel => {
            let mut right = 0.0;
            let mut up = 0.0;
            for (offset, weight) in [(-1, 1.0), (0, 2.0), (1, 1.0)] {
                right += weight * (h(1, offset) - h(-1, offset)) / 8.0;
                up += weight * (h(offset, 1) - h(offset, -1)) / 8.0;
            }
            (right, up)
        }
    };
    // A texel without a height has no slope, even if the gradient does not read the texel itself.
    let hole = if h(0, 0).is_finite() { 0.0 } else { f64::NAN };
    repaired(-slope_right + hole, -slope_up, 1.0, options, counts)
}
