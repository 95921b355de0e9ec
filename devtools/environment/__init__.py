"""Virtual environments, Pythons and system libraries for dev.py; standard library only."""
