//! Infers the role of a material's file from its name: the suffixes of texture libraries, engines and painting
//! programs.
//!
//! The words are those of ambientCG (`_NormalGL`), Poly Haven (`_nor_gl_1k`), Quixel (`_Albedo`), Unreal (`T_Rock_N`),
//! Unity (`_MetallicGlossMap`), glTF and Blender (`baseColor`) and Substance (`Normal_OpenGL`). Case, separators and
//! the resolution are ignored. The last word decides, so `gloss_paint_normal.png` is a normal map. If a name ends in
//! several role words and one of them means normals, as in `ground_nrm_rgh.png`, the file is a normal map that contains
//! the other roles in its further channels.

use roughcast::Green;

/// The content of a material's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MaterialRole {
    /// Normals; the name may specify which way green points.
    Normal(Option<Green>),
    /// Heights or depths.
    Height,
    /// Anything other than a normal or height map, as one word for messages: `colour`, `roughness` ...
    Other(&'static str),
}

const NORMAL: MaterialRole = MaterialRole::Normal(None);
const UP: MaterialRole = MaterialRole::Normal(Some(Green::Up));
const DOWN: MaterialRole = MaterialRole::Normal(Some(Green::Down));
const HEIGHT: MaterialRole = MaterialRole::Height;
const COLOUR: MaterialRole = MaterialRole::Other("colour");
const OCCLUSION: MaterialRole = MaterialRole::Other("occlusion");
const ROUGHNESS: MaterialRole = MaterialRole::Other("roughness");
const GLOSS: MaterialRole = MaterialRole::Other("gloss");
const METALNESS: MaterialRole = MaterialRole::Other("metalness");
const SPECULAR: MaterialRole = MaterialRole::Other("specular");
const OPACITY: MaterialRole = MaterialRole::Other("opacity");
const EMISSION: MaterialRole = MaterialRole::Other("emission");
const PACKED: MaterialRole = MaterialRole::Other("packed channels");
const TRANSMISSION: MaterialRole = MaterialRole::Other("translucency");
const HELPER: MaterialRole = MaterialRole::Other("a mask or preview");

/// Words, without separators and in lower case, that identify a file's content at the end of its name.
const WORDS: [(&[&str], MaterialRole); 16] = [
    (&["normalgl", "norgl", "normalopengl", "normalogl", "nrmgl", "nrmogl"], UP),
    (&["normaldx", "nordx", "normaldirectx", "normald3d", "nrmdx", "nrmd3d"], DOWN),
    (&["normal", "normals", "normalmap", "nor", "norm", "nrm", "nmap"], NORMAL),
    (&["height", "heightmap", "displacement", "disp", "bump", "parallax", "parallaxmap", "depth"], HEIGHT),
    (
        &[
            "color",
            "colour",
            "col",
            "albedo",
            "basecolor",
            "basecolour",
            "basemap",
            "diffuse",
            "diff",
            "alb",
            "maintex",
        ],
        COLOUR,
    ),
    (&["ao", "ambientocclusion", "occlusion", "occlusionmap", "occ", "mixedao", "cavity"], OCCLUSION),
    (&["roughness", "roughnessmap", "rough", "rgh"], ROUGHNESS),
    (&["gloss", "glossiness", "smoothness"], GLOSS),
    (&["metalness", "metallic", "metal", "metallicmap", "met", "mtl"], METALNESS),
    (&["specular", "spec", "specularlevel", "specglossmap", "reflection"], SPECULAR),
    (&["opacity", "alpha", "transparency"], OPACITY),
    (&["emission", "emissive", "emissionmap", "emit", "glow"], EMISSION),
    (
        &[
            "orm",
            "arm",
            "rma",
            "mra",
            "mrao",
            "rmao",
            "ormh",
            "metallicroughness",
            "occlusionroughnessmetallic",
            "metallicglossmap",
            "metallicsmoothness",
            "maskmap",
        ],
        PACKED,
    ),
    (&["translucency", "transmission", "thickness", "scattering", "sss", "subsurface"], TRANSMISSION),
    (&["mask", "id", "curvature", "preview", "thumbnail", "render"], HELPER),
    (&["bc"], COLOUR),
];

