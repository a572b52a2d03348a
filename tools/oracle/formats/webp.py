"""WebP by libwebp in Pillow: lossless and lossy, with alpha, profiles and animations; decoded by libwebp."""

import io

import numpy as np
from PIL import Image

from case import Family, Reference, noise, smooth

def make(rng, size, alpha, lossless, quality, method, content, extra):
    height, width = size
    if not lossless and content == "noise":
        return None
    channels = {"none": 3, "smooth": 4, "noise": 4, "opaque": 4}[alpha]
    if content == "few colours":
        colours = noise(rng, (int(rng.integers(1, 17)), channels), 255).astype(np.uint8)
        picture = colours[rng.integers(0, len(colours), (height, width))]
    elif content == "noise":
        picture = noise(rng, (height, width, channels), 255).astype(np.uint8)
    elif content == "grey":
        picture = np.repeat(smooth(rng, height, width, 1), channels, axis=2)
    else:
        picture = smooth(rng, height, width, channels)
    if channels == 4:
        picture[:, :, 3] = {
            "smooth": smooth(rng, height, width, 1)[:, :, 0],
            "noise": noise(rng, (height, width), 255),
            "opaque": np.full((height, width), 255),
        }[alpha]
    options = {"lossless": lossless, "quality": quality, "method": method, "exact": True}
    if extra == "ICC profile":
        options["icc_profile"] = bytes(range(200))
    if extra == "EXIF orientation":
        exif = Image.Exif()
        exif[0x0112] = 6
        options["exif"] = exif
    if extra == "low alpha quality":
        options["alpha_quality"] = 30
    out = io.BytesIO()
    Image.fromarray(picture).save(out, "WebP", **options)
    data = out.getvalue()
    image = Image.open(io.BytesIO(data))
    values = np.asarray(image).astype(float) / 255
    if lossless and not np.array_equal(values * 255, picture[:, :, : values.shape[2]]):
        raise AssertionError("libwebp is lossless")
    # Lossy files, too, must be the same: of 2160 all were.
    return "webp", data, Reference(values)


def animation(rng, frames, size):
    pictures = [Image.fromarray(noise(rng, (*size, 3), 255).astype(np.uint8)) for _ in range(frames)]
    out = io.BytesIO()
    pictures[0].save(out, "WebP", save_all=True, append_images=pictures[1:], lossless=True)
    return "webp", out.getvalue(), Reference(np.asarray(pictures[0]) / 255)


def families():
    axes = {
        "lossless": [True, False],
        "alpha": ["none", "smooth", "noise", "opaque"],
        "content": ["smooth", "noise", "few colours", "grey"],
        "size": [(1, 1), (3, 2), (17, 33), (64, 40), (15, 130)],
        "quality": [0, 50, 100],
        "method": [0, 4, 6],
        "extra": ["none", "ICC profile", "EXIF orientation", "low alpha quality"],
    }
    return [
        Family("WebP", axes, make),
        Family("WebP", {"frames": [2, 3], "size": [(8, 8), (5, 9)]}, animation, name="animation"),
    ]
