"""A matrix and a model in, both as a fit takes them out: one pipeline of named steps, each told and switchable."""

from ident.preprocessing.pipeline import NAMES, STEPS, off_steps, prepare, screen

__all__ = ["NAMES", "STEPS", "off_steps", "prepare", "screen"]
