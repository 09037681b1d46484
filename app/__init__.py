"""The service and the command line. Imports nothing: `python3 -m app` must start before anything is installed."""
