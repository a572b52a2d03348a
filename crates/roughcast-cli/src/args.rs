//! Arguments that several subcommands share, and how they are parsed.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use roughcast::{
    Gradient, Green, HeightSense, Kind, MaxSlope, Named, NormalChannels, NormalRange, Red, Wrap,
};
use roughcast_io::{Limits, ReadOptions};
use roughcast_pipeline::{MapOptions, SPECULAR_POWERS};

/// Words from other tools, and this program's equivalents.
const OTHER_WORDS: &[(&str, &str)] = &[
    ("float16", "half"),
    ("half-float", "half"),
    ("f16", "half"),
    ("fp16", "half"),
    ("16f", "half"),
    ("float32", "float"),
    ("f32", "float"),
    ("fp32", "float"),
    ("32f", "float"),
    ("32", "float"),
    ("uint8", "8"),
    ("unorm8", "8"),
    ("uint16", "16"),
    ("unorm16", "16"),
    ("opengl", "up"),
    ("directx", "down"),
    ("dx", "down"),
    ("gl", "up"),
    ("bc5", "bc"),
    ("bc7", "bc"),
    ("smoothness", "gloss"),
    ("glossiness", "gloss"),
    ("webgl", "web"),
    ("webgpu", "web"),
    ("native", "desktop"),
    ("periodic", "repeat"),
    ("arm", "orm"),
];

/// A parser for the names of an enum's variants.
pub fn one_of<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    one_of_or_advice(OTHER_WORDS)
}

/// A parser for the names of an enum's variants that gives advice on other words, see [`WordParser`].
pub fn one_of_or_advice<T: Named + Send + Sync>(
    others: &'static [(&'static str, &'static str)],
) -> impl TypedValueParser<Value = T> {
    let words = T::all().iter().map(|variant| variant.name()).collect();
    WordParser { words, others }.map(|name| {
        let named = T::all().iter().copied().find(|variant| variant.name() == name);
        named.expect("the parser accepts only names")
    })
}

/// Accepts certain words, and suggests the right one for others.
#[derive(Clone)]
pub struct WordParser {
    /// The accepted words.
    pub words: Vec<&'static str>,
    /// Other words, each with the right one, or with a sentence that explains why there is no equivalent.
    pub others: &'static [(&'static str, &'static str)],
}

impl TypedValueParser for WordParser {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<String, clap::Error> {
        let parser = PossibleValuesParser::new(self.words.iter().copied());
        let told = value.to_str().and_then(|text| self.hint(text));
        parser.parse_ref(command, argument, value).map_err(|error| match (told, argument) {
            (Some(hint), Some(argument)) => clap::Error::raw(
                clap::error::ErrorKind::InvalidValue,
                format!("invalid value '{}' for '{argument}': {hint}\n\n", value.to_string_lossy()),
            ),
            _ => error,
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = clap::builder::PossibleValue> + '_>> {
        Some(Box::new(self.words.iter().map(clap::builder::PossibleValue::new)))
    }
}

impl WordParser {
    /// Advice that names this program's word for another tool's.
    fn hint(&self, text: &str) -> Option<String> {
        let lower = text.to_ascii_lowercase();
        let (_, meant) = self
            .others
            .iter()
            .find(|(other, meant)| *other == lower && (meant.contains(' ') || self.words.contains(meant)))?;
        Some(if meant.contains(' ') { (*meant).to_owned() } else { format!("use '{meant}'") })
    }
}

/// A Blinn-Phong exponent.
pub fn specular_power(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(power) if SPECULAR_POWERS.contains(&power) => Ok(power),
        _ => {
            Err(format!("it must be a number from {} to {}", SPECULAR_POWERS.start(), SPECULAR_POWERS.end()))
        }
    }
}

/// A number above zero.
pub fn positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("it must be a number above zero".to_owned()),
    }
}

/// A number.
pub fn finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("it must be a number".to_owned()),
    }
}

fn max_slope(text: &str) -> Result<MaxSlope, String> {
    match text {
        "auto" => Ok(MaxSlope::Auto),
        _ => match positive(text)? {
            limit if limit <= MaxSlope::LARGEST => Ok(MaxSlope::Limit(limit)),
            _ => Err(format!("it must be at most {:e}", MaxSlope::LARGEST)),
        },
    }
}

