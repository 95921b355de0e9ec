"""What batches must reach, here and on farms."""

from ..figures.limits import Figure, Limit

OVERHEAD = "overhead a cell beside fit and solve"
SPEED_UP = "speed-up of 2 local workers over 1"
DASK_KILLED = "Dask: workers killed before a batch's end"
EQUAL = "cells that differ from one core's: "
LIMITS = {
    EQUAL + "2 workers": Limit("1", 0.0, 0.0),
    EQUAL + "4 Dask workers, shared folder": Limit("1", 0.0, 0.0),
    EQUAL + "4 Dask workers, through the scheduler": Limit("1", 0.0, 0.0),
    EQUAL + "OpenJD's session": Limit("1", 0.0, 0.0),
    SPEED_UP: Limit("1", 1.8, 1.95, at_least=True),
    OVERHEAD: Limit("ms", 150.0, 50.0),
    "solve of a cell": Limit("s"),
    "seconds a cell, one core": Limit("s"),
    "seconds a fit": Limit("s"),
    "megabytes a cell": Limit("MB"),
    "megabytes a fit": Limit("MB"),
    DASK_KILLED: Limit("1"),
    "Dask, 2 of 4 workers killed: cells lost, doubled or different": Limit("1", 0.0, 0.0),
    "batch killed and resumed: cells lost, half-written or solved again": Limit("1", 0.0, 0.0),
    "10,000 cells planned": Limit("s", 20.0, 5.0),
    "10,000 cells collected": Limit("s", 20.0, 5.0),
    "10,000 cells collected, memory": Limit("MB", 500.0, 200.0),
    "page of 1,000 cells: first paint": Limit("s", 3.0, 1.0),
    "page of 1,000 cells: filter": Limit("s", 0.5, 0.1),
}


def timed(figure: Figure) -> bool:
    """Whether it tells how fast the machine is as well, and is worse on a slow or busy one."""
    return figure.unit in ("s", "ms") or figure.name == SPEED_UP
