"""Generators: one module a format, each with `families()`."""
