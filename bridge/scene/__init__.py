"""The scene around the armature: which objects are solid, and their faces and movement."""
