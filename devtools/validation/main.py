"""Compares the fit's contact forces with force plates: python3 dev.py validate [FOLDER] [--out DIR].

FOLDER holds trials: X.bvh, X_grf.csv, X_com.csv and X.json (examples/recordings has one). Each goes
the way of `dev.py adapt` up to the fit.
"""

import argparse
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ..environment.virtual_environment import ROOT
from .solve import Json
from .table import table
from .trials import names

LONGEST = 300.0  # s, that one trial may take


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py validate", description=__doc__)
    held = ROOT / "examples" / "recordings"
    parser.add_argument("folder", nargs="?", type=Path, default=held, metavar="FOLDER")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="trials; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="trials at once")
    options = parser.parse_args(argv)
    known = names(options.folder)
    chosen = options.only or known
    unknown = [name for name in chosen if name not in known]
    if unknown or not chosen:
        what = f"trial '{unknown[0]}'" if unknown else "trial"
        print(f"No {what} in {options.folder}; there are: {', '.join(known) or 'none'}.")
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(options.jobs) as pool:
        rows = list(pool.map(lambda name: work(options.folder, name, options.out), chosen))
    print(table(rows))
    return 0


def work(folder: Path, name: str, out: Path) -> Json:
    """Measures one trial in a process of its own, for a crash is its own too."""
    path = out / f"{name}.json"
    path.unlink(missing_ok=True)
    launcher = str(ROOT / "devtools" / "package.py")
    command = [sys.executable, launcher, "devtools.validation.solve", str(folder), name, str(out)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST)
        row: Json = json.loads(path.read_text(encoding="utf-8"))
    except subprocess.TimeoutExpired:
        return {"trial": name, "refused": f"took longer than {LONGEST:g} s"}
    except OSError:
        lines = done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"]
        return {"trial": name, "refused": lines[-1]}
    return row
