//! Gives directions signs that agree with their neighbours.
//!
//! KHR_materials_anisotropy stores a direction as a vector although it means an axis: v and -v give the same
//! highlight. If neighbouring texels hold v and -v, filtering cancels them. So every texel on every level gets the
//! sign that agrees with its neighbours, both on its own level and on the coarser one.
//!
//! The signs propagate along a maximum spanning tree, as those of normals do in Hoppe et al., "Surface reconstruction
//! from unorganized points", 1992: pairs of strongly anisotropic texels whose axes are nearly parallel are joined
//! first. If no consistent signs exist (half a turn around a point, as in a fingerprint), the seam is therefore
//! placed where it is least visible.

use super::codec::Affine;
use crate::convention::Wrap;
use crate::parallel;
use crate::{Image, Samples, SamplesMut};

/// Makes the signs of the directions in the first two channels agree on all levels. The third channel is their
/// strength.
///
/// Texels with zero strength take the direction of the texel of the coarser level, so that the direction does not
/// rotate between them and their neighbours.
pub(crate) fn orient(levels: &mut [Image], wrap: Wrap, unit: Affine) {
    for level in (1..levels.len()).rev() {
        let (finer, coarser) = levels.split_at_mut(level);
        fill_from_coarser(&mut finer[level - 1], &coarser[0]);
    }
    let graph = Graph::of(levels, wrap, unit);
    let mut signs = graph.signs();
    if graph.points_left(&mut signs) {
        signs.turned = !signs.turned;
    }
    let mut node = 0;
    for image in levels {
        node = turn(image, unit, node, &mut signs);
    }
}

/// The texel of the coarser level that covers this one.
fn covering((x, y): (usize, usize), coarser: (usize, usize)) -> (usize, usize) {
    ((x / 2).min(coarser.0 - 1), (y / 2).min(coarser.1 - 1))
}

/// Copies the stored direction of the coarser level to texels that have no direction.
fn fill_from_coarser(finer: &mut Image, coarser: &Image) {
    fn fill<T: Copy>(
        finer: &mut [T],
        size: (usize, usize),
        coarser: (&[T], (usize, usize)),
        channels: usize,
        has_strength: impl Fn(T) -> bool,
    ) {
        for y in 0..size.1 {
            for x in 0..size.0 {
                let at = (y * size.0 + x) * channels;
                if !has_strength(finer[at + 2]) {
                    let (above_x, above_y) = covering((x, y), coarser.1);
                    let above = (above_y * coarser.1.0 + above_x) * channels;
                    finer[at..at + 2].copy_from_slice(&coarser.0[above..above + 2]);
                }
            }
        }
    }
    let (size, channels) = ((finer.width(), finer.height()), finer.channels());
    let above = (coarser.width(), coarser.height());
    match (finer.samples_mut(), coarser.samples()) {
        (SamplesMut::U8(f), Samples::U8(c)) => fill(f, size, (c, above), channels, |s| s > 0),
        (SamplesMut::U16(f), Samples::U16(c)) => fill(f, size, (c, above), channels, |s| s > 0),
        (SamplesMut::F16(f), Samples::F16(c)) => fill(f, size, (c, above), channels, |s| s.to_f32() > 0.0),
        (SamplesMut::F32(f), Samples::F32(c)) => fill(f, size, (c, above), channels, |s| s > 0.0),
        _ => unreachable!("all levels have one sample type"),
    }
}

/// Flips the directions of a level according to their signs. Returns the node after its last one.
fn turn(image: &mut Image, unit: Affine, first_node: usize, signs: &mut Signs) -> usize {
    fn each<T: Copy>(
        samples: &mut [T],
        channels: usize,
        first_node: usize,
        signs: &mut Signs,
        round: impl Fn(T) -> T,
    ) {
        for (index, texel) in samples.chunks_exact_mut(channels).enumerate() {
            if signs.is_turned(first_node + index) {
                (texel[0], texel[1]) = (round(texel[0]), round(texel[1]));
            }
        }
    }
    let (texels, channels) = (image.width() * image.height(), image.channels());
    // The stored value of zero lies between those of v and -v.
    let twice_zero = 2.0 * unit.add;
    match image.samples_mut() {
        SamplesMut::U8(v) => each(v, channels, first_node, signs, |code| u8::MAX - code),
        SamplesMut::U16(v) => each(v, channels, first_node, signs, |code| u16::MAX - code),
        SamplesMut::F16(v) => {
            each(v, channels, first_node, signs, |value| half::f16::from_f32(twice_zero - value.to_f32()));
        }
        SamplesMut::F32(v) => each(v, channels, first_node, signs, |value| twice_zero - value),
    }
    first_node + texels
}

