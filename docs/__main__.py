"""`python3 -m docs [FOLDER] [--serve [PORT]]`: set up what is needed, then build the site; by default in docs/_site."""

from __future__ import annotations

import sys

from app.environment import enter

if __name__ == "__main__":
    enter("requirements-tests.lock", ["-m", "docs.build", *sys.argv[1:]])
