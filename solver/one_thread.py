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
