"""Batches on other machines: tasks of a farm's engine, and Dask. Not in the extension's zip."""
