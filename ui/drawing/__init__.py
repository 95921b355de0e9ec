"""Flat drawings as data, their batches on the GPU, and a cache of what was built."""
