"""Environment variables that keep linear algebra to one thread; numpy reads them as it loads.

On a busy machine several threads make small factorisations a hundred times slower.
"""

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
    ),
    "1",
)
# The most threads that a solve takes for arrays that it can part (numerics/parallel.py).
SOLVER_THREADS = "HANGTIME_THREADS"
# Of a process beside which others solve, as many as there are cores.
ONE_CORE = {**ONE_THREAD, SOLVER_THREADS: "1"}
