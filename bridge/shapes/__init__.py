"""Meshes and lines of balls, boxes, tubes, cones and arcs, for picture and overlay: numpy only."""
