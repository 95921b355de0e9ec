"""Ways in which recordings are damaged, each at several strengths."""
