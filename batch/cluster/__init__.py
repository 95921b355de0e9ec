"""Batches on the workers of a Dask scheduler; not in the extension's zip, as Dask is not."""
