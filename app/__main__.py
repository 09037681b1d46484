"""`python3 -m app`: set up what is needed, then start the service with a demonstration actuator."""

import sys

from app.environment import enter

if __name__ == "__main__":
    enter("requirements.lock", ["-m", "app.cli", "demo", *sys.argv[1:]])