/// Letters that identify the content only if other files of the same material exist: `T_Rock_N`, `T_Rock_D`.
/// `door_h.png` alone is not identified.
const LETTERS: [(&str, MaterialRole); 10] = [
    ("n", NORMAL),
    ("h", HEIGHT),
    ("d", COLOUR),
    ("c", COLOUR),
    ("b", COLOUR),
    ("r", ROUGHNESS),
    ("m", METALNESS),
    ("s", SPECULAR),
    ("e", EMISSION),
    ("o", OPACITY),
];

/// Maximum number of words in a role's name: `occlusion roughness metallic`.
const MAX_WORDS: usize = 3;

/// The meaning of a file name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedRole {
    /// What the file contains.
    pub role: MaterialRole,
    /// The name without its role words, in lower case: the same for all files of a material.
    pub material: String,
    /// Whether the role is a single letter, which counts only if other files of the material exist.
    pub by_letter: bool,
}

/// The role in the name of a file, without its extension; `None` if there is none.
pub fn role_of(stem: &str) -> Option<NamedRole> {
    let words = words_of(stem);
    if let Some((role, before)) = ending_role(&words) {
        let (role, before) = normals_among(role, before).unwrap_or((role, before));
        return Some(NamedRole { role, material: before.concat(), by_letter: false });
    }
    let (last, before) = words.split_last()?;
    let (_, role) = LETTERS.iter().find(|(letter, _)| letter == last)?;
    (!before.is_empty()).then(|| NamedRole { role: *role, material: before.concat(), by_letter: true })
}

/// The role named by the last words, trying the longest names first, and the words before it.
fn ending_role(words: &[String]) -> Option<(MaterialRole, &[String])> {
    (1..=MAX_WORDS.min(words.len())).rev().find_map(|count| {
        let (before, last) = words.split_at(words.len() - count);
        let joined = last.concat();
        let (_, role) = WORDS.iter().find(|(names, _)| names.contains(&joined.as_str()))?;
        Some((*role, before))
    })
}

/// The normals that a picture of several roles contains: `nrm_rgh` is normals in RGB and roughness in alpha. A mask or
/// preview of normals is not one.
fn normals_among(last: MaterialRole, mut before: &[String]) -> Option<(MaterialRole, &[String])> {
    if last == HELPER {
        return None;
    }
    let mut normals = None;
    while let Some((role, words)) = ending_role(before) {
        before = words;
        if matches!(role, MaterialRole::Normal(_)) {
            normals = Some(role);
        }
    }
    // All role words are removed, so that the material's name matches that of its other files.
    normals.map(|role| (role, before))
}

/// The roles in the names of files in one folder: a single letter counts if another file of the same material is
/// identified by its name.
pub fn roles_of<'a>(stems: impl IntoIterator<Item = &'a str>) -> Vec<Option<NamedRole>> {
    let roles: Vec<Option<NamedRole>> = stems.into_iter().map(role_of).collect();
    let of_material =
        |material: &str| roles.iter().flatten().filter(|other| other.material == material).count();
    let counts = |role: &NamedRole| !role.by_letter || of_material(&role.material) > 1;
    roles.iter().map(|role| role.clone().filter(counts)).collect()
}

/// The words of a name in lower case, without resolutions and numbers. `Rock020_1K_NormalGL` is `rock`, `normal`, `gl`.
fn words_of(stem: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut previous = ' ';
    let letters: Vec<char> = stem.chars().collect();
    for (i, &c) in letters.iter().enumerate() {
        let next_is_lower = letters.get(i + 1).is_some_and(|next| next.is_lowercase());
        // In `baseColor` and `AOMap`, a word begins at the C and at the M.
        let begins =
            c.is_uppercase() && (previous.is_lowercase() || previous.is_uppercase() && next_is_lower);
        if c.is_alphanumeric() {
            if begins || !previous.is_alphanumeric() || words.is_empty() {
                words.push(String::new());
            }
            words.last_mut().expect("just pushed").extend(c.to_lowercase());
        }
        previous = c;
    }
    words.retain(|word| !is_resolution(word));
    words
}

