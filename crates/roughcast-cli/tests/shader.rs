//! `roughcast shader`: every export of every model compiles with the compilers of its language, and so do the calls in
//! its header and the examples of docs/shaders.md.

mod common;

use std::path::{Path, PathBuf};
use std::process::Command;

use common::run;
use roughcast::shading::Shading;
use roughcast::wgsl::{MODULES, Role};

const TEXTS: [&str; 5] = ["wgsl", "glsl", "glsl-es300", "hlsl", "msl"];

/// The names that the program lists.
fn names() -> Vec<String> {
    let list = run(["shader", "--json"]).expect_success().json();
    let entries = list.as_array().expect("the list is an array");
    let names =
        entries.iter().map(|entry| entry["name"].as_str().expect("every export has a name").to_owned());
    let names: Vec<_> = names.collect();
    // Reflectance, five modules of bumps, and two that mix them.
    assert_eq!(names.len(), Shading::ALL.len() + 8, "{names:?}");
    names
}

fn exported(names: &[&str], language: &str) -> String {
    let arguments = [&["shader"], names, &["--lang", language]].concat();
    run(&arguments).expect_success().stdout
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shader");
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    folder
}

/// Runs a compiler or validator; if it is not installed, names the Debian package that contains it.
fn tool(program: &str, package: &str, arguments: &[&str]) -> Result<(), String> {
    let output = Command::new(program).args(arguments).output();
    let output =
        output.unwrap_or_else(|fault| panic!("{program}: {fault}: install the Debian package {package}"));
    let said = [output.stdout, output.stderr].concat();
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&said).into_owned()) }
}

fn valid_spirv(file: &Path) -> Result<(), String> {
    tool("spirv-val", "spirv-tools", &["--target-env", "vulkan1.0", path(file)])
}

fn path(file: &Path) -> &str {
    file.to_str().expect("the path of the target folder is plain text")
}

/// Compiles a complete shader whose pixel entry point is `main` or `shade`.
fn compile(code: &str, language: &str, name: &str) -> Result<(), String> {
    let file = folder().join(format!("{name}.{language}"));
    std::fs::write(&file, code).expect("the shader can be written");
    match language {
        "wgsl" => validate_wgsl(code),
        "glsl" | "glsl-es300" => tool("glslangValidator", "glslang-tools", &["-S", "frag", path(&file)]),
        "hlsl" => {
            let spirv = file.with_extension("hlsl.spv");
            let arguments = ["-D", "-V", "-S", "frag", "-e", "shade", "-o", path(&spirv), path(&file)];
            tool("glslangValidator", "glslang-tools", &arguments)?;
            valid_spirv(&spirv)
        }
        other => panic!("no compiler of {other} is known"),
    }
}

fn validate_wgsl(code: &str) -> Result<(), String> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let module = naga::front::wgsl::parse_str(code).map_err(|error| error.emit_to_string(code))?;
    let validated = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
    validated.map(drop).map_err(|error| error.emit_to_string(code))
}

/// Converts a desktop shader to OpenGL ES.
fn for_es(code: &str) -> String {
    let start = "#version 310 es\nprecision highp float;\nprecision highp sampler2DArray;";
    assert!(code.starts_with("#version 450"));
    code.replacen("#version 450", start, 1)
}

/// The first lines of a WebGL 2 shader.
const WEBGL: &str = "#version 300 es\nprecision highp float;\nprecision highp int;";

