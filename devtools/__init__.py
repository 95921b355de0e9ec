"""Developer tools behind dev.py; never part of the extension's zip."""
