"""The command line: `dev.py adapt …`, `blender --command hangtime adapt …` and the like.

Exit codes: 0 done; 2 wrong input, in one sentence on the standard error; 3 no solution, likewise;
1 too little memory, likewise, or not all could be printed; 130 cancelled.
"""

import os

from ...solver.one_thread import ONE_THREAD


def main(argv: list[str]) -> int:
    """Runs `adapt`, `analyze` or `doctor` with its arguments; the exit code.

    Also for bpy.utils.register_cli_command("hangtime", main): argv is what follows `hangtime`.
    """
    for name, value in ONE_THREAD.items():
        os.environ.setdefault(name, value)
    from .commands import run  # loads numpy, which reads them

    return run(argv)
