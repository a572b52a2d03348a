//! The meaning of an EXR's channel names: components of a vector, a height, or neither.
//!
//! A name may begin with the name of a layer: `ViewLayer.Normal.X` is channel `X` of the layer `ViewLayer.Normal`. Case
//! is ignored. The names are those used by renderers and painting programs: OpenImageIO (which also knows `red`),
//! Houdini (`height`, `mask`), Blender (`Depth.Z`), Arnold and others (`N.x`, `Nx`).

/// Names of the first, second and third component of a vector or colour, set by set; earlier sets win.
const VECTORS: [[&str; 3]; 5] = [
    ["R", "G", "B"],
    ["red", "green", "blue"],
    ["X", "Y", "Z"],
    ["Nx", "Ny", "Nz"],
    ["normalX", "normalY", "normalZ"],
];

/// Names of the components of a normal without z, in addition to the first two of each of [`VECTORS`].
const PAIRS: [[&str; 2]; 1] = [["U", "V"]];

/// Names of a height.
const HEIGHTS: [&str; 9] =
    ["height", "displacement", "disp", "elevation", "bump", "heightmap", "depth", "Z", "Y"];

/// Height names that can also mean luminance, scene depth or a third component. Such a channel is a height only if no
/// other channel could be one.
const WEAK_HEIGHTS: [&str; 3] = ["depth", "Z", "Y"];

/// Names of coverage channels, which are not part of any map.
const ALPHAS: [&str; 9] = ["A", "alpha", "opacity", "coverage", "RA", "GA", "BA", "AR", "AG"];

/// Words in the names of masks and identifiers, which are neither heights nor components.
const ASIDE: [&str; 8] = ["mask", "matte", "crypto", "id", "index", "debris", "water", "sediment"];

/// The channels of one layer that form an image, by index in the list of names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// These, under these names.
    Clear(Vec<(usize, String)>),
    /// None: the layer has only coverage, masks and identifiers.
    Nothing,
    /// The names are ambiguous: there are several candidates.
    Open,
}

/// Chooses among the channel names of one layer, given without the layer's name.
pub(super) fn choose(names: &[&str]) -> Choice {
    let place = |wanted: &str| {
        let exact = names.iter().position(|name| *name == wanted);
        exact.or_else(|| names.iter().position(|name| name.eq_ignore_ascii_case(wanted)))
    };
    for (set, vector) in VECTORS.iter().enumerate() {
        if let Some(places) = all_of(vector, place) {
            // OpenImageIO also renames these to R, G and B.
            let called: &[&str; 3] = if set == 1 { &VECTORS[0] } else { vector };
            let mut chosen: Vec<_> =
                places.into_iter().zip(called.iter().map(|&name| name.to_owned())).collect();
            let alpha = ["A", "alpha"].iter().find_map(|name| place(name));
            chosen.extend(alpha.filter(|_| set < 2).map(|place| (place, "A".to_owned())));
            return Choice::Clear(chosen);
        }
    }
    if let Some(choice) = luminance(names, place) {
        return choice;
    }
    let heights: Vec<usize> = HEIGHTS.iter().filter_map(|name| place(name)).collect();
    let pairs = VECTORS.iter().map(|[a, b, _]| [*a, *b]).chain(PAIRS);
    let pairs: Vec<[usize; 2]> = pairs.filter_map(|[a, b]| Some([place(a)?, place(b)?])).collect();
    // A Y that accompanies an X is not a luminance.
    let heights: Vec<usize> =
        heights.into_iter().filter(|height| !pairs.iter().any(|pair| pair.contains(height))).collect();
    let keep = |places: &[usize]| Choice::Clear(places.iter().map(|&i| (i, names[i].to_owned())).collect());
    match (&pairs[..], &heights[..]) {
        ([pair], []) => return keep(pair),
        ([], [height]) => {
            let weak = WEAK_HEIGHTS.iter().any(|name| name.eq_ignore_ascii_case(names[*height]));
            let alone = (0..names.len()).all(|i| i == *height || is_aside(names[i]));
            return if weak && !alone { Choice::Open } else { keep(&[*height]) };
        }
        ([], []) => {}
        _ => return Choice::Open,
    }
    let rest: Vec<usize> = (0..names.len()).filter(|&i| !is_aside(names[i])).collect();
    match rest[..] {
        [] => Choice::Nothing,
        [one] => keep(&[one]),
        _ => Choice::Open,
    }
}

