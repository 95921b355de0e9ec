"""Results as files for other programs: FBX, glTF and USD as engines want them."""
