"""One record as the files of laboratories, their bytes put together here from the formats' specifications.

Four samples, every quarter of a second: time 0 to 0.75 s, command in V, displacement in mm.
"""

from __future__ import annotations

import gzip
import io
import struct
import zipfile

import numpy as np

from tests.readers.lab_mdf import mdf3, mdf4

TIME = [0.0, 0.25, 0.5, 0.75]
COMMAND = [1.5, -2.0, 0.25, 4.0]
DISPLACEMENT = [0.125, 8.0, -0.5, 16.0]
REPEATS = 4
"""The record is written as often: a run has eight samples at least."""
T = [0.25 * n for n in range(REPEATS * len(TIME))]
U, X = COMMAND * REPEATS, DISPLACEMENT * REPEATS
ROWS = list(zip(T, U, X, strict=True))


def text(delimiter: str = ",", comma: bool = False) -> bytes:
    lines = [delimiter.join(f"{value:g}" for value in row) for row in ROWS]
    found = "\n".join([delimiter.join(("time", "u", "x")), delimiter.join(("s", "V", "mm")), *lines, ""])
    return (found.replace(".", ",") if comma else found).encode()


def uff() -> bytes:
    """Data set 58 with even abscissa and ordinates of single precision, six numbers of 13 characters a line."""
    return b"".join(_set58(name, unit, _numbers(values)) for name, unit, values in (("u", "V", U), ("x", "mm", X)))


def uff_binary() -> bytes:
    """Data set 58b: the same head in text, then IEEE numbers of single precision, the last byte first."""
    made = b""
    for name, unit, values in (("u", "V", U), ("x", "mm", X)):
        body = struct.pack(f"<{len(values)}f", *values)
        made += _set58(name, unit, body, f"    58b{1:6d}{2:6d}{11:12d}{len(body):12d}{0:6d}{0:6d}{0:12d}{0:12d}")
    return made


def _numbers(values: list[float]) -> bytes:
    lines = [values[n : n + 6] for n in range(0, len(values), 6)]
    return b"".join("".join(f"{value:13.5e}" for value in line).encode() + b"\n" for line in lines)


def _set58(name: str, unit: str, body: bytes, kind: str = "    58") -> bytes:
    axis = "{:10d}{:5d}{:5d}{:5d} {:<20s} {:<20s}"
    head = [
        "    -1",
        f"{kind:<80s}",
        f"{name:<80s}",
        "NONE",
        "01-JAN-26 00:00:00",
        "NONE",
        "NONE",
        f"{1:5d}{0:10d}{0:5d}{0:10d} {'NONE':<10s}{1:10d}{3:4d} {'NONE':<10s}{0:10d}{0:4d}",
        f"{2:10d}{len(U):10d}{1:10d}{0.0:13.5e}{0.25:13.5e}{0.0:13.5e}",
        axis.format(17, 0, 0, 0, "Time", "s"),
        axis.format(8, 0, 0, 0, "Axis", unit),
        axis.format(0, 0, 0, 0, "NONE", "NONE"),
        axis.format(0, 0, 0, 0, "NONE", "NONE"),
    ]
    tail = b"" if body.endswith(b"\n") else b"\n"
    return "\n".join(head).encode() + b"\n" + body + tail + b"    -1\n"


def lvm(timed: bool = True) -> bytes:
    """With a column of times, or with X0 and Delta_X alone; a comment stands in a column of its own."""
    head = ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", "Decimal_Separator\t.",
            "Multi_Headings\tNo", f"X_Columns\t{'One' if timed else 'No'}", "Time_Pref\tRelative",
            "***End_of_Header***\t", "\t"]  # fmt: skip
    head += ["Channels\t2\t", "Samples\t16\t16\t", "Y_Unit_Label\tV\tmm\t", "X_Dimension\tTime\tTime\t",
             "X0\t0.0\t0.0\t", "Delta_X\t0.25\t0.25\t", "***End_of_Header***\t\t\t",
             "X_Value\tu\tx\tComment"]  # fmt: skip
    rows = [f"{t if timed else ''}\t{u}\t{x}\t{'begun' if t == 0 else ''}" for t, u, x in ROWS]
    return "\r\n".join([*head, *rows, ""]).encode()


def controldesk(delimiter: str = ",") -> bytes:
    """What ControlDesk 7 exports: a field over two lines above, ports with Simulink's names and with their own."""
    head = [
        "descriptions,General,User,lab",
        ',General,Origin,"Software revision: a, b',
        'Platform: MicroAutoBox III"',
        "",
        "trace_size,16",
        "trace_types,5,4,4",
        "trace_names,,In1,x_out",
        "trace_units,s,V,mm",
        "path,,Model Root/Valve/u,Model Root/Stand",
        "flags,,2,2",
    ]
    rows = [f"{'' if t else 'trace_values'},{t},{u},{x}" for t, u, x in ROWS]
    text = "\r\n".join([*head, *rows, ""])
    return (text if delimiter == "," else text.replace(",", delimiter).replace(".", ",")).encode()


