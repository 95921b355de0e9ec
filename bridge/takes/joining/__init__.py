"""How a take joins the adapted frames: offsets that fade, and the move of a stance."""
