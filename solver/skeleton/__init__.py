"""Which bone of a skeleton moves which part of the body: by names, by topology, by shape."""
