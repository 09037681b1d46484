"""A recorded signal in, its slopes at the samples and what it covers between them out."""

from ident.slopes.brakes import Brake, brakes
from ident.slopes.slope import bends, bends_of_way, curvatures, slopes

__all__ = ["Brake", "bends", "bends_of_way", "brakes", "curvatures", "slopes"]
