"""All families of all formats."""

import importlib

MODULES = ["png", "jpeg", "tga", "bmp", "webp", "tiff", "tiff_more", "hdr", "exr", "ktx2", "ktx2_astc", "dds"]


def families(names=None):
    """The families of the named formats, or of all."""
    found = []
    for module in MODULES:
        if not names or module.split("_")[0] in [name.lower() for name in names]:
            found += importlib.import_module(f"formats.{module}").families()
    if not found:
        raise SystemExit(f"oracle: no such format: choose of {', '.join(MODULES)}")
    return found
