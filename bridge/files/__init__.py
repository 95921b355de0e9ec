"""Motion files into the scene: BVH, FBX, Acclaim."""
