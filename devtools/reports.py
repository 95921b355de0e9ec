"""Options of a command that leaves a report in a folder."""

import argparse
from pathlib import Path
from tempfile import TemporaryFile


def report_options(parser: argparse.ArgumentParser, argv: list[str]) -> argparse.Namespace:
    """The options, of which `out` is a folder that is there and can be written: a report is minutes
    of work, for which no place would be left. Ends the program in words where it is not."""
    options = parser.parse_args(argv)
    out: Path = options.out
    try:
        out.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=out).close()
    except OSError as error:
        parser.error(f"nothing can be written to {out} ({error.strerror}); choose another --out")
    return options
