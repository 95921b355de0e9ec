"""The small quadratic program of a step: which rows are at their bounds."""