/// `2k`, `1024`, `512px`, `01`.
fn is_resolution(word: &str) -> bool {
    let digits = word.trim_end_matches("px").trim_end_matches('k');
    !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn role(stem: &str) -> Option<MaterialRole> {
        role_of(stem).map(|named| named.role)
    }

    #[test]
    fn names_of_the_libraries_are_known() {
        for (stem, expected) in [
            ("Rock020_1K_NormalGL", UP),
            ("Rock020_1K_NormalDX", DOWN),
            ("Bricks090_2K-PNG_Displacement", HEIGHT),
            ("Bricks090_2K_Color", COLOUR),
            ("Bricks090_2K_AmbientOcclusion", OCCLUSION),
            ("plastic_monobloc_chair_01_nor_gl_1k", UP),
            ("plastic_monobloc_chair_01_arm_1k", PACKED),
            ("brick_wall_disp_4k", HEIGHT),
            ("brick_wall_diff_4k", COLOUR),
            ("brick_wall_rough_4k", ROUGHNESS),
            ("sdfgk_4K_Albedo", COLOUR),
            ("sdfgk_4K_Gloss", GLOSS),
            ("sdfgk_4K_Translucency", TRANSMISSION),
            ("Wood_MetallicGlossMap", PACKED),
            ("Wood_OcclusionMap", OCCLUSION),
            ("Wood_ParallaxMap", HEIGHT),
            ("Boombox_baseColor", COLOUR),
            ("SphereMat_occlusionRoughnessMetallic", PACKED),
            ("lambert1_Normal_OpenGL", UP),
            ("lambert1_Normal_DirectX", DOWN),
            ("lambert1_Base_Color", COLOUR),
            ("lambert1_Mixed_AO", OCCLUSION),
            ("metal plate METALNESS", METALNESS),
            ("T_Rock_ORM", PACKED),
            ("gloss_paint_normal", NORMAL),
            ("texture_cheese_depth", HEIGHT),
        ] {
            assert_eq!(role(stem), Some(expected), "{stem}");
        }
    }

    #[test]
    fn a_picture_of_several_roles_is_a_normal_map_where_it_contains_normals() {
        for (stem, expected) in [
            ("ground037_nrm_rgh", NORMAL),
            ("ground037_rgh_nrm", NORMAL),
            ("wall_nor_gl_rough_ao_2k", UP),
            ("wall_normal_height", NORMAL),
            ("wall_ao_rough", ROUGHNESS),
            ("wall_normal_preview", HELPER),
            ("normal_wall_rough", ROUGHNESS),
        ] {
            assert_eq!(role(stem), Some(expected), "{stem}");
        }
        let material = role_of("ground037_nrm_rgh").map(|named| named.material);
        assert_eq!(material, role_of("ground037_disp").map(|named| named.material));
    }

    #[test]
    fn other_names_have_no_role() {
        for stem in [
            "ocean",
            "0000",
            "normals_64crop_16bit_derived",
            "wall",
            "brick",
            "n",
            "terrain1",
            "heights of abraham",
        ] {
            assert_eq!(role(stem), None, "{stem}");
        }
    }

    #[test]
    fn single_letters_count_among_files_of_the_same_material() {
        let roles = roles_of(["T_Rock_N", "T_Rock_D", "door_h", "wall_h", "wall_albedo"]);
        let found: Vec<_> = roles.iter().map(|role| role.as_ref().map(|role| role.role)).collect();
        assert_eq!(found, [Some(NORMAL), Some(COLOUR), None, Some(HEIGHT), Some(COLOUR)]);
    }

    #[test]
    fn files_of_one_material_share_its_name() {
        let material = |stem: &str| role_of(stem).map(|role| role.material);
        assert_eq!(material("Rock020_1K_Normal"), material("Rock020_1K_Displacement"));
        assert_ne!(material("Rock020_1K_Normal"), material("Tiles036_1K_Displacement"));
    }
}
