"""Batches by the engines of farms, such as Flamenco and those of OpenJD: jobs, and their tasks."""
