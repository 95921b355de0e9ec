"""Drives the built extension in a real Blender's window, by mouse and keys, and measures what the
artist feels: python3 dev.py window --out DIR.

Linux, Debian and root only; Blender comes from Debian and is kept in .hangtime/window. DIR gets a
picture of every step, figures.json and a JUnit report.
"""

import argparse
import platform
import shutil
import sys
import tempfile
from pathlib import Path

from ..build import build
from ..checks.summary import read
from ..environment.problem import SetUpError
from ..environment.virtual_environment import ROOT
from ..figures.limits import table, write
from ..recordings import HELD
from ..reports import report_options
from ..wheel import BuildError
from .driving import manual_images
from .results import LIMITS, RunRecord, figure_verdicts, figures_of, junit, scenario_verdicts
from .sandbox import SUITE, Mount, Sandbox, prepare

SIZE = (1280, 800)
LIMIT = 900.0  # s for the whole run
# What is left of the extension after Blender is told in lines that begin with LEFT.
SCRIPT = """
Xvfb :84 -screen 0 {width}x{height}x24 +extension GLX -nolisten tcp 2>/dev/null &
blender --command extension install-file -r user_default -e /mnt/zip/{zip}
{rig}
until [ -S /tmp/.X11-unix/X84 ]; do sleep 0.1; done
before=$(ls /tmp)
blender --window-geometry 0 0 {width} {height} --python-exit-code 3 --python-expr \
    "import sys; sys.path.insert(0, '/mnt/checkout')
from devtools.window.run_in_blender import start; start()" \
    && code=0 || code=$?
cat /tmp/*.crash.txt 2>/dev/null || true
sleep 1
for process in /proc/[0-9]*; do
    ! grep -sq 'solver/worker/main\\.py' $process/cmdline ||
        echo "LEFT a worker: ${{process#/proc/}}"
done
for file in $(ls /tmp); do
    case "$file" in artist.*|accepted.*|quit.blend|blender|pulse-*) ;; *)
        echo "$before" | grep -qx "$file" || echo "LEFT /tmp/$file" ;;
    esac
done
exit $code
"""
# The rig with a jump on its controls takes half a minute (devtools/rigs/controls).
MAKE_RIG = """blender -b --factory-startup --python-exit-code 3 --python-expr \
    "import sys; from runpy import run_path
run_path('/mnt/source/devtools/package.py')['load']()
from hangtime.devtools.rigs.controls.performed_file import main
main(['/tmp/artist.rigify.blend'])" """
RIG = "rig_"  # what the names of its scenes begin with
VARIABLES = {
    "DISPLAY": ":84",
    "LIBGL_ALWAYS_SOFTWARE": "1",
    "PYTHONDONTWRITEBYTECODE": "1",
    "PYTHONUNBUFFERED": "1",
}


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py window", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--zip", type=Path, metavar="FILE", help="run this one; build none")
    parser.add_argument("--reports", type=Path, metavar="DIR", help="also put the report there")
    parser.add_argument(
        "--tell", action="store_true", help="only tell the figures; fail for none of them"
    )
    parser.add_argument("--suite", default=SUITE, help="Debian's; has its own Blender")
    parser.add_argument("--scenes", nargs="+", metavar="NAME", help="only these and their needs")
    parser.add_argument(
        "--without-rig", action="store_true", help="leave out the scenes of the generated rig"
    )
    parser.add_argument(
        "--manual", action="store_true", help="only renew the manual's pictures, in docs/images"
    )
    parser.add_argument("--prepare", action="store_true", help="only make the place it runs in")
    options = report_options(parser, argv)
    try:
        sandbox = prepare(options.suite)
        if options.prepare:
            return 0
        with tempfile.TemporaryDirectory() as folder:
            zipped = options.zip or own_zip(Path(folder))
            scenes = [*manual_images.SCENARIOS.values()] if options.manual else options.scenes or []
            without = RIG if options.without_rig else ""
            record = run(sandbox, zipped.resolve(), options.out.resolve(), scenes, without)
    except (SetUpError, BuildError) as problem:
        print(problem, file=sys.stderr)
        return 2
    if options.manual:
        return renewed(record, options.out)
    return report(record, options.out, options.reports, judged=not options.tell)


def renewed(record: RunRecord, out: Path) -> int:
    """Renew the manual's pictures and tell what was not taken, and why; 1 where one was not."""
    missing = manual_images.renew(out)
    failed = [verdict for verdict in scenario_verdicts(record) if verdict.failure]
    print(*(f"not taken: {name}.png" for name in missing), *failed, sep="\n")
    print(f"{len(manual_images.SCENARIOS) - len(missing)} pictures are in {manual_images.IMAGES}")
    return int(bool(missing))


def own_zip(folder: Path) -> Path:
    """Build the extension; the zip for this machine."""
    print("Building the extension", flush=True)
    ending = f"-linux_{platform.machine().replace('x86_64', 'x64')}.zip"
    return next(zipped for zipped in build(folder) if zipped.name.endswith(ending))


def run(
    sandbox: Sandbox, zipped: Path, out: Path, scenarios: list[str], without: str = ""
) -> RunRecord:
    """Run the scenarios in the sandbox; pictures and Blender's log go to `out`. without: what the
    names of those begin with that are left out where none is chosen."""
    for stale in (*out.glob("*.png"), *(out / manual_images.TAKEN).glob("*.png"), out / "run.json"):
        stale.unlink(missing_ok=True)
    mounts = [
        Mount(zipped.parent, "/mnt/zip"),
        Mount(ROOT / "devtools", "/mnt/checkout/devtools"),
        Mount(HELD, "/mnt/recordings"),
        Mount(out, "/mnt/out", writable=True),
    ]
    rig = ""
    if any(name.startswith(RIG) for name in scenarios) or not (scenarios or without == RIG):
        rig = MAKE_RIG
        mounts.append(Mount(ROOT, "/mnt/source"))
    script = SCRIPT.format(width=SIZE[0], height=SIZE[1], zip=zipped.name, rig=rig)
    variables = {**VARIABLES, "SCENARIOS": " ".join(scenarios), "WITHOUT": without}
    log = out / "blender.log"
    print(f"Running in Blender's window; its output goes to {log}", flush=True)
    code = sandbox.run(script, mounts=mounts, variables=variables, limit=LIMIT, log=log)
    return RunRecord.read(out, code, log.read_text(errors="replace"))


def report(record: RunRecord, out: Path, reports: Path | None, *, judged: bool) -> int:
    """Tell, write figures.json and the JUnit report; 1 where something failed.

    judged: whether a figure that misses its promise is a failure.
    """
    figures = figures_of(record)
    write(figures, out / "figures.json")
    found = scenario_verdicts(record) + (figure_verdicts(figures) if judged else [])
    (out / "junit.xml").write_text(junit(found), encoding="utf-8")
    if reports is not None:
        reports.mkdir(parents=True, exist_ok=True)
        shutil.copy(out / "junit.xml", reports / "window.xml")
    print(table(figures, LIMITS))
    print(*found, sep="\n")
    print(read(out / "junit.xml"))
    return int(any(verdict.failure and not verdict.skipped for verdict in found))
