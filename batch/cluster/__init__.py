"""Batches on the workers of a Dask scheduler; not in the extension's zip, for Dask is not either."""
