"""The scene around the armature: which objects are solid, their faces and movement; its skin."""