/// A quarter turn, in the units of [`Graph::angles`].
const QUARTER: u16 = 1 << 14;

/// Weights of edges go up to [`QUARTER`] times 255, which is 22 bits; this many of the lowest bits are ignored.
const LEAST_WEIGHT_BITS: u32 = 10;

/// Classes of edges, by the importance of agreement between their ends: two for each of the remaining bits.
const CLASSES: u8 = 24;

/// Texels of all levels, with their neighbours.
struct Graph {
    sizes: Vec<(usize, usize)>,
    wrap: Wrap,
    /// Direction of each texel; 2^16 is a full turn, so that differences wrap like angles.
    angles: Vec<u16>,
    /// Strength of each texel; 255 represents 1.
    strengths: Vec<u8>,
}

/// The neighbour at the other end of an edge.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Edge {
    Right,
    Below,
    Coarser,
}

const EDGES: [Edge; 3] = [Edge::Right, Edge::Below, Edge::Coarser];

impl Graph {
    fn of(levels: &[Image], wrap: Wrap, unit: Affine) -> Self {
        let nodes = levels.iter().map(|image| image.width() * image.height()).sum();
        let mut graph = Self {
            sizes: levels.iter().map(|image| (image.width(), image.height())).collect(),
            wrap,
            angles: vec![0; nodes],
            strengths: vec![0; nodes],
        };
        let (mut angles, mut strengths) = (graph.angles.as_mut_slice(), graph.strengths.as_mut_slice());
        for image in levels {
            let (samples, channels) = (image.samples(), image.channels());
            let read = |texel: usize| {
                let first = texel * channels;
                let [x, y] = [0, 1].map(|channel| unit.load(samples.get(first + channel)));
                let turns = y.atan2(x) / std::f32::consts::TAU;
                // Negative angles wrap; -1/2 and 1/2 are the same.
                let angle = (turns * 65536.0).round() as i32 as u16;
                (angle, (samples.get(first + 2) * 255.0).round() as u8)
            };
            let (width, texels) = (image.width(), image.width() * image.height());
            let (these_angles, these_strengths);
            (these_angles, angles) = angles.split_at_mut(texels);
            (these_strengths, strengths) = strengths.split_at_mut(texels);
            let rows = these_angles.chunks_mut(width).zip(these_strengths.chunks_mut(width)).enumerate();
            parallel::for_each(rows.collect(), |(y, (angles, strengths))| {
                for (x, (angle, strength)) in angles.iter_mut().zip(strengths).enumerate() {
                    (*angle, *strength) = read(y * width + x);
                }
            });
        }
        graph
    }

    /// Whether two directions are less than a quarter turn apart, and how strongly they agree.
    fn agreement(&self, a: usize, b: usize) -> (bool, u16) {
        let apart = (self.angles[a].wrapping_sub(self.angles[b]) as i16).unsigned_abs();
        if apart <= QUARTER { (true, QUARTER - apart) } else { (false, apart - QUARTER) }
    }

    /// The class of an edge: the weaker strength times the agreement of the axes, in half octaves. An edge across the
    /// border of the map counts a quarter, so that an unavoidable seam is placed there and not inside.
    fn class(&self, a: usize, b: usize, crosses_border: bool) -> u8 {
        let strength = self.strengths[a].min(self.strengths[b]);
        let weight = u32::from(self.agreement(a, b).1) * u32::from(strength);
        let weight = if crosses_border { weight / 4 } else { weight } >> LEAST_WEIGHT_BITS;
        match weight.checked_ilog2() {
            None => 0,
            Some(0) => 1,
            Some(octave) => 2 * octave as u8 + (weight >> (octave - 1) & 1) as u8,
        }
    }

    /// Calls `f` with the two ends of every selected edge, in a fixed order, and with a flag for edges that cross the
    /// border of the map. `wanted` selects among the edge slots of a level, three per texel.
    fn for_each_edge<I: Iterator<Item = usize>>(
        &self,
        wanted: impl Fn(std::ops::Range<usize>) -> I,
        mut f: impl FnMut(usize, usize, usize, bool),
    ) {
        let mut first = 0;
        for (level, &(width, height)) in self.sizes.iter().enumerate() {
            let next = first + width * height;
            for place in wanted(3 * first..3 * next) {
                let (node, edge) = (place / 3, EDGES[place % 3]);
                let at = ((node - first) % width, (node - first) / width);
                if let Some(end) = self.end_of(edge, level, at, (first, next)) {
                    f(place, node, end, end < node);
                }
            }
            first = next;
        }
    }

