"""Environment variables by which glibc keeps memory that is freed; it reads them as a process
starts, and nothing else knows them.

A solve makes and drops the same large arrays over and over. Handed back each time, they come anew
as pages that the system has to clear, which takes some hundredths of a solve's time.
"""

KEPT_MEMORY = {
    "MALLOC_MMAP_THRESHOLD_": str(32 << 20),  # bytes: larger arrays are handed back still
    "MALLOC_TRIM_THRESHOLD_": str(256 << 20),  # bytes, that may lie unused
}
