"""Tables as files: a CSV file a table, or all in one workbook of the Office Open XML format (ECMA-376)."""

from __future__ import annotations

import csv
import io
import math
import zipfile
from collections.abc import Mapping, Sequence
from typing import Any
from xml.sax.saxutils import escape

Record = Mapping[str, Any]
Records = Mapping[str, Sequence[Record]]
"""Records by the name of their table; the keys of a table's records are its columns."""
_LONGEST = 31  # characters of a sheet's name
_MOMENT = (2000, 1, 1, 0, 0, 0)  # of the files inside: the same tables are the same bytes
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""A spreadsheet takes text that begins so for a formula."""
_TYPES = "http://schemas.openxmlformats.org"
_HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'


def columns(records: Sequence[Record]) -> tuple[str, ...]:
    """Of all records, in the order in which they come."""
    return tuple(dict.fromkeys(name for record in records for name in record))


def as_csv(records: Sequence[Record]) -> bytes:
    """Comma-separated, UTF-8 with its mark, a header first; numbers with a decimal point, what is unknown empty."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    header = columns(records)
    writer.writerow(header)
    writer.writerows([_plain(record.get(name)) for name in header] for record in records)
    return text.getvalue().encode("utf-8-sig")


def as_zip(tables: Records) -> bytes:
    """A CSV file for each table."""
    return _packed({f"{name}.csv": as_csv(records) for name, records in tables.items()})


def as_xlsx(tables: Records) -> bytes:
    """A sheet for each table, its header in bold; numbers are numbers, all else is text and never a formula."""
    names = [escape(name[:_LONGEST]) for name in tables]
    places = range(1, len(names) + 1)
    sheets = "".join(
        f'<sheet name="{name}" sheetId="{n}" r:id="rId{n}"/>' for n, name in zip(places, names, strict=True)
    )
    kind = f"{_TYPES}/officeDocument/2006/relationships"
    links = "".join(
        f'<Relationship Id="rId{n}" Type="{kind}/worksheet" Target="worksheets/sheet{n}.xml"/>' for n in places
    )
    links += f'<Relationship Id="rId{len(names) + 1}" Type="{kind}/styles" Target="styles.xml"/>'
    parts = {
        "[Content_Types].xml": _content_types(len(names)),
        "_rels/.rels": _relations(f'<Relationship Id="rId1" Type="{kind}/officeDocument" Target="xl/workbook.xml"/>'),
        "xl/workbook.xml": f'<workbook xmlns="{_MAIN}" xmlns:r="{kind}"><sheets>{sheets}</sheets></workbook>',
        "xl/_rels/workbook.xml.rels": _relations(links),
        "xl/styles.xml": _STYLES,
    }
    parts |= {f"xl/worksheets/sheet{n}.xml": _sheet(of) for n, of in zip(places, tables.values(), strict=True)}
    return _packed({name: (_HEAD + text).encode() for name, text in parts.items()})


_MAIN = f"{_TYPES}/spreadsheetml/2006/main"
_FONT = '<sz val="11"/><name val="Calibri"/>'
_FONTS = f'<fonts count="2"><font>{_FONT}</font><font><b/>{_FONT}</font></fonts>'
_STYLES = (
    f'<styleSheet xmlns="{_MAIN}">{_FONTS}<fills count="1"><fill><patternFill patternType="none"/></fill></fills>'
    '<borders count="1"><border/></borders><cellStyleXfs count="1"><xf/></cellStyleXfs>'
    '<cellXfs count="2"><xf fontId="0" xfId="0"/><xf fontId="1" xfId="0" applyFont="1"/></cellXfs>'
    '<cellStyles count="1"><cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles></styleSheet>'
)


def _content_types(sheets: int) -> str:
    of = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {"workbook": "sheet.main", "styles": "styles"} | {
        f"worksheets/sheet{n + 1}": "worksheet" for n in range(sheets)
    }
    listed = "".join(
        f'<Override PartName="/xl/{name}.xml" ContentType="{of}.{kind}+xml"/>' for name, kind in parts.items()
    )
    relations = "application/vnd.openxmlformats-package.relationships+xml"
    rels = f'<Default Extension="rels" ContentType="{relations}"/>'
    return f'<Types xmlns="{_TYPES}/package/2006/content-types">{rels}{listed}</Types>'


def _relations(links: str) -> str:
    return f'<Relationships xmlns="{_TYPES}/package/2006/relationships">{links}</Relationships>'


def _sheet(records: Sequence[Record]) -> str:
    header = columns(records)
    rows = ["".join(_text(name, 1) for name in header)]
    rows += ["".join(_cell(record.get(name)) for name in header) for record in records]
    body = "".join(f"<row>{row}</row>" for row in rows)
    return f'<worksheet xmlns="{_MAIN}"><sheetData>{body}</sheetData></worksheet>'


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "<c/>"
    if isinstance(value, bool):
        return f'<c t="b"><v>{int(value)}</v></c>'
    return f"<c><v>{value!r}</v></c>" if isinstance(value, int | float) else _text(str(value))


def _text(value: str, style: int = 0) -> str:
    kept = "".join(sign for sign in value if sign.isprintable() or sign == "\n")
    return f'<c t="inlineStr" s="{style}"><is><t xml:space="preserve">{escape(kept)}</t></is></c>'


def _plain(value: Any) -> Any:
    """A cell of a CSV file."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def _packed(parts: Mapping[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(zipfile.ZipInfo(name, _MOMENT), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()
