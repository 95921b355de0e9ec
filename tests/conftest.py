"""Makes the checkout importable as the package `hangtime`, whatever its folder is called, and
times no test."""

from pathlib import Path
from runpy import run_path

from hypothesis import HealthCheck, settings

run_path(str(Path(__file__).parents[1] / "devtools" / "package.py"))["load"]()

# How soon an example is made or tried is a matter of what else the machine does.
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")
