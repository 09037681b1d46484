"""A functional mock-up unit (FMI 2.0, co-simulation): the machine in C, compiled, in one archive without any Python."""

from __future__ import annotations

import hashlib
import io
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

from ident.errors import Unusable
from ident.export.fmi import FMI_C
from ident.export.header import as_header
from ident.export.machine import ExportedMachine

NAME = "servoident_machine"
COMPILERS = ("gcc", "cc", "clang")
_PLATFORMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "win32": ("win", ".dll")}
_LONGEST = 120  # s that a compiler may take
_DATE = (2020, 1, 1, 0, 0, 0)  # of every member: the same machine is the same file


def as_fmu(machine: ExportedMachine) -> bytes:
    """The archive: modelDescription.xml, the sources, and the binary for the system that this runs on.

    A step of communication is a whole number of samples. Raises Unusable where there is no C compiler.
    """
    header = as_header(machine)
    guid = hashlib.sha256((header + FMI_C).encode()).hexdigest()[:32]
    sources = {"machine.h": header, "fmi.c": f'#define SERVOIDENT_GUID "{guid}"\n{FMI_C}'}
    system, ending = _PLATFORMS.get(sys.platform, ("linux", ".so"))
    place = f"binaries/{system}{'64' if platform.architecture()[0] == '64bit' else '32'}/{NAME}{ending}"
    members = {"modelDescription.xml": _description(machine, guid), place: _compiled(sources, ending)}
    members |= {f"sources/{name}": text.encode() for name, text in sources.items()}
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name, _DATE), content, zipfile.ZIP_DEFLATED)
    return file.getvalue()


def _compiled(sources: dict[str, str], ending: str) -> bytes:
    """The shared library. Raises Unusable: ``no-compiler``, ``not-compiled``."""
    compiler = next(filter(None, map(shutil.which, COMPILERS)), None)
    if compiler is None:
        raise Unusable(
            "no-compiler",
            "an FMU holds machine code, and there is no C compiler here",
            "format fmu",
            "install gcc, or export the C header",
        )
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        made = Path(folder) / f"{NAME}{ending}"
        options = ("-std=c99", "-O2", "-shared", "-fvisibility=hidden", *(() if ending == ".dll" else ("-fPIC",)))
        try:
            subprocess.run(
                [compiler, *options, "fmi.c", "-o", made.name, "-lm"],
                cwd=folder,
                check=True,
                capture_output=True,
                timeout=_LONGEST,
            )
        except (subprocess.SubprocessError, OSError) as error:
            said = getattr(error, "stderr", None) or b""
            what = (
                f"{Path(compiler).name} failed: {said.decode('utf-8', 'replace').strip()[:200] or type(error).__name__}"
            )
            raise Unusable("not-compiled", what, "format fmu", "repair the compiler, or export the C header") from None
        return made.read_bytes()


def _description(machine: ExportedMachine, guid: str) -> bytes:
    """modelDescription.xml."""
    step = repr(1.0 / machine.sample_rate)
    root = ET.Element("fmiModelDescription", {
        "fmiVersion": "2.0", "modelName": NAME, "guid": guid, "generationTool": "servoident",
        "description": f"{machine.preset.title}, {machine.driven_by} held over {step} s",
        "variableNamingConvention": "flat", "numberOfEventIndicators": "0",
    })  # fmt: skip
    unit = ET.SubElement(root, "CoSimulation", {
        "modelIdentifier": NAME, "canHandleVariableCommunicationStepSize": "true", "canGetAndSetFMUstate": "true",
        "canBeInstantiatedOnlyOncePerProcess": "false",
    })  # fmt: skip
    ET.SubElement(ET.SubElement(unit, "SourceFiles"), "File", {"name": "fmi.c"})
    units = ET.SubElement(root, "UnitDefinitions")
    for name in dict.fromkeys(machine.unit(channel) for channel in machine.outputs):
        ET.SubElement(units, "Unit", {"name": name})
    ET.SubElement(root, "DefaultExperiment", {"startTime": "0", "stepSize": step})
    variables = ET.SubElement(root, "ModelVariables")
    _variable(variables, 0, machine.driven_by, {"causality": "input"}, {"start": "0"})
    for number, name in enumerate(machine.outputs, 1):
        shown = name if name != machine.driven_by else f"{name}_out"
        _variable(
            variables, number, shown, {"causality": "output", "initial": "calculated"}, {"unit": machine.unit(name)}
        )
    structure = ET.SubElement(root, "ModelStructure")
    for part in ("Outputs", "InitialUnknowns"):
        of = ET.SubElement(structure, part)
        for number in range(2, len(machine.outputs) + 2):
            ET.SubElement(of, "Unknown", {"index": str(number), "dependencies": "1"})
    return bytes(ET.tostring(root, encoding="UTF-8", xml_declaration=True))


def _variable(variables: ET.Element, reference: int, name: str, role: dict[str, str], of_type: dict[str, str]) -> None:
    entry = {"name": name, "valueReference": str(reference), "variability": "continuous"} | role
    ET.SubElement(ET.SubElement(variables, "ScalarVariable", entry), "Real", of_type)