def mts() -> bytes:
    """What a timed acquisition of the station manager writes."""
    head = [
        "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A",
        "",
        "Data Acquisition\tTimed\tTime:\t4\tSec\t1/5/2026 10:00:00 AM",
        "Station Name:\tBench",
        "Time\tu\tx",
        "s\tV\tmm",
    ]
    return "\r\n".join([*head, *("\t".join(map(str, row)) for row in ROWS), ""]).encode()


def xlsx() -> bytes:
    """A workbook of Office Open XML: a line about the test, names, units, numbers; strings stand in their cells."""
    cells = [["Test of the bench"], ["time", "u", "x"], ["s", "V", "mm"], *ROWS]
    rows = "".join(
        f'<row r="{n}">{"".join(_cell(f"{chr(65 + k)}{n}", value) for k, value in enumerate(row))}</row>'
        for n, row in enumerate(cells, 1)
    )
    members = {name: content.replace("ROWS", rows) for name, content in WORKBOOK.items()}
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, f'<?xml version="1.0" encoding="UTF-8"?>{content}')
    return file.getvalue()


OPEN = "http://schemas.openxmlformats.org"
OFFICE, PACKAGE, SHEET = f"{OPEN}/officeDocument/2006", f"{OPEN}/package/2006", f"{OPEN}/spreadsheetml/2006/main"
TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
WORKBOOK = {
    "[Content_Types].xml": (
        f'<Types xmlns="{PACKAGE}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{TYPE}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{TYPE}.worksheet+xml"/></Types>'
    ),
    "_rels/.rels": (
        f'<Relationships xmlns="{PACKAGE}/relationships"><Relationship Id="r1" '
        f'Type="{OFFICE}/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>'
    ),
    "xl/workbook.xml": (
        f'<workbook xmlns="{SHEET}" xmlns:r="{OFFICE}/relationships">'
        '<sheets><sheet name="Run" sheetId="1" r:id="r1"/></sheets></workbook>'
    ),
    "xl/_rels/workbook.xml.rels": (
        f'<Relationships xmlns="{PACKAGE}/relationships"><Relationship Id="r1" '
        f'Type="{OFFICE}/relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>'
    ),
    "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{SHEET}"><sheetData>ROWS</sheetData></worksheet>',
}


def _cell(place: str, value: float | str) -> str:
    if isinstance(value, str):
        return f'<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>'
    return f'<c r="{place}"><v>{value!r}</v></c>'


def records() -> bytes:
    rows = ",\n".join(f'{{"time": {t}, "u": {u}, "x": {x}}}' for t, u, x in ROWS)
    return f"[{rows}]".encode()


def simulink() -> bytes:
    """A structure with time, as a block To Workspace leaves it; written by SciPy."""
    from scipy.io import savemat

    signals = np.zeros((1, 2), dtype=[("values", object), ("dimensions", object), ("label", object)])
    for place, (name, values) in enumerate((("u", U), ("x", X))):
        signals[0, place] = (np.array(values)[:, None], 1.0, name)
    return _saved(savemat, {"out": {"time": np.array(T)[:, None], "signals": signals, "blockName": "model/Out"}})


def dspace() -> bytes:
    """A capture of dSPACE: X the time, Y the signals with their names; written by SciPy."""
    from scipy.io import savemat

    signals = np.zeros((1, 2), dtype=[("Name", object), ("Type", object), ("Data", object)])
    for place, (name, values) in enumerate((("u", U), ("x", X))):
        signals[0, place] = (f"Model Root/{name}", 2.0, np.array(values)[None, :])
    return _saved(savemat, {"rec001": {"X": {"Name": "time", "Data": np.array(T)[None, :]}, "Y": signals}})


def _saved(savemat, variables) -> bytes:
    file = io.BytesIO()
    savemat(file, variables, do_compression=True)
    return file.getvalue()


