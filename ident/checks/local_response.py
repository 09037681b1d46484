"""A frequency response without leakage, by the local polynomial method (Schoukens, Pintelon et al. 2006)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.run import Samples

POINTS = 80  # frequencies at which the response is wanted
HALF_WIDTH = 8  # spectral lines either side of each
DEGREE = 2  # of the polynomials
UNKNOWNS = 2 * (DEGREE + 1)
EMPTY = 1e-9  # of the strongest lines' amplitude: below, it is the spectrum's rounding, not the command


@dataclass(frozen=True, eq=False)
class LocalResponse:
    """`frequency` (F,) in Hz, response `gain` (F,) and the standard deviation `scatter` (F,) of its noise."""

    frequency: Samples
    gain: NDArray[np.complex128]
    scatter: Samples


def local_response(u: Samples, y: Samples, sample_rate: float, highest: float) -> LocalResponse | None:
    """Around each frequency, Y = H U + T over the lines of the whole record, H and T polynomials of the line.

    T takes the transients at both ends, which averages over windows leave in as an error of several per cent. u and y
    are (n,); `highest` in Hz ends the band. Frequencies at which the command has no power are left out. None where the
    band has too few lines, or the command has power nowhere.
    """
    spectra = np.fft.rfft(u - u.mean()), np.fft.rfft(y - y.mean())
    last = min(int(highest * len(u) / sample_rate), len(spectra[0]) - 1 - HALF_WIDTH)
    if last < 1 + 3 * HALF_WIDTH:
        return None
    centres = np.unique(np.linspace(1 + HALF_WIDTH, last, POINTS).astype(int))
    beside = np.arange(-HALF_WIDTH, HALF_WIDTH + 1)
    powers = (beside / HALF_WIDTH)[:, None] ** np.arange(DEGREE + 1)
    lines_u, lines_y = (spectrum[centres[:, None] + beside] for spectrum in spectra)
    size = np.sqrt(np.mean(np.abs(lines_u) ** 2, axis=1))
    rounding = np.finfo(float).eps * np.sqrt(len(u)) * np.abs(u).max()
    excited = size > max(EMPTY * size.max(), rounding)
    if not excited.any():
        return None
    centres, scale = centres[excited], size[excited, None]
    lines_u, lines_y = lines_u[excited] / scale, lines_y[excited] / scale
    regressor = np.concatenate(
        [lines_u[:, :, None] * powers, np.broadcast_to(powers, (len(centres), *powers.shape))], 2
    )
    inverse = np.linalg.pinv(regressor, rcond=1e-10)
    found = (inverse @ lines_y[:, :, None])[:, :, 0]
    left = lines_y - (regressor @ found[:, :, None])[:, :, 0]
    noise = np.sqrt(np.sum(np.abs(left) ** 2, axis=1) / (len(beside) - UNKNOWNS))
    scatter: Samples = noise * np.linalg.norm(inverse[:, 0, :], axis=1)
    return LocalResponse(centres * sample_rate / len(u), found[:, 0], scatter)
