"""Generators: one module per format, each with `families()`."""
