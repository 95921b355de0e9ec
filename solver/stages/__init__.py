"""The stages of a solution after the fit: set-up, warm start, implicit, explicit, interactive."""
