"""Triangle meshes of the scene: their tree, signed distances, heights, and how they move."""