/// Grey, with or without coverage.
fn luminance(names: &[&str], place: impl Fn(&str) -> Option<usize>) -> Option<Choice> {
    let grey = place("Y")?;
    let alone = names.len() == 1;
    let alpha = place("A").filter(|_| names.len() == 2);
    (alone || alpha.is_some()).then(|| {
        let alpha = alpha.map(|place| (place, "A".to_owned()));
        Choice::Clear([Some((grey, "Y".to_owned())), alpha].into_iter().flatten().collect())
    })
}

fn all_of<const N: usize>(wanted: &[&str; N], place: impl Fn(&str) -> Option<usize>) -> Option<[usize; N]> {
    let places = wanted.map(place);
    places.iter().all(Option::is_some).then(|| places.map(|place| place.expect("all are there")))
}

/// Whether a channel is coverage, a mask or an identifier.
fn is_aside(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let is_word = |word: &&str| {
        lower == **word
            || lower.ends_with(&format!("_{word}"))
            || (word.len() > 3 && lower.starts_with(*word))
    };
    // `objectId` and `instanceID`: identifier names end in "id" with a capital I.
    let is_id = name.ends_with("Id") || name.ends_with("ID");
    ALPHAS.iter().any(|alpha| alpha.eq_ignore_ascii_case(name)) || ASIDE.iter().any(is_word) || is_id
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(names: &[&str]) -> Vec<String> {
        match choose(names) {
            Choice::Clear(chosen) => {
                chosen.into_iter().map(|(place, name)| format!("{}={name}", names[place])).collect()
            }
            other => panic!("{names:?}: {other:?}"),
        }
    }

    #[test]
    fn vectors_come_in_the_order_of_their_components() {
        assert_eq!(chosen(&["A", "B", "G", "R"]), ["R=R", "G=G", "B=B", "A=A"]);
        assert_eq!(chosen(&["blue", "green", "red"]), ["red=R", "green=G", "blue=B"]);
        assert_eq!(chosen(&["A", "Nx", "Ny", "Nz"]), ["Nx=Nx", "Ny=Ny", "Nz=Nz"]);
        assert_eq!(chosen(&["x", "y", "z"]), ["x=X", "y=Y", "z=Z"]);
        assert_eq!(chosen(&["B", "G", "R", "height"]), ["R=R", "G=G", "B=B"]);
    }

    #[test]
    fn coverage_and_masks_are_never_a_component_or_a_height() {
        assert_eq!(chosen(&["A", "X", "Y"]), ["X=X", "Y=Y"]);
        assert_eq!(chosen(&["A", "Z"]), ["Z=Z"]);
        assert_eq!(chosen(&["A", "height"]), ["height=height"]);
        assert_eq!(chosen(&["debris", "height", "mask"]), ["height=height"]);
        assert_eq!(chosen(&["Displacement", "objectId"]), ["Displacement=Displacement"]);
        assert_eq!(chosen(&["AR", "noise"]), ["noise=noise"]);
        assert_eq!(choose(&["A", "mask"]), Choice::Nothing);
    }

    #[test]
    fn grey_keeps_its_coverage() {
        assert_eq!(chosen(&["A", "Y"]), ["Y=Y", "A=A"]);
        assert_eq!(chosen(&["Y"]), ["Y=Y"]);
        assert_eq!(chosen(&["U", "V"]), ["U=U", "V=V"]);
    }

    #[test]
    fn ambiguous_names_stay_ambiguous() {
        for names in [
            &["foo", "bar"][..],
            &["U", "V", "height"],
            &["height", "displacement"],
            &["X", "Y", "height"],
            &["R", "Z"],
        ] {
            assert_eq!(choose(names), Choice::Open, "{names:?}");
        }
    }
}
