"""A chain is known by what it is made of, in this process and in another."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys

from ident.presets import preset

OTHER = """
import pickle, sys
from ident.presets import preset
sent = pickle.loads(sys.stdin.buffer.read())
here = preset("qian2014", ("underlap",)).chain
assert sent == here and hash(sent) == hash(here) and {here: 1}[sent] == 1
print("known")
"""


def test_a_chain_that_was_hashed_here_is_found_among_those_of_another_process():
    """Strings hash to other numbers there: what was hashed here would never be found."""
    chain = preset("qian2014", ("underlap",)).chain
    assert hash(chain) == hash(preset("qian2014", ("underlap",)).chain)
    assert pickle.loads(pickle.dumps(chain)) == chain
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"  # another one than here
    told = subprocess.run(
        [sys.executable, "-c", OTHER],
        input=pickle.dumps(chain),
        capture_output=True,
        check=False,
        env={"PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert told.stdout.decode().strip() == "known", told.stderr.decode()