/// The code of an export, without comments.
fn code_of(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_list_has_a_line_for_every_export() {
    let list = run(["shader"]).expect_success().stdout;
    let listed: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(listed, names());
    assert!(Shading::ALL.iter().all(|model| listed.contains(&model.name())));
}

#[test]
fn every_export_starts_with_source_conventions_and_calls() {
    for name in names() {
        for language in TEXTS {
            let text = exported(&[&name], language);
            let header: Vec<_> = text.lines().take_while(|line| line.starts_with("//")).collect();
            let header = header.join("\n");
            for part in ["Source: ", "Conventions:", "tangent frame", "Packing, for textures", "How to call"]
            {
                assert!(header.contains(part), "{name}, {language}: no '{part}' in\n{header}");
            }
            assert!(header.contains(&format!("\n// {name}: ")), "{name}, {language}");
            assert!(header.lines().all(|line| line.chars().count() <= 120), "{name}, {language}\n{header}");
            let function = match name.as_str() {
                "reflectance" => "rc_schlick(",
                "surface-gradient" => "rc_perturbed_normal(",
                "geometric" => "rc_geometric_covariance(",
                "noise" => "rc_noise_distribution(",
                "layers" => "rc_correlated_layers(",
                "waves" => "rc_wave_distribution(",
                "gabor-noise" => "rc_gabor_sample(",
                "normal-blends" => "rc_blend_reoriented(",
                _ => "_lobe(",
            };
            assert!(code_of(&text).contains(function), "{name}, {language}");
        }
    }
}

/// Identifiers that naga has extended: `view_3`, `lean1_`, padding. Its temporaries (`_e7` and, in HLSL, the struct's
/// name in lower case) have no original name to preserve.
fn mangled(code: &str) -> Vec<&str> {
    let temporaries: Vec<String> = library_names().iter().map(|name| name.to_ascii_lowercase()).collect();
    let is_temporary = |base: &str| temporaries.iter().any(|name| name == base);
    let words = code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let is_mangled = |word: &&str| {
        let numbered = word.rsplit_once('_').is_some_and(|(base, number)| {
            !base.is_empty() && number.chars().all(|c| c.is_ascii_digit()) && !is_temporary(base)
        });
        numbered || word.contains("pad")
    };
    words.filter(is_mangled).collect()
}

#[test]
fn names_keep_their_spelling() {
    for name in names().iter().map(String::as_str).chain(["all"]) {
        for language in TEXTS {
            let code = code_of(&exported(&[name], language));
            assert_eq!(mangled(&code), Vec::<&str>::new(), "{name}, {language}");
        }
    }
    assert_eq!(
        mangled("float f(float view_1, vec4 lean1_) { int _pad0; _e3 }"),
        ["view_1", "lean1_", "_pad0"]
    );
}

/// Syntax of a language in which the calls of a header are tested.
struct Dialect {
    language: &'static str,
    vec4: &'static str,
    vec3: &'static str,
    /// The start of the pixel entry point; its body follows.
    entry: &'static str,
    exit: &'static str,
}

const DIALECTS: [Dialect; 2] = [
    Dialect {
        language: "glsl",
        vec4: "vec4",
        vec3: "vec3",
        entry: "layout(std140, binding = 0) uniform Material { rc_Packing packing; rc_ShadingOptions options; vec4 given; };
            layout(location = 0) out vec4 colour;
            void main() {",
        exit: "colour = vec4(lobe * distribution.normal, 1.0); }",
    },
    Dialect {
        language: "hlsl",
        vec4: "float4",
        vec3: "float3",
        entry: "cbuffer Material : register(b0) { rc_Packing packing; rc_ShadingOptions options; float4 given; };
            float4 shade() : SV_Target {",
        exit: "return float4(lobe * distribution.normal, 1.0); }",
    },
];

/// The statements that the header of a model's export lists, and the texels that they need.
fn calls(text: &str) -> (Vec<String>, Vec<String>) {
    let header = text.lines().take_while(|line| line.starts_with("//"));
    let mut lines = header.skip_while(|line| !line.contains(", with the texels "));
    let (_, texels) = lines.next().and_then(|line| line.split_once(", with the texels ")).expect("texels");
    let texels = texels.trim_end_matches(':').split(", ").map(str::to_owned).collect();
    // Long ones are wrapped.
    let indented: Vec<&str> = lines.map_while(|line| line.strip_prefix("//     ")).map(str::trim).collect();
    let statements = indented.join(" ");
    (texels, statements.split_terminator(';').map(|statement| statement.trim().to_owned()).collect())
}

/// A shader that makes the calls in the header.
fn caller(text: &str, dialect: &Dialect) -> String {
    let Dialect { vec4, vec3, entry, exit, .. } = dialect;
    let (texels, statements) = calls(text);
    let mut code = format!("{text}\n{entry}\n");
    for texel in &texels {
        code += &format!("{vec4} {texel} = given;\n");
    }
    code += &format!("{vec3} view = given.xyz; {vec3} light = given.zyx;\n");
    if text.contains(" rc_whole_footprint()") {
        code += "rc_FootprintRatio ratio = rc_whole_footprint();\n";
    }
    assert!(statements.len() >= 3, "{statements:?}");
    for statement in statements {
        let (value, call) = statement.split_once(" = ").expect("a call gives a value");
        let function = call.split('(').next().expect("a call has a function");
        let definition = text.lines().find(|line| {
            !line.starts_with("//")
                && line
                    .split_whitespace()
                    .nth(1)
                    .is_some_and(|word| word.starts_with(&format!("{function}(")))
        });
        let definition = definition.unwrap_or_else(|| panic!("{function} is not defined in\n{text}"));
        let kind = definition.split_whitespace().next().expect("a definition starts with its type");
        code += &format!("{kind} {value} = {call};\n");
    }
    code + exit
}

#[test]
fn the_calls_of_every_header_compile() {
    for model in Shading::ALL {
        for dialect in &DIALECTS {
            let text = exported(&[model.name(), "reflectance"], dialect.language);
            let code = caller(&text, dialect);
            let name = format!("calls-{model}");
            match dialect.language {
                "glsl" => {
                    let desktop = format!("#version 450\n{code}");
                    compile(&desktop, "glsl", &name).unwrap_or_else(|said| panic!("{model}: {said}"));
                    compile(&for_es(&desktop), "glsl", &format!("{name}-es"))
                        .unwrap_or_else(|said| panic!("{model}, ES: {said}"));
                }
                language => compile(&code, language, &name).unwrap_or_else(|said| panic!("{model}: {said}")),
            }
        }
    }
}

#[test]
fn every_export_compiles_on_its_own() {
    for name in names().iter().map(String::as_str).chain(["all"]) {
        let file = format!("alone-{name}");
        let text = |language| exported(&[name], language);
        validate_wgsl(&text("wgsl")).unwrap_or_else(|said| panic!("{name}: {said}"));
        let glsl = format!("#version 450\n{}\nvoid main() {{}}\n", text("glsl"));
        compile(&glsl, "glsl", &file).unwrap_or_else(|said| panic!("{name}: {said}"));
        compile(&for_es(&glsl), "glsl", &format!("{file}-es"))
            .unwrap_or_else(|said| panic!("{name}: {said}"));
        let webgl = format!("{WEBGL}\n{}\nvoid main() {{}}\n", text("glsl-es300"));
        compile(&webgl, "glsl-es300", &file).unwrap_or_else(|said| panic!("{name}: {said}"));
        let hlsl = format!("{}\nfloat4 shade() : SV_Target {{ return 0.0; }}\n", text("hlsl"));
        compile(&hlsl, "hlsl", &file).unwrap_or_else(|said| panic!("{name}: {said}"));
        let msl = text("msl");
        assert_eq!(msl.matches('{').count(), msl.matches('}').count(), "{name}");
    }
}

/// Every global name that can be exported, as spelled in WGSL.
fn library_names() -> Vec<&'static str> {
    let exported = MODULES.iter().filter(|module| !matches!(module.role, Role::Bake | Role::Detail));
    let lines = exported.flat_map(|module| module.source.lines());
    let names = lines.filter_map(|line| {
        let after = ["const ", "struct ", "fn "].iter().find_map(|keyword| line.strip_prefix(keyword))?;
        after.split([':', ' ', '(']).next()
    });
    names.collect()
}

/// A host's shader that defines macros with the library's names and contains two exports.
fn as_guests(exports: [&str; 2], language: &str, prefix: &[&str]) -> String {
    // Members of structs belong to the library: no caller defines a macro of their name.
    let is_member = |name: &str| ["covariance", "variance", "lobe"].contains(&name);
    let macros = library_names().into_iter().filter(|name| !is_member(name));
    let macros: Vec<_> = macros.map(|name| format!("#define {name} ) not a name (\n")).collect();
    let text =
        |name| run([&["shader", name, "--lang", language][..], prefix].concat()).expect_success().stdout;
    let texts = exports.map(text).join("\n");
    match language {
        "glsl" => format!("#version 450\n{}{texts}\nvoid main() {{}}\n", macros.concat()),
        "glsl-es300" => format!("{WEBGL}\n{}{texts}\nvoid main() {{}}\n", macros.concat()),
        _ => format!("{}{texts}\nfloat4 shade() : SV_Target {{ return 0.0; }}\n", macros.concat()),
    }
}

#[test]
fn exports_can_be_pasted_together() {
    assert!(library_names().contains(&"TWO_PI") && library_names().contains(&"gaussian_lobe"));
    for language in ["glsl", "glsl-es300", "hlsl"] {
        // The second of each pair needs parts that the first has left out, and others that the first contains.
        for exports in [["lean", "clean"], ["clean", "ggx"], ["phong", "lean"], ["lean", "lean"]] {
            let code = as_guests(exports, language, &[]);
            let name = format!("guests-{}-{}", exports[0], exports[1]);
            compile(&code, language, &name).unwrap_or_else(|said| panic!("{language}, {exports:?}: {said}"));
            let code = as_guests(exports, language, &["--prefix", "Bumps"]);
            compile(&code, language, &name).unwrap_or_else(|said| panic!("{language}, {exports:?}: {said}"));
        }
        let unprefixed = as_guests(["lean", "clean"], language, &["--prefix", ""]);
        assert!(compile(&unprefixed, language, "guests-unprefixed").is_err(), "{language}");
    }
}

#[test]
fn exports_have_no_unused_constants() {
    const CHOICES: [&str; 9] = [
        "FORM_",
        "BASE_",
        "REPAIR_",
        "MAPS_",
        "STORED_",
        "MASKING_",
        "FOOTPRINT_",
        "NOISE_FBM",
        "NOISE_OCTAVES_",
    ];
    for name in names() {
        for language in TEXTS {
            let code = code_of(&exported(&[&name], language));
            let defined = code.lines().filter(|line| {
                !line.starts_with(' ')
                    && ["const ", "static const ", "constant "].iter().any(|start| line.starts_with(start))
            });
            for line in defined {
                let word = line.split_whitespace().find(|word| word.starts_with("RC_")).expect("a constant");
                let constant = word.trim_end_matches(':');
                let uses = code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
                let is_choice = CHOICES.iter().any(|choice| constant["RC_".len()..].starts_with(choice));
                assert!(
                    is_choice || uses.filter(|word| *word == constant).count() > 1,
                    "{name}, {language}: {constant}"
                );
            }
        }
    }
}

#[test]
fn every_models_spirv_is_valid_and_has_its_entry_point() {
    for name in Shading::ALL.iter().map(|model| model.name()).chain(["all"]) {
        let file = folder().join(format!("{name}.spv"));
        run(["shader", name, "--lang", "spirv", "-o", path(&file)]).expect_success();
        valid_spirv(&file).unwrap_or_else(|said| panic!("{name}: {said}"));
        let bytes = std::fs::read(&file).expect("the module was written");
        let entry = match name {
            "all" => "shade_".to_owned(),
            model => format!("shade_{}", model.replace('-', "_")),
        };
        assert!(bytes.windows(entry.len()).any(|window| window == entry.as_bytes()), "{name}: no {entry}");
    }
}

#[test]
fn the_compilers_refuse_invalid_code() {
    let right = exported(&["lean"], "glsl");
    let wrong = right.replacen("return", "return undefined +", 1);
    let shader = |code: &str| format!("#version 450\n{code}\nvoid main() {{}}\n");
    assert!(compile(&shader(&right), "glsl", "right").is_ok());
    assert!(compile(&shader(&wrong), "glsl", "wrong").is_err());
    let broken = folder().join("broken.spv");
    std::fs::write(&broken, [0_u8; 64]).expect("the file can be written");
    assert!(valid_spirv(&broken).is_err());
    assert!(validate_wgsl("fn f() -> f32 { return 1u; }").is_err());
}

/// The blocks of a document that are marked as compiled, with their language.
fn examples(document: &str) -> Vec<(String, String)> {
    let blocks = document.split("<!-- compiled: ").skip(1).map(|after| {
        let (language, rest) = after.split_once(" -->").expect("the mark is closed");
        let block = rest.split("```").nth(1).expect("a block of code follows the mark");
        let (_, code) = block.split_once('\n').expect("the block's language has its own line");
        (language.to_owned(), code.to_owned())
    });
    blocks.collect()
}

#[test]
fn the_documents_examples_compile() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/shaders.md");
    let document = std::fs::read_to_string(file).expect("docs/shaders.md is there");
    let examples = examples(&document);
    let languages: Vec<_> = examples.iter().map(|(language, _)| language.as_str()).collect();
    assert_eq!(languages, ["wgsl", "glsl", "hlsl", "wgsl", "glsl", "hlsl"]);
    for (language, code) in &examples {
        let command = code.lines().find_map(|line| line.strip_prefix("// roughcast ")).expect("an export");
        let arguments: Vec<_> = command.split_whitespace().collect();
        let export = run(&arguments).expect_success().stdout;
        let code = code.replacen(&format!("// roughcast {command}"), &export, 1);
        compile(&code, language, "example").unwrap_or_else(|said| panic!("{language}: {said}"));
        if language == "glsl" {
            compile(&for_es(&code), "glsl", "example-es").unwrap_or_else(|said| panic!("ES: {said}"));
        }
    }
    for name in names() {
        assert!(document.contains(&format!("`{name}`")), "docs/shaders.md does not speak of {name}");
    }
}

#[test]
fn invalid_command_lines_are_refused_in_one_line() {
    run(["shader", "loan"]).expect_usage_error("loan");
    run(["shader", "lean", "--lang", "cg"]).expect_usage_error("cg");
    run(["shader", "lean", "--lang", "essl"]).expect_usage_error("glsl-es300");
    for prefix in ["gl_", "a__", "1x", "a-b"] {
        run(["shader", "lean", "--prefix", prefix]).expect_usage_error(prefix);
    }
    run(["shader", "reflectance", "--lang", "spirv"]).expect_usage_error("name a model");
    run(["shader", "-o", "out.wgsl"]).expect_usage_error("name");
}
