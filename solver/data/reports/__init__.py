"""Records of parts of the report, each of a field of its own."""
