"""A batch's folder: its manifest, the results of its cells, and how they are written safely."""