def diadem() -> bytes:
    """The head of a record of DIAdem: the time counted, the command as counts, the displacement value by value."""
    of_all = [
        "DIAEXTENDED  {@:ENGLISH}",
        "#BEGINGLOBALHEADER",
        "1,WINDOWS 32Bit",
        "2,",
        "101,Bench",
        "112,High -> Low",
        "#ENDGLOBALHEADER",
        "",
    ]
    channels = [
        {200: "time", 202: "s", 210: "IMPLICIT", 214: "REAL64", 220: 16, 240: 0.0, 241: 0.25},
        {200: "u", 202: "V", 210: "EXPLICIT", 211: "RUN.I16", 213: "CHANNEL", 214: "INT16", 220: 16, 221: 3,
         240: 0.5, 241: 0.25},
        {200: "still", 202: "mm", 210: "EXPLICIT", 211: "run.r64", 213: "BLOCK", 214: "REAL64", 220: 16, 221: 1,
         240: 0, 241: 1},
        {200: "x", 202: "mm", 210: "EXPLICIT", 211: "run.r64", 213: "BLOCK", 214: "REAL64", 220: 16, 221: 2,
         240: 0, 241: 1},
    ]  # fmt: skip
    lines = [
        line
        for entries in channels
        for line in (
            "#BEGINCHANNELHEADER",
            *(f"{code},{value}" for code, value in entries.items()),
            "#ENDCHANNELHEADER",
            "",
        )
    ]
    return "\r\n".join([*of_all, *lines]).encode()


def diadem_ascii() -> bytes:
    """The same with the command and the displacement in one table of text, with decimal commas."""
    text = diadem().replace(b"INT16", b"ASCII").replace(b"214,REAL64\r\n220,16\r\n221", b"214,ASCII\r\n220,16\r\n221")
    text = (
        text.replace(b"CHANNEL\r\n214", b"BLOCK\r\n214").replace(b"RUN.I16", b"run.asc").replace(b"run.r64", b"run.asc")
    )
    text = text.replace(b"221,3\r\n240,0.5\r\n241,0.25", b"221,3\r\n240,0\r\n241,1")
    return text.replace(b"202,V", b"202,V\r\n230,;\r\n231,,").replace(b"202,mm", b"202,mm\r\n230,;\r\n231,,")


COUNTS = [4, -10, -1, 14] * REPEATS
"""0.5 V and 0.25 V a count make the command of these; two values of something else stand before them in the file."""
BESIDE = {
    "diadem": {
        "run.i16": struct.pack("<18h", 77, 78, *COUNTS),
        "run.r64": struct.pack("<32d", *(value for x in X for value in (0.0, x))),
    },
    "diadem-ascii": {"run.asc": "".join(f"0;{x:g};{u:g}\r\n".replace(".", ",") for _, u, x in ROWS).encode()},
}
"""The files beside those that name some."""
FILES = {
    "uff": (".uff", uff, ("time", "u", "x")),
    "uff-binary": (".unv", uff_binary, ("time", "u", "x")),
    "lvm": (".lvm", lvm, ("X_Value", "u", "x")),
    "lvm-untimed": (".lvm", lambda: lvm(False), ("X_Value", "u", "x")),
    "controldesk": (".csv", controldesk, ("time", "Valve/u", "Stand/x_out")),
    "controldesk-comma": (".csv", lambda: controldesk(";"), ("time", "u", "x_out")),
    "mts": (".dat", mts, ("Time", "u", "x")),
    "xlsx": (".xlsx", xlsx, ("time", "u", "x")),
    "records": (".json", records, ("time", "u", "x")),
    "simulink": (".mat", simulink, ("out.time", "u.values", "x.values")),
    "dspace": (".mat", dspace, ("rec001.X.Data", "u.Data", "x.Data")),
    "units-row": (".csv", text, ("time", "u", "x")),
    "units-row-comma": (".txt", lambda: text("\t", comma=True), ("time", "u", "x")),
    "gzip": (".csv.gz", lambda: gzip.compress(text()), ("time", "u", "x")),
    "dat-table": (".dat", lambda: text("\t"), ("time", "u", "x")),
    "diadem": (".dat", diadem, ("time", "u", "x")),
    "diadem-ascii": (".dat", diadem_ascii, ("time", "u", "x")),
    "mdf": (".mdf", lambda: mdf3(ROWS), ("time", "u", "x")),
    "mdf-4": (".mf4", lambda: mdf4(ROWS), ("time", "u", "x")),
    "mdf-dat": (".dat", lambda: mdf4(ROWS), ("time", "u", "x")),
}
"""Each with its ending, its bytes, and what the columns of time, command and displacement are called in it."""
DESCRIBED = """\
actuator: {{serial: SW-1}}
runs:
  - id: first
    file: run{ending}
    time: {{column: "{time}", unit: s}}
    channels:
      command:      {{column: "{u}", unit: V}}
      displacement: {{column: "{x}", unit: mm}}
"""
"""The matrix.yaml of a run of any of them."""
APART = ("uff", "uff-binary", "xlsx", "records", "mdf", "mdf-4", "mdf-dat")
"""Those that a process of their own reads."""
