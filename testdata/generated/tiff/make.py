"""Makes the TIFFs of this folder and the checksums of their pixels.

Writers: OpenImageIO (libtiff), tifffile with imagecodecs, Pillow. The checksums are those of the pixels that tifffile, and
where it reads the file also OpenImageIO, decode: the two must agree. Run with Python 3, numpy, tifffile, imagecodecs,
OpenImageIO and Pillow. Compressors may write other bytes in other versions; the checksums must stay the same.
"""

import struct
import zlib
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import tifffile
from PIL import Image

HERE = Path(__file__).parent
WIDTH, HEIGHT = 37, 29
rng = np.random.default_rng(7)


def picture(dtype, channels, bits=None):
    """A smooth picture with some noise, of full range: compressible, and different in each pixel and channel."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    planes = [0.5 + 0.4 * np.sin(x / (5 + c) + c) * np.cos(y / (4 + c)) for c in range(channels)]
    value = np.stack(planes, -1) + rng.uniform(-0.05, 0.05, (HEIGHT, WIDTH, channels))
    value = np.clip(value, 0, 1)
    value[0, 0], value[0, 1] = 0, 1
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return (value * 3 - 1).astype(dtype)
    if dtype.kind == "i":
        return np.round((value * 2 - 1) * np.iinfo(dtype).max).astype(dtype)
    return np.round(value * (2 ** (bits or dtype.itemsize * 8) - 1)).astype(dtype)


def with_oiio(name, array, **attributes):
    types = {"float16": "half", "float32": "float", "float64": "double"}
    spec = oiio.ImageSpec(WIDTH, HEIGHT, array.shape[2], types.get(array.dtype.name, array.dtype.name))
    spec["DateTime"] = "2026:01:01 00:00:00"
    for key, value in attributes.items():
        key = key.replace("_", ":", 1)
        if key == "tile":
            spec.tile_width = spec.tile_height = value
            spec.tile_depth = 1
        else:
            spec[key] = value
    out = oiio.ImageOutput.create("tif")
    assert out.open(str(HERE / name), spec), out.geterror()
    assert out.write_image(array), out.geterror()
    out.close()


def with_tifffile(name, array, **options):
    options.setdefault("metadata", None)
    tifffile.imwrite(HERE / name, array.squeeze(-1) if array.shape[-1] == 1 else array, **options)


def make():
    grey8, rgb8, rgba8 = (picture("u1", c) for c in (1, 3, 4))
    grey16, rgb16 = (picture("u2", c) for c in (1, 3))

    # Compressions, predictors, tiles, planes.
    with_oiio("lzw_tiles_rgb8.tif", rgb8, compression="lzw", tiff_Predictor=1, tile=16)
    with_oiio("lzw_tiles_predictor_rgb16.tif", rgb16, compression="lzw", tiff_Predictor=2, tile=16)
    with_oiio("lzw_strips_predictor_rgb8.tif", rgb8, compression="lzw", tiff_Predictor=2, tiff_RowsPerStrip=7)
    with_oiio("lzw_planar_tiles_rgb8.tif", rgb8, compression="lzw", planarconfig="separate", tile=16)
    with_oiio("zip_planar_strips_predictor_rgb16.tif", rgb16, compression="zip", planarconfig="separate", tiff_RowsPerStrip=8)
    with_oiio("zip_tiles_predictor_float_rgb.tif", picture("f4", 3), compression="zip", tiff_Predictor=3, tile=16)
    with_oiio("zip_predictor_half_grey.tif", picture("f2", 1), compression="zip", tiff_Predictor=3)
    with_tifffile("deflate_predictor_double_grey_be.tif", picture("f8", 1), compression="deflate", predictor=3, byteorder=">")
    with_tifffile("zstd_big_predictor_rgb16_be.tif", rgb16, compression="zstd", predictor=2, tile=(16, 32), bigtiff=True, byteorder=">")
    with_tifffile("zstd_float_predictor_grey.tif", picture("f4", 1), compression="zstd", predictor=3, rowsperstrip=6)
    with_tifffile("packbits_grey8.tif", (grey8 // 64) * 64, compression="packbits", rowsperstrip=5)
    with_tifffile("packbits_rgb16_be.tif", rgb16, compression="packbits", byteorder=">", photometric="rgb")
    with_tifffile("webp_lossless_tiles_rgba8.tif", rgba8, compression="webp", compressionargs={"lossless": True}, tile=(16, 16))
    with_tifffile("webp_lossless_rgb8.tif", rgb8, compression="webp", compressionargs={"lossless": True})

    # Types of numbers.
    with_tifffile("bilevel.tif", grey8[..., 0:1] > 128, photometric="minisblack")
    for bits in (2, 4, 6, 10, 12, 14):
        array = picture("u1" if bits <= 8 else "u2", 1)
        with_oiio(f"grey_{bits}bit.tif", array, compression="none", oiio_BitsPerSample=bits)
    with_oiio("rgb_12bit_tiles.tif", picture("u2", 3), compression="lzw", tiff_Predictor=1, oiio_BitsPerSample=12, tile=16)
    with_oiio("rgb_10bit_planar.tif", picture("u2", 3), compression="none", planarconfig="separate", oiio_BitsPerSample=10)
    with_tifffile("uint32_heights_predictor.tif", (picture("u2", 1).astype("u4") * 3), compression="lzw", predictor=2)
    with_tifffile("uint32_full_range.tif", picture("u4", 1), photometric="minisblack")
    with_tifffile("uint32_rgb.tif", picture("u4", 3), photometric="rgb")
    with_tifffile("int16_heights_be.tif", picture("i2", 1) // 8, compression="deflate", predictor=2, byteorder=">", photometric="minisblack")
    with_tifffile("int32_heights.tif", picture("i4", 1) // 100000, photometric="minisblack")
    with_tifffile("int8_heights.tif", picture("i1", 1), photometric="minisblack")
    with_tifffile("int16_rgb.tif", picture("i2", 3), photometric="rgb")
    float24(picture("f4", 1))
    uint24(picture("u4", 1, 24))

    # Meanings.
    with_tifffile("minis_white_8bit.tif", grey8, photometric="miniswhite")
    with_tifffile("minis_white_16bit.tif", grey16, photometric="miniswhite")
    Image.fromarray(rgb8).quantize(200).save(HERE / "palette_8bit.tif", compression="tiff_lzw")
    colormap = rng.integers(0, 65536, (3, 256), dtype="u2")
    with_tifffile("palette_16bit_colours.tif", grey8, photometric="palette", colormap=colormap)
    with_tifffile("grey_alpha.tif", picture("u1", 2), photometric="minisblack", extrasamples=["unassalpha"], planarconfig="contig")
    with_tifffile("two_channels_unspecified.tif", picture("u2", 2), photometric="minisblack", extrasamples=["unspecified"], planarconfig="contig")
    with_tifffile("rgb_unspecified.tif", rgba8, photometric="rgb", extrasamples=["unspecified"])
    with_tifffile("rgb_of_6_samples.tif", picture("u1", 6), photometric="rgb", planarconfig="contig")
    with_tifffile("grey_of_6_samples.tif", picture("u1", 6), photometric="minisblack", planarconfig="contig")
    tifffile.imwrite(HERE / "two_images.tif", np.stack([grey8[..., 0], 255 - grey8[..., 0]]), photometric="minisblack", metadata=None)

    # Odd arrangements.
    old_lzw(grey8)
    reversed_bits(grey8)
    sparse(grey16)
    with_tifffile("orientation_6.tif", rgb8, photometric="rgb", extratags=[(274, 3, 1, 6, True)])

    # Without data, and on the ground.
    nodata()

    # Not read.
    with_tifffile("refused_lerc.tif", picture("f4", 1), compression="lerc")
    with_tifffile("refused_lzma.tif", grey8, compression="lzma")
    with_tifffile("refused_jpeg.tif", grey8, compression="jpeg")
    with_tifffile("refused_complex.tif", picture("f4", 1).astype("c8"))


def float24(array):
    """tifffile writes no such floats, but reads them: the upper 24 bits of a 32-bit layout with another exponent."""
    bits = array.astype("f4").view("u4").astype("i8")
    sign, exponent, mantissa = bits >> 31, (bits >> 23 & 255) - 127, bits >> 7 & 0xFFFF
    packed = np.where(exponent < -62, 0, sign << 23 | (exponent + 63) << 16 | mantissa).astype("<u4")
    raw = packed.view("u1").reshape(HEIGHT, WIDTH, 4)[..., :3]
    by_hand("float24_grey.tif", raw.tobytes(), 24, 3)


def uint24(array):
    """The most significant byte first, as OpenImageIO and tifffile read it in files of either byte order."""
    raw = array.astype(">u4").view("u1").reshape(HEIGHT, WIDTH, 4)[..., 1:]
    by_hand("uint24_full_range.tif", raw.tobytes(), 24, 1)


def by_hand(name, raw, bits, sample_format, compression=1, extra=()):
    """One strip of grey, little-endian."""
    entries = [
        (256, 3, 1, WIDTH), (257, 3, 1, HEIGHT), (258, 3, 1, bits), (259, 3, 1, compression), (262, 3, 1, 1),
        (273, 4, 1, 8), (277, 3, 1, 1), (278, 3, 1, HEIGHT), (279, 4, 1, len(raw)), (339, 3, 1, sample_format), *extra,
    ]
    entries.sort()
    raw += b"\0" * (len(raw) % 2)
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries) + bytes(4)
    (HERE / name).write_bytes(b"II*\0" + struct.pack("<I", 8 + len(raw)) + raw + directory)


def old_lzw(array):
    """LZW from the least significant bit, as the first writers had it: literals of 9 bits, cleared before codes grow."""
    codes = []
    for start in range(0, array.size, 200):
        codes += [256, *array.ravel()[start : start + 200].tolist()]
    codes.append(257)
    number = sum(code << 9 * index for index, code in enumerate(codes))
    by_hand("lzw_old.tif", number.to_bytes((9 * len(codes) + 7) // 8, "little"), 8, 1, compression=5)


def reversed_bits(array):
    raw = np.packbits(array[..., 0] > 128, axis=1)
    raw = np.packbits(np.unpackbits(raw[..., None], axis=-1)[..., ::-1], axis=-1)
    by_hand("fill_order_2_bilevel.tif", raw.tobytes(), 1, 1, extra=[(266, 3, 1, 2)])


def sparse(array):
    """Tiles that GDAL leaves out where there are no data: offset and length of 0."""
    name = "sparse_tiles_nodata.tif"
    with_tifffile(name, array, tile=(16, 16), photometric="minisblack", compression="deflate", extratags=[(42113, 2, 0, "77", True)])
    with tifffile.TiffFile(HERE / name) as tiff:
        tags = [tiff.pages[0].tags[tag] for tag in ("TileOffsets", "TileByteCounts")]
        sizes = [struct.calcsize(tifffile.TIFF.DATA_FORMATS[tag.dtype][-1]) for tag in tags]
        places = [(tag.valueoffset + size * index, size) for tag, size in zip(tags, sizes) for index in (1, 4)]
    data = bytearray((HERE / name).read_bytes())
    for offset, size in places:
        data[offset : offset + size] = bytes(size)
    (HERE / name).write_bytes(data)


def nodata():
    def write(name, array, value, **options):
        with_tifffile(name, array, extratags=[(42113, 2, 0, value, True), *options.pop("extratags", [])], **options)

    heights = picture("f4", 1) * 500 + 700
    heights[3:6, 4:9] = -3.4028234663852886e38
    write("nodata_float.tif", heights, "-3.4028235e+38", compression="deflate")
    heights = heights.copy()
    heights[3:6, 4:9] = np.nan
    write("nodata_nan.tif", heights, "nan")
    signed = picture("i2", 1) // 16
    signed[10:20, 0] = -32768
    # 30 m a pixel in a projected system of metres, and 1 second of arc in a geographic one.
    metres = [(33550, 12, 3, (30.0, 30.0, 0.0), True), (34735, 3, 12, (1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9001), True)]
    write("nodata_int16_projected.tif", signed, "-32768", photometric="minisblack", extratags=metres)
    degrees = [(33550, 12, 3, (1 / 3600, 1 / 3600, 0.0), True), (34735, 3, 8, (1, 1, 0, 1, 1024, 0, 1, 2), True)]
    write("heights_geographic.tif", signed.astype("f4"), "-32768", extratags=degrees)
    unsigned = picture("u2", 1)
    unsigned[unsigned == 0] = 1
    unsigned[7, 7:12] = 0
    write("nodata_uint16.tif", unsigned, "0", photometric="minisblack")
    colours = picture("u1", 3)
    colours[2, 3:9] = 0
    colours[5, 5, 0] = 0
    write("nodata_rgb8.tif", colours, "0", photometric="rgb")
    write("nodata_elsewhere_uint8.tif", picture("u1", 1), "-9999", photometric="minisblack")
    # A mask: 1 where there are data.
    mask = np.ones((HEIGHT, WIDTH), bool)
    mask[4:8, 20:] = False
    with tifffile.TiffWriter(HERE / "mask_uint16.tif") as tiff:
        tiff.write(unsigned[..., 0], photometric="minisblack", metadata=None)
        tiff.write(mask, photometric="mask", subfiletype=4, compression="deflate", metadata=None)


def expected(name):
    """The pixels as they should be read, and the name of their type."""
    with tifffile.TiffFile(HERE / name) as tiff:
        page = tiff.pages[0]
        array, bits = page.asarray(), int(np.ravel(page.bitspersample)[0])
        tag = page.tags.get("GDAL_NODATA")
        nodata = None if tag is None else float(tag.value)
        if page.planarconfig == 2 and array.ndim == 3:
            array = np.moveaxis(array, 0, -1)
        array = array.reshape(page.imagelength, page.imagewidth, -1)
        photometric = int(page.photometric)
        if photometric == 3:
            return in_eight_bits(np.moveaxis(page.colormap[:, array[..., 0]], 0, -1))
        if array.dtype == bool:
            array, bits = array.astype("u1"), 1
        empty = None
        if nodata is not None and holds(array.dtype, nodata):
            same = np.isnan(array) if np.isnan(nodata) else array == array.dtype.type(nodata)
            empty = same.all(axis=-1)
        if len(tiff.pages) == 2 and tiff.pages[1].subfiletype == 4:
            empty = tiff.pages[1].asarray() == 0
        if name == "sparse_tiles_nodata.tif":
            empty = np.zeros(array.shape[:2], bool)
            empty[0:16, 16:32] = empty[16:29, 16:32] = True
    if array.shape[2] > 4:
        array = array[..., :3]
    kind, largest = array.dtype.kind, 2.0**bits - 1
    if photometric == 0 and kind == "u":
        array = (2**bits - 1 - array).astype(array.dtype)
    if kind == "u" and bits <= 16:
        to = 255 if bits in (1, 2, 4, 8) else 65535
        array = np.floor(array.astype("f8") * to / largest + 0.5).astype("u1" if to == 255 else "u2")
        if empty is not None and empty.any():
            array = (array / np.float32(to)).astype("f4")
    elif kind == "u" and array.shape[2] > 1:
        array = (array / largest).astype("f4")
    elif kind == "u":
        # Parts of a full scale where one of the highest 8 bits is used, else heights in a unit; floats first in both cases.
        is_full = array.max() >= 2.0 ** (bits - 8)
        array = array.astype("f4")
        array = (array / np.float64(largest)).astype("f4") if is_full else array
    elif kind == "i":
        snorm = array.shape[2] > 1
        array = (np.maximum(array / (2.0 ** (bits - 1) - 1), -1) if snorm else array).astype("f4")
    elif array.dtype != np.float16:
        array = array.astype("f4")
    if empty is not None and empty.any():
        array[empty] = np.nan
    return array


def holds(dtype, value):
    """Whether samples of a type can have a value."""
    return dtype.kind == "f" or np.iinfo(dtype).min <= value <= np.iinfo(dtype).max


def in_eight_bits(colours):
    """Colours of 8 bits are stored as their 257-fold, or by many writers as their 256-fold."""
    is_eight = (colours % 257 == 0).all() or (colours % 256 == 0).all()
    return (colours >> 8).astype("u1") if is_eight else colours


def check_against_oiio(name, array):
    """Values as floats, where OpenImageIO means the same by them."""
    source = oiio.ImageInput.open(str(HERE / name), oiio.ImageSpec())
    if source is None:
        return "not read by OpenImageIO"
    bits = source.spec().get_int_attribute("oiio:BitsPerSample", 0)
    other = source.read_image("float")
    if other is None:
        return "not read by OpenImageIO: " + source.geterror()[:60]
    ours = array.astype("f8") / {"u1": 255, "u2": 65535}.get(array.dtype.str[1:], 1)
    difference = np.nanmax(np.abs(other[..., : ours.shape[2]] - ours))
    return f"OpenImageIO differs by {difference:.2g}" + (f" ({bits} bits)" if bits else "")


def main():
    make()
    lines = []
    for path in sorted(HERE.glob("*.tif")):
        if path.name.startswith("refused_") or path.name == "grey_of_6_samples.tif":
            continue
        array = expected(path.name)
        # The bits of a NaN are not part of the promise.
        data = np.where(np.isnan(array), np.float32(np.nan), array).astype(array.dtype) if array.dtype.kind == "f" else array
        crc = zlib.crc32(data.astype(data.dtype.newbyteorder("<")).tobytes())
        kind = {"u1": "U8", "u2": "U16", "f2": "F16", "f4": "F32"}[array.dtype.str[1:]]
        lines.append(f"{crc:08x} {kind} {array.shape[2]} {path.name}")
        print(lines[-1], "|", check_against_oiio(path.name, array))
    head = (
        "# CRC-32 of all samples, little-endian, row by row, channels interleaved, NaN as 0x7fc00000; sample type; channels; file.\n"
        f"# Made by make.py from the pixels that tifffile {tifffile.__version__} decodes.\n"
    )
    (HERE / "checksums.txt").write_text(head + "\n".join(lines) + "\n")


main()
