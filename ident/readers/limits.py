"""How much a matrix may hold; what declares more is refused before anything is allocated."""

from __future__ import annotations

from dataclasses import dataclass

from ident.errors import Unusable


@dataclass(frozen=True)
class Limits:
    """Bounds on untrusted input, in bytes unless said otherwise.

    The largest matrix of the paper (84 runs of 30 s at 4096 Hz, three channels) takes 0.25 GB of samples.
    """

    description: int = 1 << 20  # matrix.yaml
    file: int = 1 << 30  # one run file
    total: int = 2 << 30  # all run files of a matrix, unpacked
    channel: int = 1 << 28  # one column as float64: 33.5 million samples, over two hours at 4096 Hz
    samples: int = 2 << 30  # all channels of a matrix as float64
    runs: int = 5000  # number of runs
    members: int = 20000  # number of files in an archive
    ratio: float = 300.0  # unpacked by packed size of one archive member; measured noise packs to 2-10
    parser_memory: int = 3 << 30  # of the process of a parser from elsewhere
    parser_seconds: float = 10.0  # of a processor that it may take, by the clock where the system counts none
    parser_wait: float = 120.0  # seconds by the clock: a busy machine lets it wait for a processor
    ratio_from: int = 16 << 20  # the ratio counts from this unpacked size on: a constant channel packs well too


LIMITS = Limits()


def check_size(size: int, limit: int, what: str, where: str) -> None:
    """Refuse a declared size. Raises Unusable: ``too-large``."""
    if size > limit:
        raise Unusable(
            "too-large",
            f"{what} takes {size / 2**20:.0f} MB where {limit / 2**20:.0f} MB are allowed",
            where,
            "split the record into shorter runs",
        )
