"""KTX2 with ASTC blocks, encoded and decoded by Arm's astcenc."""

import struct

import numpy as np
from astc_encoder import ASTCConfig, ASTCContext, ASTCImage, ASTCProfile, ASTCSwizzle, ASTCType

from case import Family, Reference, smooth
from formats import ktx2

# Width and height of a block, in the order of Vulkan's numbers, which begin here: linear, then sRGB.
FIRST = 157
BLOCKS = [(4, 4), (5, 4), (5, 5), (6, 5), (6, 6), (8, 5), (8, 6), (8, 8), (10, 5), (10, 6), (10, 8), (10, 10), (12, 10), (12, 12)]
# Decoders may round the 16 bits of the specification to 8 in one step or cut them.
TOLERANCE = 1.01 / 255


def descriptor(block, is_srgb):
    """Colour model 162 is ASTC; one sample of 128 bits."""
    sample = struct.pack("<HBBIII", 0, 127, 0, 0, 0, 0xFFFFFFFF)
    head = struct.pack("<IHH", 0, 2, 40) + bytes([162, 1, 2 if is_srgb else 1, 0, block[0] - 1, block[1] - 1, 0, 0])
    return struct.pack("<I", 44) + head + bytes([16]) + bytes(7) + sample


def make(rng, block, size, is_srgb, scheme, swizzle, orientation, content):
    height, width = size
    context = ASTCContext(ASTCConfig(ASTCProfile.LDR_SRGB if is_srgb else ASTCProfile.LDR, *block, quality=10))
    picture = smooth(rng, height, width, 4)
    if content == "opaque":
        picture[:, :, 3] = 255
    if content == "noise":
        picture = rng.integers(0, 256, picture.shape, dtype=np.uint8)
    straight = ASTCSwizzle.from_str("RGBA")
    blocks = context.compress(ASTCImage(ASTCType.U8, width, height, data=picture.tobytes()), straight)
    decoded = ASTCImage(ASTCType.U8, width, height)
    context.decompress(blocks, decoded, straight)
    values = np.frombuffer(decoded.data, np.uint8).reshape(height, width, 4) / 255
    pairs = [("KTXorientation", orientation.encode())] if orientation != "none" else []
    pairs += [("KTXswizzle", swizzle.encode())] if swizzle != "none" else []
    values = values[::-1] if orientation.endswith("u") else values
    values = values[:, ::-1] if orientation.startswith("l") else values
    optional = 0
    if swizzle != "none":
        values, optional = ktx2.swizzled(values, swizzle)
    file = ktx2.write(
        FIRST + 2 * BLOCKS.index(block) + is_srgb, [blocks], type_size=1, texel_bytes=16, channels=1, width=width,
        height=height, layers=0, stated_levels=1, scheme=scheme, pairs=b"".join(ktx2.pair(*each) for each in pairs),
        table=descriptor(block, is_srgb),
    )  # fmt: skip
    return "ktx2", file, Reference(values, tolerance=TOLERANCE, optional=optional)


def families():
    axes = {
        "block": BLOCKS,
        "size": [(4, 4), (17, 33), (24, 10)],
        "is_srgb": [False, True],
        "scheme": ["none", "zstd"],
        "swizzle": ["none", "rrrg", "bgra", "gggr"],
        "orientation": ["none", "ru"],
        "content": ["smooth", "opaque", "noise"],
    }
    return [Family("KTX2", axes, make, name="ASTC", traits={"format": "ASTC"})]
