"""Makes the checkout importable as the package `hangtime`, whatever its folder is called."""

from pathlib import Path
from runpy import run_path

run_path(str(Path(__file__).parents[1] / "devtools" / "package.py"))["load"]()
