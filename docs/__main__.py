"""`python3 -m docs [FOLDER]`: set up what is needed, then build the site; by default into docs/_site."""

from __future__ import annotations

import sys

from app.environment import enter

if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else "docs/_site"
    enter("requirements-tests.lock", ["-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "docs", folder])
