//! The library of shading models in each language, translated by naga.

use anyhow::{Context, Result};
use naga::ShaderStage;
use naga::back::{glsl, hlsl, msl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use roughcast::Named;
use roughcast::shading::Shading;
use roughcast::wgsl::{library, modules};

use super::guest::{with_guards, written};
use super::header::{header, models};
use super::names::with_plain_names;
use super::prefix::Prefix;
use super::stage::{fragment_shaders, modules_of};
use crate::UsageError;

/// A language of shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    Wgsl,
    Glsl,
    GlslEs300,
    Hlsl,
    Msl,
    Spirv,
}

impl Named for Language {
    fn all() -> &'static [Self] {
        &[Self::Wgsl, Self::Glsl, Self::GlslEs300, Self::Hlsl, Self::Msl, Self::Spirv]
    }

    fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::GlslEs300 => "glsl-es300",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
            Self::Spirv => "spirv",
        }
    }
}

/// Exported code.
pub enum Export {
    Text(String),
    Binary(Vec<u8>),
}

/// The named modules and their dependencies in a language, with prefixed names. SPIR-V is a whole shader, whose names
/// are private, so it has no prefix.
pub fn export(names: &[&str], language: Language, prefix: &Prefix) -> Result<Export> {
    let models: Vec<Shading> = models(&modules(names)?).collect();
    let needed = models.iter().flat_map(|model| modules_of(*model));
    let names: Vec<&str> = names.iter().copied().chain(needed).collect();
    let exported = modules(&names)?;
    let source = library(&names)?;
    let guarded = |generated: &str| {
        with_guards(&with_plain_names(generated), &exported, prefix).map_err(anyhow::Error::msg)
    };
    let code = match language {
        Language::Wgsl => {
            let code = written(&exported, prefix);
            parse(&code)?;
            code
        }
        Language::Glsl => {
            guarded(&to_glsl(&source, glsl::Version::Embedded { version: 310, is_webgl: false })?)?
        }
        Language::GlslEs300 => {
            guarded(&to_glsl(&source, glsl::Version::Embedded { version: 300, is_webgl: true })?)?
        }
        Language::Hlsl => guarded(&to_hlsl(&source)?)?,
        Language::Msl => guarded(&to_msl(&source)?)?,
        Language::Spirv => {
            if models.is_empty() {
                let line = "SPIR-V has no libraries, so it is exported as a fragment shader: name a model";
                return Err(UsageError(line.to_owned()).into());
            }
            let library = library(&[&names[..], &["detail", "reflectance"]].concat())?;
            let code = [library, fragment_shaders(&models)?].join("\n");
            return Ok(Export::Binary(to_spirv(&code)?));
        }
    };
    Ok(Export::Text(format!(
        "{}\n{}\n",
        header(&exported, &parse(&source)?.0, language, prefix),
        code.trim()
    )))
}

/// Parses WGSL and proves that it is valid.
pub fn parse(source: &str) -> Result<(naga::Module, ModuleInfo)> {
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| anyhow::anyhow!("{}", error.message().to_owned()))
        .context("the shader does not parse as WGSL")?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.into_inner())
        .context("the shader is not valid WGSL")?;
    Ok((module, info))
}

/// GLSL needs an entry point: an empty one is added as the last function and removed again. Its version and precisions
/// are left to the user.
fn to_glsl(source: &str, version: glsl::Version) -> Result<String> {
    const ENTRY_POINT: &str = "entry_point";
    let (module, info) = parse(&format!("{source}\n@fragment fn {ENTRY_POINT}() {{}}\n"))?;
    let options = glsl::Options {
        version,
        writer_flags: glsl::WriterFlags::INCLUDE_UNUSED_ITEMS,
        ..Default::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: ENTRY_POINT.to_owned(),
        multiview: None,
    };
    let mut code = String::new();
    glsl::Writer::new(&mut code, &module, &info, &options, &pipeline, BoundsCheckPolicies::default())?
        .write()?;
    let (library, _) = code.split_once("void main()").context("naga wrote GLSL without an entry point")?;
    let lines =
        library.lines().filter(|line| !line.starts_with("#version") && !line.starts_with("precision "));
    Ok(lines.collect::<Vec<_>>().join("\n"))
}

fn to_hlsl(source: &str) -> Result<String> {
    let (module, info) = parse(source)?;
    let options = hlsl::Options::default();
    let pipeline = hlsl::PipelineOptions::default();
    let mut code = String::new();
    hlsl::Writer::new(&mut code, &options, &pipeline).write(&module, &info, None)?;
    Ok(code)
}

fn to_msl(source: &str) -> Result<String> {
    let (module, info) = parse(source)?;
    let (code, _) =
        msl::write_string(&module, &info, &msl::Options::default(), &msl::PipelineOptions::default())?;
    Ok(code)
}

/// SPIR-V 1.0 with debug names for everything, in little-endian words.
fn to_spirv(source: &str) -> Result<Vec<u8>> {
    let (module, info) = parse(source)?;
    let options = spv::Options {
        flags: spv::WriterFlags::DEBUG | spv::WriterFlags::LABEL_VARYINGS,
        ..Default::default()
    };
    let words = spv::write_vec(&module, &info, &options, None)?;
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}
