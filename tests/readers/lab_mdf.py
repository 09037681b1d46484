"""Measurement Data Format, versions 3 and 4, its blocks put together here as ASAM's specifications lay them out."""

from __future__ import annotations

import struct
from collections.abc import Sequence

Rows = Sequence[tuple[float, float, float]]


def mdf3(rows: Rows) -> bytes:
    """Version 3.00: one group, time as its master and two channels, records of three doubles, nothing scaled."""
    blocks, made = {}, bytearray(64)
    heads = [("HD", 164), ("DG", 28), ("CG", 26)]
    for name, length in heads + [(f"{kind}{n}", size) for kind, size in (("CN", 218), ("CC", 46)) for n in range(3)]:
        blocks[name] = len(made)
        made += bytes(length)
    data = len(made)
    made += struct.pack(f"<{3 * len(rows)}d", *(value for row in rows for value in row))

    def put(name: str, kind: bytes, length: int, layout: str, *values: object) -> None:
        packed = struct.pack("<2sH" + layout, kind, length, *values)
        made[blocks[name] : blocks[name] + len(packed)] = packed

    made[:64] = struct.pack("<8s8s8sHHHH32s", b"MDF     ", b"3.00    ", b"bench   ", 0, 0, 300, 0, b"")
    put(
        "HD", b"HD", 164, "IIIH10s8s32s32s32s32s", blocks["DG"], 0, 0, 1, b"01:01:2026", b"00:00:00", b"", b"", b"", b""
    )
    put("DG", b"DG", 28, "IIIIHHI", 0, blocks["CG"], 0, data, 1, 0, 0)
    put("CG", b"CG", 26, "IIIHHHI", 0, blocks["CN0"], 0, 0, 3, 24, len(rows))
    for n, (name, unit) in enumerate((("time", b"s"), ("u", b"V"), ("x", b"mm"))):
        following = blocks[f"CN{n + 1}"] if n < 2 else 0
        master, step = int(n == 0), 0.25 if n == 0 else 0.0
        put(
            f"CN{n}",
            b"CN",
            218,
            "IIIIIH32s128sHHHHddd",
            following,
            blocks[f"CC{n}"],
            0,
            0,
            0,
            master,
            name.encode(),
            b"",
            64 * n,
            64,
            3,
            0,
            0.0,
            0.0,
            step,
        )
        put(f"CC{n}", b"CC", 46, "Hdd20sHH", 0, 0.0, 0.0, unit, 65535, 0)
    return bytes(made)


ID, HD, FH, DG, CG, CN, CC = 64, 104, 56, 64, 104, 160, 96
"""Bytes of the blocks of version 4 that stand in `mdf4`; those of text and data follow their content."""
VOLT = 0.25
"""V that a count of the command is: it is stored as whole numbers, which the file's own conversion makes volts of."""


def mdf4(rows: Rows) -> bytes:
    """Version 4.10: one group, time (double) as its master, command (16-bit counts, linear), displacement (double)."""
    names = [("time", "s"), ("u", "V"), ("x", "mm")]
    fh, dg, cg = ID + HD, ID + HD + FH, ID + HD + FH + DG
    cn = [cg + CG + n * CN for n in range(3)]
    cc = cn[-1] + CN
    texts = [text_block(word) for pair in names for word in pair] + [text_block("")]
    starts = [cc + CC + sum(map(len, texts[:n])) for n in range(len(texts) + 1)]
    made = struct.pack("<8s8s8s4xH30xHH", b"MDF     ", b"4.10    ", b"bench   ", 410, 0, 0)
    made += block(b"HD", [dg, fh, 0, 0, 0, 0], struct.pack("<QhhBBBxdd", 0, 0, 0, 0, 0, 0, 0.0, 0.0))
    made += block(b"FH", [0, starts[-2]], struct.pack("<QhhB3x", 0, 0, 0, 0))
    made += block(b"DG", [0, cg, starts[-1], 0], struct.pack("<B7x", 0))
    made += block(b"CG", [0, cn[0], 0, 0, 0, 0], struct.pack("<QQHH4xII", 0, len(rows), 0, 0, 18, 0))
    for n, (kind, place, bits) in enumerate([(4, 0, 64), (2, 8, 16), (4, 10, 64)]):
        links = [cn[n + 1] if n < 2 else 0, 0, starts[2 * n], 0, cc if n == 1 else 0, 0, starts[2 * n + 1], 0]
        master = (2, 1) if n == 0 else (0, 0)
        made += block(b"CN", links, struct.pack("<4BIIIIBxH6d", *master, kind, 0, place, bits, 0, 0, 0, 0, *[0.0] * 6))
    made += block(b"CC", [0, 0, 0, 0], struct.pack("<BBHHHdddd", 1, 0, 0, 0, 2, 0.0, 0.0, 0.0, VOLT))
    records = b"".join(struct.pack("<dhd", t, round(u / VOLT), x) for t, u, x in rows)
    return made + b"".join(texts) + block(b"DT", [], records)


def text_block(word: str) -> bytes:
    """A block of text, which a zero ends and zeros fill up to eight bytes."""
    text = word.encode() + b"\0"
    return block(b"TX", [], text + bytes(-len(text) % 8))


def block(kind: bytes, links: Sequence[int], content: bytes) -> bytes:
    """A block of version 4: its kind, its length, its links, its content."""
    head = struct.pack("<4s4xQQ", b"##" + kind, 24 + 8 * len(links) + len(content), len(links))
    return head + struct.pack(f"<{len(links)}q", *links) + content
