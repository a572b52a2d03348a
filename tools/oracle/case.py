"""A generated file, the pixels it represents, and how to choose files among all that a format allows."""

import itertools
import random
import zlib
from dataclasses import dataclass, field

import numpy as np

# The largest error of rounding a value to the integers 0 ..= full, in steps of 1 / full; the excess allows for float64.
HALF_STEP = 0.5 + 1e-6


class GeneratorFault(Exception):
    """The generator and the other decoder disagree about a file's pixels: the test itself is wrong."""


@dataclass
class Reference:
    """The pixels that a file represents: values[y, x, channel] in float64, row 0 the top.

    Unsigned integers are 0 ..= 1 and signed ones -1 ..= 1. `full` is the number of steps from 0 to 1 that a reader must
    keep (255, 65535 ...); None stands for floats, which must be the same bits as single floats. `tolerance` is for
    lossy codecs only: the largest difference in value; `mean_tolerance` bounds the mean of all of them.
    """

    values: np.ndarray
    full: int | None = 255
    tolerance: float = 0.0
    mean_tolerance: float | None = None
    channels: tuple | None = None
    # The value range that the reader must report: Unorm, Snorm or Float.
    range: str = "Unorm"
    # How many of the last channels a reader may leave out, since their meaning is unknown.
    optional: int = 0
    # Whether the first two channels may be swapped, since the format does not specify which of them is x.
    either_order: bool = False
    # Signed integers become floats, whose last bit depends on how the division is rounded.
    float_ulps: int = 0

    def __post_init__(self):
        values = np.asarray(self.values, np.float64)
        self.values = values[:, :, None] if values.ndim == 2 else values


@dataclass
class Case:
    """A file to decode. `traits` describe its kind, in the words of the table of refusals."""

    format: str
    traits: dict
    suffix: str
    data: bytes
    reference: Reference
    layer: str = ""
    channels: tuple = ()

    @property
    def name(self):
        return f"{self.format}: " + ", ".join(f"{key} {value}" for key, value in self.traits.items())


@dataclass
class Family:
    """Files of one format that differ along axes: each has a name and its values. `make(rng, **combination)` returns a
    Case, or None if the format does not allow the combination."""

    format: str
    axes: dict
    make: callable
    name: str = ""
    traits: dict = field(default_factory=dict)

    def case(self, combination):
        """The same combination always gives the same file."""
        seed = zlib.crc32(repr((self.format, self.name, sorted(combination.items(), key=str))).encode())
        try:
            case = self.make(np.random.default_rng(seed), **combination)
        except Exception as error:
            raise GeneratorFault(f"{self.format} {combination}: {error!r}") from error
        if case is not None and isinstance(case, tuple):
            suffix, data, reference, *rest = case
            traits = {**self.traits, **combination}
            case = Case(self.format, traits, suffix, data, reference, **(rest[0] if rest else {}))
        return case

    def size(self):
        """How many combinations there are, allowed or not."""
        return int(np.prod([len(values) for values in self.axes.values()], dtype=object))


# How many random completions of a pair of values are tried before the pair counts as impossible.
TRIES = 25


def pairs(family, seed):
    """Cases in which every possible pair of values of two axes occurs: most faults need at most two coinciding conditions.
    (Kuhn, Wallace, Gallo: Software Fault Interactions and Implications for Software Testing, 2004.)"""
    source = random.Random(seed)
    covered, names = set(), list(family.axes)
    wanted = itertools.combinations(names, 2) if len(names) > 1 else [(names[0], names[0])]
    wanted = [((a, x), (b, y)) for a, b in wanted for x in family.axes[a] for y in family.axes[b]]
    source.shuffle(wanted)
    for pair in wanted:
        if pair in covered:
            continue
        for _ in range(TRIES):
            combination = {name: source.choice(values) for name, values in family.axes.items()} | dict(pair)
            case = family.case(combination)
            if case is not None:
                covered.update(itertools.combinations(combination.items(), 2))
                yield case
                break


def every(family):
    """All combinations that the format allows."""
    for values in itertools.product(*family.axes.values()):
        case = family.case(dict(zip(family.axes, values)))
        if case is not None:
            yield case


def at_random(families, seed):
    """Endless random combinations of random families."""
    source = random.Random(seed)
    # Chooses large families more often, but small ones too.
    weights = [float(family.size()) ** 0.25 for family in families]
    while True:
        [family] = source.choices(families, weights)
        case = family.case({name: source.choice(values) for name, values in family.axes.items()})
        if case is not None:
            yield case


def noise(rng, shape, maximum):
    """Random integers 0 ..= maximum, including the extremes if there is room."""
    values = rng.integers(0, maximum, shape, endpoint=True)
    flat = values.reshape(-1)
    flat[0] = maximum
    flat[-1] = 0 if flat.size > 1 else maximum
    return values


def smooth(rng, height, width, channels):
    """Slowly varying 8-bit pictures with an edge: what lossy codecs are made for, yet no two places are alike."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float64)
    planes = []
    for _ in range(channels):
        a, b, c, phase = rng.uniform(0.03, 0.25, 4)
        wave = np.sin(a * x + 6 * phase) + np.cos(b * y + 9 * c) + 0.02 * (x + 2 * y) / 3
        planes.append(wave)
    picture = np.stack(planes, axis=-1)
    low, high = picture.min(), max(picture.max(), picture.min() + 1)
    picture = 20 + 215 * (picture - low) / (high - low)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)
