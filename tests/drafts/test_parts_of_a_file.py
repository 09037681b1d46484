"""Raw files in which columns of the same names stand in several parts."""

from __future__ import annotations

import json

from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import RawFile, read_raw


def twice(first: str, second: str) -> RawFile:
    """A record of two columns, 400 samples, and a fourth of its samples in a part of their own."""
    raw = {first: [float(n % 7) for n in range(400)], second: [float(n % 5) for n in range(400)]}
    held = {"raw": raw, "thinned": {name: values[::4] for name, values in raw.items()}}
    return read_raw(json.dumps(held).encode(), "run.json")


def test_validation_data_are_a_share_of_the_samples_of_the_output():
    """Of a file whose first column belongs to another, longer table."""
    file = twice("u", "x")
    chosen = {"command": Answer("thinned/u", "V"), "displacement": Answer("thinned/x", "mm")}
    draft = Draft([file], Answers("A1", chosen, rate="100 Hz", validation=0.3))
    assert draft.description()["runs"][0]["split"] == {"validation": [70, 100]}


def test_of_a_column_and_its_namesake_in_another_part_of_the_file_the_first_is_suggested():
    file = twice("force", "position")
    channels = Draft([file], Answers()).known(file).channels
    assert {name: answer.column for name, answer in channels.items()} == {"force": "force", "displacement": "position"}
