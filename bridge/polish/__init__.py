"""Hand polish: what artists changed in a result, kept when it is made anew."""
