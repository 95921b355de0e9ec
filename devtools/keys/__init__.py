"""What reduced keys leave of adapted jumps, as Blender shows them."""
