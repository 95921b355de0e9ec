"""How feet stand in a recording: on what, how still, and what the whole body does meanwhile."""
