//! Counts a shader's instructions in its SPIR-V: the second line of LEAN Figure 12, which has Direct3D's counts.

use std::collections::HashMap;

use anyhow::{Context, Result};
use naga::back::spv;

use crate::shader::parse;

/// Instructions of a shader. A vector instruction counts once, a called function once per call, the body of a loop
/// once, and both sides of a branch count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instructions {
    /// Arithmetic, comparisons, selections, conversions and the functions of GLSL.std.450.
    pub alu: u64,
    /// Reads of textures.
    pub texture: u64,
}

/// Counts the instructions reachable from an entry point of a WGSL module, as compiled by naga, which does not
/// optimise.
pub fn count(source: &str, entry_point: &str) -> Result<Instructions> {
    let (module, info) = parse(source)?;
    let words = spv::write_vec(&module, &info, &spv::Options::default(), None)?;
    let program = Program::of(&words);
    let id = program
        .entry_points
        .get(entry_point)
        .with_context(|| format!("the shader has no entry point '{entry_point}'"))?;
    Ok(program.reached_from(*id, &mut HashMap::new()))
}

/// Words before the first instruction.
const HEADER_WORDS: usize = 5;

/// Opcodes of the SPIR-V specification, section 3.49.
mod op {
    use std::ops::RangeInclusive;

    pub const EXT_INST: u32 = 12;
    pub const ENTRY_POINT: u32 = 15;
    pub const FUNCTION: u32 = 54;
    pub const FUNCTION_CALL: u32 = 57;
    /// OpImageSampleImplicitLod to OpImageSampleProjDrefExplicitLod, OpImageFetch, OpImageGather, OpImageDrefGather.
    pub const TEXTURE: RangeInclusive<u32> = 87..=97;
    /// Arithmetic instructions. Excludes those that only move or name values: loads, stores, access chains, shuffles,
    /// composites, bit casts, and control flow.
    pub const ALU: [RangeInclusive<u32>; 6] = [
        EXT_INST..=EXT_INST,
        109..=116, // OpConvertFToU ... OpConvertUToF, OpUConvert, OpSConvert, OpFConvert, OpQuantizeToF16
        126..=152, // OpSNegate, OpFNegate, OpIAdd, OpFAdd ... OpVectorTimesScalar ... OpDot ... OpSMulExtended
        154..=191, // OpAny ... OpLogicalNot, OpSelect, OpIEqual ... OpFUnordGreaterThanEqual
        194..=205, // OpShiftRightLogical ... OpBitwiseAnd, OpNot ... OpBitCount
        207..=215, // OpDPdx ... OpFwidthCoarse
    ];
}

/// The parts of a module that are counted.
#[derive(Default)]
struct Program {
    entry_points: HashMap<String, u32>,
    functions: HashMap<u32, Function>,
}

#[derive(Default)]
struct Function {
    own: Instructions,
    /// The called functions, each listed once per call.
    calls: Vec<u32>,
}

impl Program {
    fn of(words: &[u32]) -> Self {
        let mut program = Self::default();
        // Before the first function there are only types and constants, which are not counted.
        let mut current = 0;
        for (opcode, operands) in instructions(words) {
            match (opcode, operands) {
                (op::ENTRY_POINT, [_, id, name @ ..]) => {
                    program.entry_points.insert(text(name), *id);
                }
                (op::FUNCTION, [_, id, ..]) => {
                    current = *id;
                    program.functions.insert(current, Function::default());
                }
                (op::FUNCTION_CALL, [_, _, callee, ..]) => {
                    program.functions.entry(current).or_default().calls.push(*callee);
                }
                _ => {
                    let own = &mut program.functions.entry(current).or_default().own;
                    own.alu += u64::from(op::ALU.iter().any(|range| range.contains(&opcode)));
                    own.texture += u64::from(op::TEXTURE.contains(&opcode));
                }
            }
        }
        program
    }

    /// A function's own instructions and those of all functions that it calls. SPIR-V has no recursion.
    fn reached_from(&self, id: u32, known: &mut HashMap<u32, Instructions>) -> Instructions {
        if let Some(sum) = known.get(&id) {
            return *sum;
        }
        let Some(function) = self.functions.get(&id) else { return Instructions::default() };
        let sum = function.calls.iter().fold(function.own, |sum, callee| {
            let called = self.reached_from(*callee, known);
            Instructions { alu: sum.alu + called.alu, texture: sum.texture + called.texture }
        });
        known.insert(id, sum);
        sum
    }
}

/// The opcodes with their operands.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut rest = words.get(HEADER_WORDS..).unwrap_or_default();
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let (length, opcode) = ((first >> 16) as usize, first & 0xffff);
        let (instruction, after) = rest.split_at_checked(length.max(1))?;
        rest = after;
        Some((opcode, &instruction[1..]))
    })
}

/// A string, which ends with its first zero byte.
fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<_>>()).into_owned()
}

#[cfg(test)]
mod tests {
    use roughcast::Anisotropy;
    use roughcast::shading::Shading;
    use roughcast::texture::TexelReader;
    use roughcast_gpu::render::{DetailSource, ShaderKey, shader_source};

    use super::*;

    /// Two calls of an addition; two texture reads; an addition, a comparison, a selection, a maximum, a product.
    const KNOWN: &str = "
        @group(0) @binding(0) var map: texture_2d<f32>;
        @group(0) @binding(1) var map_sampler: sampler;
        fn twice(x: f32) -> f32 { return x + x; }
        fn texel(uv: vec2f) -> vec4f { return textureSample(map, map_sampler, uv); }
        fn nobody_calls(x: f32) -> f32 { return sqrt(x) * x / 3.0; }
        @fragment fn shade(@location(0) uv: vec2f) -> @location(0) vec4f {
            let a = twice(uv.x);
            let b = twice(a);
            let texels = texel(uv) + texel(uv.yx);
            return texels * select(uv.y, max(a, b), a < b);
        }
        @fragment fn plain(@location(0) colour: vec4f) -> @location(0) vec4f { return colour; }
        @fragment fn counter(@location(0) @interpolate(flat) n: u32) -> @location(0) vec4f {
            return vec4f(f32(n << 2u));
        }
    ";

    #[test]
    fn a_shader_of_known_instructions_has_that_many() {
        let counted = |entry_point| count(KNOWN, entry_point).expect("it is valid");
        assert_eq!(counted("shade"), Instructions { alu: 2 + 5, texture: 2 });
        assert_eq!(counted("plain"), Instructions::default());
        // A shift and a conversion.
        assert_eq!(counted("counter"), Instructions { alu: 2, texture: 0 });
    }

    #[test]
    fn uncountable_shaders_are_errors() {
        assert!(count(KNOWN, "twice").is_err(), "it is not an entry point");
        assert!(count("fn", "shade").is_err());
    }

    fn reader(shading: Shading) -> &'static TexelReader {
        let reader = shading.layout().texel_reader(shading.wanted(), Anisotropy::Isotropic);
        reader.expect("every model samples its layout")
    }

    #[test]
    fn models_read_their_textures_and_lean_costs_more_than_blinn_phong() {
        let counted = |shading: Shading| {
            let key = ShaderKey::new(shading, DetailSource::Textures(reader(shading)));
            count(&shader_source(&key).expect("the library has it"), "radiance").expect("it is valid")
        };
        for shading in Shading::ALL {
            let inputs = reader(*shading).inputs.len() as u64;
            assert_eq!(counted(*shading).texture, inputs, "{shading}");
        }
        assert!(counted(Shading::Lean).alu > counted(Shading::BlinnPhong).alu);
    }
}
