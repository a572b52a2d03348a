"""Silences C libraries that print warnings on standard error."""

import contextlib
import os
import sys


@contextlib.contextmanager
def quiet():
    """Discards standard error, also that of C."""
    sys.stderr.flush()
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
