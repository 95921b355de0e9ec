"""Writing files from the interface: FBX, glTF, plots as tables."""