    /// The other end of an edge; `firsts` are the first nodes of the level and of the next one.
    fn end_of(
        &self,
        edge: Edge,
        level: usize,
        (x, y): (usize, usize),
        firsts: (usize, usize),
    ) -> Option<usize> {
        let (width, height) = self.sizes[level];
        let beyond = |place: usize, length: usize| match self.wrap {
            _ if place + 1 < length => Some(place + 1),
            Wrap::Repeat if length > 1 => Some(0),
            _ => None,
        };
        match edge {
            Edge::Right => beyond(x, width).map(|x| firsts.0 + y * width + x),
            Edge::Below => beyond(y, height).map(|y| firsts.0 + y * width + x),
            Edge::Coarser => self.sizes.get(level + 1).map(|&coarser| {
                let (x, y) = covering((x, y), coarser);
                firsts.1 + y * coarser.0 + x
            }),
        }
    }

    /// Computes the signs along a maximum spanning tree (Kruskal's algorithm, with edges sorted into classes).
    fn signs(&self) -> Signs {
        /// The class of edges without a second end.
        const NO_EDGE: u8 = u8::MAX;
        let mut classes = vec![NO_EDGE; 3 * self.angles.len()];
        self.for_each_edge(|all| all, |place, a, b, border| classes[place] = self.class(a, b, border));
        let mut signs = Signs::new(self.angles.len());
        for class in (0..CLASSES).rev() {
            let wanted = |places: std::ops::Range<usize>| {
                let first = places.start;
                let of_class = classes[places].iter().enumerate().filter(move |(_, found)| **found == class);
                of_class.map(move |(index, _)| first + index)
            };
            self.for_each_edge(wanted, |_, a, b, _| signs.join(a, b, self.agreement(a, b).0));
        }
        signs
    }

    /// Whether the directions point left on average; the reference is the x axis.
    fn points_left(&self, signs: &mut Signs) -> bool {
        let mut sum = 0.0;
        for (node, (angle, strength)) in self.angles.iter().zip(&self.strengths).enumerate() {
            let cosine = (f64::from(*angle) * (std::f64::consts::TAU / 65536.0)).cos();
            let sign = if signs.is_turned(node) { -1.0 } else { 1.0 };
            sum += sign * f64::from(*strength) * cosine;
        }
        sum < 0.0
    }
}

/// Which texels are flipped: a union-find structure whose links record whether their ends have the same sign.
struct Signs {
    /// The parent of each node, itself for a root; the highest bit means that it has the opposite sign.
    links: Vec<u32>,
    /// Whether all texels are flipped additionally.
    turned: bool,
}

const OPPOSITE: u32 = 1 << 31;

impl Signs {
    fn new(nodes: usize) -> Self {
        let nodes = u32::try_from(nodes).ok().filter(|nodes| *nodes < OPPOSITE);
        Self { links: (0..nodes.expect("images have fewer than 2^31 texels")).collect(), turned: false }
    }

    /// The root of a node, with the bit that says whether its sign is opposite to that of the root. Compresses the
    /// path.
    fn find(&mut self, node: u32) -> u32 {
        let (mut root, mut sign) = (node, 0);
        while self.links[root as usize] & !OPPOSITE != root {
            let link = self.links[root as usize];
            sign ^= link & OPPOSITE;
            root = link & !OPPOSITE;
        }
        let (mut at, mut left) = (node, sign);
        while at != root {
            let link = self.links[at as usize];
            self.links[at as usize] = root | left;
            left ^= link & OPPOSITE;
            at = link & !OPPOSITE;
        }
        root | sign
    }

    /// Makes two nodes agree, unless earlier joins have already determined their signs.
    fn join(&mut self, a: usize, b: usize, agree: bool) {
        let (a, b) = (self.find(a as u32), self.find(b as u32));
        let (root_a, root_b) = (a & !OPPOSITE, b & !OPPOSITE);
        if root_a != root_b {
            let sign = (a ^ b) & OPPOSITE ^ if agree { 0 } else { OPPOSITE };
            self.links[root_b as usize] = root_a | sign;
        }
    }

    fn is_turned(&mut self, node: usize) -> bool {
        (self.find(node as u32) & OPPOSITE != 0) != self.turned
    }
}

#[cfg(test)]
mod tests;
