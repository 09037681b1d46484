"""The slope of a recorded signal at its samples, and what a motion covers between them."""

from ident.slopes.brakes import Brake, brakes
from ident.slopes.slope import bends, bends_of_way, curvatures, slopes

__all__ = ["Brake", "bends", "bends_of_way", "brakes", "curvatures", "slopes"]
