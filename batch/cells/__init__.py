"""One cell: a clip with a recipe, read, solved and written; without Blender where that will do."""
