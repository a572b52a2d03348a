"""A writer of TIFF and BigTIFF that can combine whatever the specification allows."""

import struct
import zlib

import imagecodecs
import numpy as np

NONE, LZW, JPEG, ADOBE_DEFLATE, DEFLATE, PACKBITS = 1, 5, 7, 8, 32946, 32773
LERC, LZMA, ZSTD, WEBP, JPEG2000 = 34887, 34925, 50000, 50001, 34712
SHORT, LONG, LONG8 = 3, 4, 16
UINT, INT, FLOAT = 1, 2, 3


def packed(rows, bits, order):
    """Rows of samples[y, i] as bytes: whole bytes in the file's order, else bits from the highest down, rows padded.
    Floats of 24 bits follow the file's order, integers of 24 bits do not (GDAL, OpenImageIO, tifffile)."""
    if rows.dtype == np.uint8 and bits == 8:
        return rows.tobytes()
    if order == "float 24 <":
        raw = rows.astype("<u4").view(np.uint8).reshape(*rows.shape, 4)[:, :, :3]
        return raw.tobytes()
    if bits in (8, 16, 32, 64):
        return rows.astype(rows.dtype.newbyteorder(order)).tobytes()
    spread = ((rows.astype(np.uint32)[:, :, None] >> np.arange(bits - 1, -1, -1)) & 1).astype(np.uint8)
    return np.packbits(spread.reshape(len(rows), -1), axis=1).tobytes()


def predicted(block, predictor, bits):
    """Samples[y, x, channel] replaced by differences from the pixel to the left."""
    if predictor == 1:
        return block
    if predictor == 2:
        unsigned = block.view(block.dtype.str.replace("f", "u").replace("i", "u"))
        out = unsigned.copy()
        out[:, 1:] -= unsigned[:, :-1]
        return out
    # Predictor 3 (Adobe's TIFF technical note 3): the bytes of each row by their significance, then differences of them.
    height, width, channels = block.shape
    raw = np.ascontiguousarray(block.reshape(height, -1)).astype(block.dtype.newbyteorder(">"))
    planes = raw.view(np.uint8).reshape(height, width * channels, -1)
    if bits == 24:
        planes = planes[:, :, 1:]
    planes = planes.transpose(0, 2, 1).reshape(height, -1)
    out = planes.copy()
    out[:, channels:] -= planes[:, :-channels]
    return out


def compressed(data, block, compression, level):
    """A strip or tile: `data` are its bytes, `block` its samples for codecs that know pixels."""
    if compression == NONE:
        return data
    if compression == LZW:
        return imagecodecs.lzw_encode(data)
    if compression in (ADOBE_DEFLATE, DEFLATE):
        return zlib.compress(data, level)
    if compression == PACKBITS:
        # Rows are packed one by one.
        rows = len(block)
        step = len(data) // rows
        return b"".join(imagecodecs.packbits_encode(data[i * step : (i + 1) * step]) for i in range(rows))
    if compression == ZSTD:
        return imagecodecs.zstd_encode(data, level=level)
    if compression == LZMA:
        return imagecodecs.lzma_encode(data)
    block = block[:, :, 0] if block.shape[2] == 1 else block
    block = np.ascontiguousarray(block)
    if compression == WEBP:
        return imagecodecs.webp_encode(block, lossless=True)
    if compression == LERC:
        return imagecodecs.lerc_encode(block, level=0, planar=False)
    if compression == JPEG2000:
        return imagecodecs.jpeg2k_encode(block, level=0, codecformat="J2K")
    if compression == JPEG:
        return imagecodecs.jpeg8_encode(block, level=100, subsampling="444", colorspace="RGB", outcolorspace="RGB")
    raise ValueError(compression)


def write(pixels, *, bits, photometric, order="<", big=False, compression=NONE, predictor=1, planar=False, tile=None,
          rows_per_strip=None, sample_format=None, extra_samples=None, reversed_bits=False, level=6, tags=()):  # fmt: skip
    """The bytes of a file with pixels[y, x, sample]; `tile` is (height, width), None for strips; `tags` are further
    (number, type, values)."""
    height, width, samples = pixels.shape
    sample_order = "float 24 <" if (bits, sample_format, order) == (24, FLOAT, "<") else order
    planes = [pixels[:, :, i : i + 1] for i in range(samples)] if planar else [pixels]
    block_height, block_width = tile or (rows_per_strip or height, width)
    chunks = []
    for plane in planes:
        for y in range(0, height, block_height):
            for x in range(0, width, block_width):
                block = plane[y : y + block_height, x : x + block_width]
                if tile:
                    missing = (block_height - block.shape[0], block_width - block.shape[1])
                    block = np.pad(block, ((0, missing[0]), (0, missing[1]), (0, 0)), mode="edge")
                block = np.ascontiguousarray(block)
                rows = predicted(block, predictor, bits)
                raw = rows.tobytes() if predictor == 3 else packed(rows.reshape(len(block), -1), bits, sample_order)
                data = compressed(raw, block, compression, level)
                if reversed_bits:
                    data = imagecodecs.bitorder_encode(data)
                chunks.append(data)
    entries = [
        (256, LONG, [width]),
        (257, LONG, [height]),
        (258, SHORT, [bits] * samples),
        (259, SHORT, [compression]),
        (262, SHORT, [photometric]),
        (277, SHORT, [samples]),
        (284, SHORT, [2 if planar else 1]),
        *tags,
    ]
    if predictor != 1:
        entries.append((317, SHORT, [predictor]))
    if reversed_bits:
        entries.append((266, SHORT, [2]))
    if extra_samples:
        entries.append((338, SHORT, extra_samples))
    if sample_format:
        entries.append((339, SHORT, [sample_format] * samples))
    if compression == LERC:
        entries.append((50674, LONG, [4, 0]))
    if tile:
        entries += [(322, SHORT, [tile[1]]), (323, SHORT, [tile[0]])]
    elif rows_per_strip:
        entries.append((278, LONG, [rows_per_strip]))
    return assembled(entries, chunks, (324, 325) if tile else (273, 279), order, big)


def assembled(entries, chunks, chunk_tags, order, big):
    """Header, chunks, values and directory in this order."""
    file = bytearray(struct.pack(order + "2sHHHQ", b"", 43, 8, 0, 0) if big else struct.pack(order + "2sHI", b"", 42, 0))
    file[:2] = b"II" if order == "<" else b"MM"
    offsets = []
    for data in chunks:
        file += bytes(len(file) % 2)
        offsets.append(len(file))
        file += data
    long = LONG8 if big else LONG
    entries = [*entries, (chunk_tags[0], long, offsets), (chunk_tags[1], long, [len(data) for data in chunks])]
    inline, number = (8, "Q") if big else (4, "I")
    directory = struct.pack(order + ("Q" if big else "H"), len(entries))
    for tag, kind, values in sorted(entries):
        code = {SHORT: "H", LONG: "I", LONG8: "Q", 2: "B", 12: "d"}[kind]
        data = struct.pack(f"{order}{len(values)}{code}", *values)
        if len(data) > inline:
            file += bytes(len(file) % 2)
            place = struct.pack(order + number, len(file))
            file += data
        else:
            place = data + bytes(inline - len(data))
        directory += struct.pack(order + "HH" + number, tag, kind, len(values)) + place
    file += bytes(len(file) % 2)
    struct.pack_into(order + number, file, 8 if big else 4, len(file))
    return bytes(file + directory + bytes(inline))
