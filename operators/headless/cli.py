"""The command line: `dev.py adapt …`, `blender --command hangtime adapt …` and the like.

Exit codes: 0 done; 2 wrong input, in one sentence on the standard error; 3 no solution, likewise.
"""

import os

# A small factorisation on many threads takes longer than on one; read once, when numpy loads.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def main(argv: list[str]) -> int:
    """Runs `adapt` or `analyze` with its arguments; the exit code."""
    for name in THREADS:
        os.environ.setdefault(name, "1")
    from .commands import run

    return run(argv)


def command(argv: list[str]) -> int:
    """For bpy.utils.register_cli_command("hangtime", command): argv is what follows `hangtime`."""
    return main(argv)
