"""Batches on this machine, on Dask and in OpenJD's sessions, measured."""
