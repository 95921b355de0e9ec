"""A survey as an artist would make it: every kind of edit on every jump; never in the zip."""
