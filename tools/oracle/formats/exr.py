"""OpenEXR by the OpenEXR library inside OpenImageIO: compressions, types, channel names, windows, tiles, levels, parts."""

import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from case import Family, Reference

# DWA decodes through floating-point cosines, whose last bits depend on the order of additions; halves follow, rarely by
# more than one step of their 2^-11.
DWA_TOLERANCE = 4e-3
COMPRESSIONS = ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab", "htj2k256"]
# Channels of the file; then what is to be read of them, in this order; then layer and channels that the user names.
# An alpha that the reader gives or leaves out comes last.
CHANNELS = {
    "R G B": ("RGB", "RGB"),
    "R G B A": ("RGBA", "RGBA"),
    "Y": ("Y", "Y"),
    "Y A": ("YA", "YA"),
    "X Y Z": ("XYZ", "XYZ"),
    "x y z": ("xyz", "xyz"),
    "A first": (["A", "X", "Y", "Z"], "XYZA"),
    "red green blue": (["blue", "green", "red"], ["red", "green", "blue"]),
    "r g b": ("rgb", "rgb"),
    "R G": ("RG", "RG"),
    "U V": ("UV", "UV"),
    "height": (["height"], ["height"]),
    "height and A": (["A", "height"], ["height", "A"]),
    "displacement": (["displacement"], ["displacement"]),
    "layer N": (["N.x", "N.y", "N.z"], ["N.x", "N.y", "N.z"]),
    "layer normal, capitals": (["normal.X", "normal.Y", "normal.Z"], ["normal.X", "normal.Y", "normal.Z"]),
    "layer chosen": (["R", "G", "B", "N.X", "N.Y", "N.Z"], ["N.X", "N.Y", "N.Z"], {"layer": "N"}),
    "channel chosen": (["height", "mask", "weight"], ["height"], {"channels": ("height",)}),
    "channels chosen, other order": (["a", "b", "c"], ["c", "a"], {"channels": ("c", "a")}),
    "layer and channels chosen": (["B", "G", "R", "disp.mask", "disp.up"], ["disp.up"], {"layer": "disp", "channels": ("up",)}),
}
# Data window (x, y, width, height) relative to a display window of width x height at (0, 0), in eighths of it.
WINDOWS = {
    "same": None,
    "moved": "both windows begin at (5, -7)",
    "crop": (2, 1, 5, 6),
    "overscan": (-2, -2, 12, 12),
    "partly outside": (4, -3, 8, 7),
}


def pixels_of(rng, shape, content):
    values = rng.normal(0, 1, shape)
    if content == "smooth":
        y, x = np.mgrid[0 : shape[0], 0 : shape[1]]
        values = 0.5 + 0.3 * np.sin(x / 7)[:, :, None] * np.cos(y / 5)[:, :, None] * np.linspace(0.5, 1, shape[2])
    elif content == "large and small":
        values = values * 2.0 ** rng.integers(-16, 15, shape)
    elif content == "NaN and infinity":
        values[rng.random(shape) < 0.1] = np.nan
        values[rng.random(shape) < 0.1] = np.inf
        values[rng.random(shape) < 0.1] = -np.inf
    elif content == "constant":
        values = np.full(shape, 0.25)
    return values.astype(np.float32)


