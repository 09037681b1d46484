"""What the scripts of the pages put into words follows the numbers of `ident.words`."""

from __future__ import annotations

import re

from app.pages.rendering import STATIC
from ident.unstable import UNSTABLE
from ident.words.percent import TIMES


def test_a_script_says_times_and_unstable_from_the_same_numbers_on():
    text = (STATIC / "words.js").read_text(encoding="utf-8")
    found = {name: float(value) for name, value in re.findall(r"^const (\w+) = ([\d.e]+);", text, re.MULTILINE)}
    assert found == {"TIMES": TIMES, "UNSTABLE": UNSTABLE}
