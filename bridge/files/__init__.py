"""Motion files into the scene (BVH, FBX, Acclaim), and actions out as FBX."""
