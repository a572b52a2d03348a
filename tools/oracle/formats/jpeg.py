"""JPEG: sampling factors, scans, restarts and colours by libjpeg-turbo's cjpeg; decoded by libjpeg-turbo in Pillow."""

import io
import subprocess
import tempfile
from pathlib import Path

import imagecodecs
import numpy as np
from PIL import Image

from case import Family, Reference, smooth

# The standard leaves the rounding of the inverse transform, of chroma between its samples and of the colour conversion
# open. Between libjpeg-turbo and decoders of the same upsampling 3 of 255 is the most that occurred ...
TOLERANCE = 4 / 255
# ... and 0.36 on average, while blocks in wrong places differ by tens.
MEAN_TOLERANCE = 0.5 / 255

# Components of a factor between one and the largest.
UNUSUAL = ["4x1,2x1,1x1", "1x4,1x2,1x1", "4x2,2x1,1x1", "4x2,2x2,1x1"]
SAMPLINGS = [
    "1x1", "2x1", "1x2", "2x2", "4x1", "1x4", "4x2", "2x4", "3x1", "1x3", "3x2",
    "2x2,1x2,1x2", "2x2,2x1,2x1", "2x2,1x1,2x1", "1x1,2x2,2x2", "2x1,1x2,1x2", "1x2,2x1,1x1", "2x2,2x2,2x2",
    *UNUSUAL,
]  # fmt: skip
# Scan scripts in cjpeg's words: components, then the first and last coefficient and the two bit positions.
SCANS = {
    "interleaved": None,
    "separate": "0; 1; 2;",
    "luma alone": "0; 1 2;",
    "chroma first": "2; 1; 0;",
    "luma and blue": "0 1; 2;",
    "progressive": "",
    "progressive, spectral only": "0 1 2: 0-0, 0, 0; 0: 1-63, 0, 0; 1: 1-63, 0, 0; 2: 1-63, 0, 0;",
    "progressive, separate DC": "0: 0-0, 0, 1; 1: 0-0, 0, 1; 2: 0-0, 0, 1; 2: 1-5, 0, 2; 0: 1-63, 0, 2; 1: 1-63, 0, 1;"
    " 0: 1-63, 2, 1; 0: 0-0, 1, 0; 2: 6-63, 0, 2; 1: 0-0, 1, 0; 2: 0-0, 1, 0; 0: 1-63, 1, 0; 2: 1-63, 2, 1;"
    " 2: 1-63, 1, 0; 1: 1-63, 1, 0;",
    "progressive, deep refinement": "0 1 2: 0-0, 0, 3; 0: 1-63, 0, 3; 0 1 2: 0-0, 3, 2; 0 1 2: 0-0, 2, 1;"
    " 0 1 2: 0-0, 1, 0; 0: 1-63, 3, 2; 0: 1-63, 2, 1; 0: 1-63, 1, 0; 1: 1-63, 0, 0; 2: 1-63, 0, 0;",
}
GREY_SCANS = {
    "interleaved": None,
    "progressive": "",
    "progressive, spectral only": "0: 0-0, 0, 0; 0: 1-20, 0, 0; 0: 21-63, 0, 0;",
    "progressive, deep refinement": "0: 0-0, 0, 2; 0: 0-0, 2, 1; 0: 1-63, 0, 1; 0: 0-0, 1, 0; 0: 1-63, 1, 0;",
}
RESTARTS = ["none", "1B", "3B", "1", "2"]


def cjpeg(picture, switches, script):
    """The file that cjpeg makes of 8-bit grey or RGB."""
    height, width = picture.shape[:2]
    kind = b"P5" if picture.ndim == 2 else b"P6"
    source = kind + b"\n%d %d\n255\n" % (width, height) + picture.tobytes()
    with tempfile.NamedTemporaryFile("w", suffix=".scans") as file:
        if script:
            file.write(script)
            file.flush()
            switches = [*switches, "-scans", file.name]
        done = subprocess.run(["cjpeg", *switches], input=source, capture_output=True)
    return done.stdout if done.returncode == 0 else None


