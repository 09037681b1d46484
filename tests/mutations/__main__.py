"""`python3 -m tests.mutations [NAME …]`: set up what is needed, then run the list or the named mutations."""

import sys

from app.environment import enter

if __name__ == "__main__":
    enter("requirements-tests.lock", ["-m", "tests.mutations.runner", *sys.argv[1:]])