def window_of(window, size):
    """Origin and size of the data window, and origin of the display window."""
    height, width = size
    if window == "same":
        return (0, 0, width, height), (0, 0)
    if window == "moved":
        return (5, -7, width, height), (5, -7)
    x, y, w, h = WINDOWS[window]
    scaled = [x * width // 8, y * height // 8, max(1, w * width // 8), max(1, h * height // 8)]
    return tuple(scaled), (0, 0)


def through_display_window(values, data, display, size):
    """The pixels of the display window: zeros where the data window has none."""
    height, width = size
    out = np.zeros((height, width, values.shape[2]))
    x0, y0 = data[0] - display[0], data[1] - display[1]
    left, top = max(0, x0), max(0, y0)
    right, bottom = min(width, x0 + data[2]), min(height, y0 + data[3])
    if right > left and bottom > top:
        with np.errstate(invalid="ignore"):
            out[top:bottom, left:right] = values[top - y0 : bottom - y0, left - x0 : right - x0]
    return out


def spec_of(data, display, size, names, types, storage, order, compression):
    spec = oiio.ImageSpec(data[2], data[3], len(names), oiio.HALF)
    spec.x, spec.y = data[:2]
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = *display, size[1], size[0]
    spec.channelnames = names
    kinds = {"half": [oiio.HALF], "float": [oiio.FLOAT], "uint": [oiio.UINT], "mixed": [oiio.HALF, oiio.FLOAT]}[types]
    formats = [kinds[i % len(kinds)] for i in range(len(names))]
    spec.channelformats = tuple(oiio.TypeDesc(kind) for kind in formats)
    spec.format = oiio.TypeDesc(max(formats, key=lambda kind: oiio.TypeDesc(kind).size()))
    spec.attribute("compression", compression)
    spec.attribute("openexr:lineOrder", order)
    if storage.startswith("tiles"):
        spec.tile_width, spec.tile_height = {"tiles of 16": (16, 16), "tiles of 24x8": (24, 8)}[storage[:13].strip(",")]
    return spec


def written(specs, pictures, path):
    """Writes the parts; false if OpenEXR cannot."""
    out = oiio.ImageOutput.create(str(path))
    opened = out.open(str(path), specs) if len(specs) > 1 else out.open(str(path), specs[0])
    for index, (spec, picture) in enumerate(zip(specs, pictures)):
        if index:
            opened = opened and out.open(str(path), spec, "AppendSubimage")
        opened = opened and out.write_image(picture)
    return bool(out.close() and opened)


def read(path, part=0):
    """Names and values of a part, in its data window."""
    source = oiio.ImageInput.open(str(path))
    source.seek_subimage(part, 0)
    names = list(source.spec().channelnames)
    values = source.read_image(part, 0, 0, len(names), oiio.FLOAT)
    source.close()
    return names, np.asarray(values).reshape(values.shape[0], values.shape[1], -1)


def make(rng, size, channels, types, compression, storage, order, window, content, parts):
    if types == "uint" and (content != "constant" or compression in ("b44", "b44a", "dwaa", "dwab")):
        return None
    if order == "randomY" and not storage.startswith("tiles"):
        return None
    if content == "NaN and infinity" and compression in ("dwaa", "dwab", "b44", "b44a", "pxr24"):
        return None
    stored, wanted, *rest = CHANNELS[channels]
    chosen = dict(rest[0]) if rest else {}
    data, display = window_of(window, size)
    spec = spec_of(data, display, size, list(stored), types, storage, order, compression)
    picture = pixels_of(rng, (data[3], data[2], len(spec.channelnames)), content)
    specs, pictures = [spec], [picture]
    if parts == "two parts":
        if chosen.get("layer"):
            return None
        other = spec_of(data, display, size, ["R", "G", "B"], "half", storage, order, compression)
        spec.attribute("oiio:subimagename", "wanted")
        other.attribute("oiio:subimagename", "other")
        specs, pictures = [other, spec], [pixels_of(rng, (data[3], data[2], 3), "smooth"), picture]
        # A layer inside of a part is named by both.
        chosen["layer"] = "wanted." + wanted[0].split(".")[0] if "." in wanted[0] else "wanted"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        if not written(specs, pictures, path):
            return None
        names, values = read(path, len(specs) - 1)
        file = path.read_bytes()
    values = values[:, :, [names.index(name) for name in wanted]]
    values = through_display_window(values, data, display, size)
    has_alpha = wanted[-1] == "A"
    tolerance = DWA_TOLERANCE if compression.startswith("dwa") else 0.0
    reference = Reference(values, full=None, range="Float", tolerance=tolerance, optional=int(has_alpha))
    return "exr", file, reference, chosen


def with_levels(rng, mode, size, compression):
    """Mip maps: level 0 is read."""
    image = oiio.ImageBuf(oiio.ImageSpec(size[1], size[0], 3, oiio.HALF))
    image.set_pixels(oiio.ROI(), pixels_of(rng, (*size, 3), "smooth"))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        config = oiio.ImageSpec()
        config.attribute("compression", compression)
        config.attribute("maketx:fileformatname", "openexr")
        config.tile_width = config.tile_height = 16
        if not oiio.ImageBufAlgo.make_texture(oiio.MakeTxTexture, image, str(path), config):
            return None
        names, values = read(path)
        file = path.read_bytes()
    values = values[:, :, [names.index(name) for name in "RGB"]]
    return "exr", file, Reference(values, full=None, range="Float")


OPEN = {
    "two heights": ["displacement", "height"],
    "unknown names": ["one", "two", "three"],
    "mask alone": ["mask", "id"],
    "two layers": ["N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"],
}


def left_open(rng, names, size):
    """Channels that do not identify the map."""
    spec = spec_of((0, 0, size[1], size[0]), (0, 0), size, OPEN[names], "half", "scan lines", "increasingY", "zip")
    picture = pixels_of(rng, (*size, len(OPEN[names])), "noise")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        written([spec], [picture], path)
        return "exr", path.read_bytes(), Reference(np.zeros((1, 1, 1)), full=None, range="Float")


def deep(rng, storage, size):
    """Several samples per pixel, each with its depth."""
    spec = oiio.ImageSpec(size[1], size[0], 2, oiio.FLOAT)
    spec.channelnames = ["Z", "A"]
    spec.deep = True
    spec.attribute("compression", "zips")
    if storage == "deep tiles":
        spec.tile_width = spec.tile_height = 16
    samples = oiio.DeepData()
    samples.init(size[0] * size[1], 2, [oiio.TypeFloat] * 2, ["Z", "A"])
    for pixel in range(size[0] * size[1]):
        samples.set_samples(pixel, int(rng.integers(1, 4)))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        out = oiio.ImageOutput.create(str(path))
        if not (out.open(str(path), spec) and out.write_deep_image(samples) and out.close()):
            return None
        return "exr", path.read_bytes(), Reference(np.zeros((1, 1, 1)), full=None, range="Float")


def families():
    axes = {
        "channels": list(CHANNELS),
        "types": ["half", "float", "mixed", "uint"],
        "compression": COMPRESSIONS,
        "storage": ["scan lines", "tiles of 16", "tiles of 24x8"],
        "order": ["increasingY", "decreasingY", "randomY"],
        "window": list(WINDOWS),
        "content": ["noise", "smooth", "large and small", "NaN and infinity", "constant"],
        "size": [(1, 1), (8, 8), (17, 33), (40, 37), (70, 20)],
        "parts": ["one part", "two parts"],
    }
    levels = {"mode": ["mip map"], "size": [(16, 16), (33, 20), (64, 128)], "compression": ["zip", "piz", "none"]}
    return [
        Family("EXR", axes, make),
        Family("EXR", levels, with_levels, name="levels"),
        Family("EXR", {"names": list(OPEN), "size": [(3, 4), (16, 16)]}, left_open, name="left open"),
        Family("EXR", {"storage": ["deep scan lines", "deep tiles"], "size": [(3, 4), (20, 17)]}, deep, name="deep"),
    ]