def decoded(data):
    """The pixels of libjpeg-turbo with its defaults: accurate integers, triangle upsampling."""
    image = Image.open(io.BytesIO(data))
    # Pillow turns a YCbCr file into RGB itself; no profile and no orientation is applied.
    image.load()
    return np.asarray(image).astype(np.float64) / 255


def make(rng, size, colour, sampling, scans, restart, quality, coding, smoothness):
    height, width = size
    script = (GREY_SCANS if colour == "grey" else SCANS).get(scans, False)
    if script is False or (colour == "grey" and sampling not in ("1x1", "2x2", "3x1")):
        return None
    if scans.startswith("progressive") and coding == "optimised":
        return None  # Progressive files always are.
    picture = smooth(rng, height, width, 3)
    if smoothness == "noisy luma":
        picture = np.clip(picture + rng.integers(-60, 60, (height, width, 1)), 0, 255).astype(np.uint8)
    switches = ["-quality", str(quality), "-sample", sampling]
    switches += {"YCbCr": [], "RGB": ["-rgb"], "grey": ["-grayscale"]}[colour]
    switches += [] if restart == "none" else ["-restart", restart]
    switches += ["-progressive"] if script == "" else []
    switches += {"plain": [], "optimised": ["-optimize"], "arithmetic": ["-arithmetic"]}[coding]
    data = cjpeg(picture, switches, script)
    if data is None:
        return None
    values = decoded(data)
    return "jpg", data, Reference(values, tolerance=TOLERANCE, mean_tolerance=MEAN_TOLERANCE)


def pillow(rng, kind, size):
    """Files that cjpeg cannot write."""
    picture = smooth(rng, *size, 3)
    out = io.BytesIO()
    if kind == "CMYK":
        Image.fromarray(picture).convert("CMYK").save(out, "JPEG", quality=95)
    elif kind == "EXIF orientation":
        exif = Image.Exif()
        exif[0x0112] = 6
        Image.fromarray(picture).save(out, "JPEG", quality=95, exif=exif, subsampling=0)
    elif kind == "ICC profile":
        Image.fromarray(picture).save(out, "JPEG", quality=95, icc_profile=bytes(range(256)) * 600, subsampling=0)
    elif kind == "comment and density":
        Image.fromarray(picture).save(out, "JPEG", quality=95, comment=b"some words", dpi=(300, 150))
    elif kind == "12 bits":
        data = imagecodecs.jpeg8_encode(picture.astype(np.uint16) * 16, level=95, bitspersample=12)
        values = imagecodecs.jpeg8_decode(data) / 4095
        return "jpg", data, Reference(values, full=4095, tolerance=TOLERANCE)
    elif kind == "lossless":
        data = imagecodecs.ljpeg_encode(picture[:, :, 0])
        return "jpg", data, Reference(picture[:, :, 0] / 255)
    data = out.getvalue()
    values = np.zeros((*size, 3)) if kind == "CMYK" else decoded(data)
    return "jpg", data, Reference(values, tolerance=TOLERANCE, mean_tolerance=MEAN_TOLERANCE)


ARITHMETIC = {
    "coding": ["arithmetic"],
    "sampling": ["1x1", "2x2"],
    "restart": ["none"],
    "size": [(17, 9)],
    "quality": [90],
    "smoothness": ["smooth"],
}


def families():
    if not Path("/usr/bin/cjpeg").exists():
        raise SystemExit("oracle: cjpeg is missing: install libjpeg-turbo-progs")
    axes = {
        "colour": ["YCbCr", "RGB", "grey"],
        "sampling": SAMPLINGS,
        "scans": list(SCANS),
        "restart": RESTARTS,
        "size": [(1, 1), (8, 8), (17, 9), (33, 50), (64, 47), (31, 100)],
        "quality": [100, 90, 40],
        "coding": ["plain", "optimised"],
        "smoothness": ["smooth", "noisy luma"],
    }
    kinds = ["CMYK", "EXIF orientation", "ICC profile", "comment and density", "12 bits", "lossless"]
    return [
        Family("JPEG", axes, make),
        Family("JPEG", {**axes, **ARITHMETIC}, make, name="arithmetic"),
        Family("JPEG", {"kind": kinds, "size": [(16, 16), (33, 25)]}, pillow, name="kinds"),
    ]
