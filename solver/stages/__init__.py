"""The stages of a solution: fit, problem set-up, warm start, implicit, explicit, interactive."""
