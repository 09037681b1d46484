"""Rechecks as a JUnit file, for a build server."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from app.regress.recheck import Recheck

NOT_XML = dict.fromkeys(code for code in range(32) if code not in (9, 10, 13))


def junit(rechecks: Sequence[Recheck]) -> bytes:
    """One test case an actuator: a failure where something moved, an error where it could not be rechecked."""
    errors = sum(bool(one.failure) for one in rechecks)
    counts = {
        "tests": len(rechecks),
        "failures": sum(not one.passed for one in rechecks) - errors,
        "errors": errors,
        "time": sum(one.seconds for one in rechecks),
    }
    suite = ElementTree.Element("testsuite", name="servoident regress")
    for name, count in counts.items():
        suite.set(name, f"{count:g}")
    for one in rechecks:
        case = ElementTree.SubElement(suite, "testcase", classname="actuator", time=f"{one.seconds:.3f}")
        case.set("name", one.serial.translate(NOT_XML))
        if one.failure:
            ElementTree.SubElement(case, "error", message=one.failure.translate(NOT_XML))
        elif not one.passed:
            moved = "; ".join(f"{c.quantity} {c.before:.6g} → {c.after:.6g} ({c.relative:.2g})" for c in one.moved)
            ElementTree.SubElement(case, "failure", message=moved)
    return bytes(ElementTree.tostring(suite, encoding="utf-8", xml_declaration=True))
