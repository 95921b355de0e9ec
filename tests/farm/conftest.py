"""These tests run by `dev.py farm --tests`, where the engines of farms are and Blender is not."""

from importlib.util import find_spec

if find_spec("distributed") is None:
    collect_ignore_glob = ["test_*.py"]