/// Headings under which the help lists options of several subcommands.
pub const READING: &str = "Reading the map";
pub const REPORT: &str = "Report";

/// How to read the input.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = READING)]
pub struct SourceArgs {
    /// What the picture contains [default: decided from its pixels; an error if they are ambiguous]
    #[arg(long, value_name = "KIND", value_parser = one_of::<Kind>())]
    pub kind: Option<Kind>,

    /// Channels to read, by name and in the order x, y, z; one for a height [default: the unambiguous ones]
    #[arg(long, value_name = "NAME[,NAME...]", value_delimiter = ',')]
    pub channels: Vec<String>,

    /// Layer or part of an EXR to read, by name: ViewLayer.Normal, N; image of a TIFF, by number [default: the
    /// unambiguous one; for a TIFF the first]
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,

    /// Which way green points in a normal map: up is OpenGL and glTF, down is DirectX [default: up; in a folder,
    /// according to the file's name]
    #[arg(long, value_parser = one_of::<Green>())]
    pub green: Option<Green>,

    /// Which way red points in a normal map
    #[arg(long, default_value = "right", value_parser = one_of::<Red>())]
    pub red: Red,

    /// Strength of a normal map: a factor for x and y, as glTF's normalTexture.scale
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true)]
    pub normal_scale: Option<f32>,

    /// How a normal's components are stored: unorm, 0 to 1, where 0.5 is zero, as in pictures; or signed, -1 to 1
    /// [default: from the file's format; for floats, from the pixels]
    #[arg(long, value_parser = one_of::<NormalRange>())]
    pub range: Option<NormalRange>,

    /// Channels that contain the normal: xyz; xy or yx, the first two (z is computed); ag, x in alpha and y in green
    /// ("DXT5nm", BC3n, RXGB); or ra, x in red, y in alpha (KTX's normal mode) [default: decided from the file and its
    /// pixels]
    #[arg(long, value_name = "CHANNELS", value_parser = one_of::<NormalChannels>())]
    pub normal_channels: Option<NormalChannels>,

    /// Height of a value of 1 (white), as a fraction of the map's width: 0.02 is 20 texels on a map 1000 texels wide.
    /// For heights in metres 1 / (width in pixels x metres per pixel) [default: 0.02]
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true)]
    pub height_scale: Option<f32>,

    /// Treat white as deep: the map contains depths
    #[arg(long)]
    pub invert_height: bool,

    /// How the slopes of a height map are estimated
    #[arg(long, default_value = "sobel", value_parser = one_of::<Gradient>())]
    pub gradient: Gradient,

    /// What lies beyond the edge of the map: the map again, its edge texels, or its mirror image
    #[arg(long, default_value = "repeat", value_parser = one_of::<Wrap>())]
    pub wrap: Wrap,

    /// Maximum slope (tangent of the angle; 1 is 45 degrees); steeper texels are clamped to it and counted. auto: 128,
    /// or less for 8 and 16 bits if the steepest 0.1 % of the texels cost much precision
    #[arg(long, value_name = "auto|X", default_value = "auto", value_parser = max_slope)]
    pub max_slope: MaxSlope,

    /// Maximum number of pixels in a file
    #[arg(long, value_name = "N", default_value_t = Limits::default().max_pixels, value_hint = ValueHint::Other)]
    pub max_pixels: u64,
}

impl SourceArgs {
    /// How much a reader may allocate.
    pub fn limits(&self) -> Limits {
        Limits::of_pixels(self.max_pixels)
    }

    /// How the file is read.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions::default()
            .with_limits(self.limits())
            .with_layer(self.layer.clone())
            .with_channels(self.channels.clone())
    }

    /// The library's options for reading the map.
    pub fn map_options(&self) -> MapOptions {
        let mut options = MapOptions::default();
        options.read = self.read_options();
        options.kind = self.kind;
        options.green = self.green;
        options.red = self.red;
        options.normal_scale = self.normal_scale;
        options.range = self.range;
        options.normal_channels = self.normal_channels;
        options.height_scale = self.height_scale;
        options.height_sense =
            if self.invert_height { HeightSense::WhiteDeep } else { HeightSense::WhiteHigh };
        options.gradient = self.gradient;
        options.wrap = self.wrap;
        options.max_slope = self.max_slope;
        options
    }
}
